"""The load over the face of tests/reference/helical/07 at rest by NumPy: python helical.py [SLICES [PLACES]].

Coupled slices and pairs with the compliances of the case, dense matrices, one active set for each place of a base
pitch. Prints one JSON object: seconds (without the import), the peak to peak transmission error and its error
against the reference.
"""

import json
import pathlib
import sys
import time
import tomllib

import numpy as np

CASE = pathlib.Path(__file__).resolve().parent.parent.parent / "tests/reference/helical/07-beta30-coupled.json"
UNITS = {"um mm/N": 1e-9, "mm": 1e-3, "um": 1e-6, "deg": np.pi / 180, "N m": 1.0}
PAIRS = np.arange(-3, 4)


def number(text):
    value, unit = text.split(" ", 1)
    return float(value) * UNITS[unit]


def gap_beyond(turns, tip_base, tip, own_base, distance, ratio):
    """Gap of a sharp tip and the flank of the other gear after a turn of the tip's gear from the end of the path, in m
    on the line of action, with the distance from that end."""
    working = np.arccos((tip_base + own_base) / distance)
    end = distance * np.sin(working) - np.sqrt(tip**2 - tip_base**2)
    angle = turns + np.arccos(tip_base / tip) - working
    across, along = tip * np.sin(angle), distance - tip * np.cos(angle)
    radius = np.hypot(across, along)
    length = np.sqrt(radius**2 - own_base**2)
    foot = np.arctan2(across, along) + np.arctan2(length, own_base)
    moved = foot - length / own_base - (working - end / own_base + turns * ratio)
    return turns * tip_base, -moved * own_base


def solve(slices, places):
    case = tomllib.loads(json.loads(CASE.read_text())["case"])
    pair, driver, driven, given = (case[key] for key in ("pair", "driver", "driven", "compliance"))
    normal, alpha, beta = number(pair["module"]), number(pair["pressure_angle"]), number(pair["helix_angle"])
    module, transverse = normal / np.cos(beta), np.arctan(np.tan(alpha) / np.cos(beta))
    lead = np.tan(np.arcsin(np.sin(beta) * np.cos(alpha)))
    teeth = driver["teeth"], driven["teeth"]
    references = [0.5 * module * one for one in teeth]
    bases = [one * np.cos(transverse) for one in references]
    tips = [one + normal * (1 + gear["profile_shift"]) for one, gear in zip(references, (driver, driven))]
    # the sum of the profile shifts is 0
    distance, pitch = sum(references), np.pi * module * np.cos(transverse)
    lengths = [np.sqrt(tip**2 - base**2) for tip, base in zip(tips, bases)]
    path = sum(lengths) - distance * np.sin(transverse)
    width = number(driver["face_width"])
    force = number(case["operation"]["torque"]) / bases[0]

    turns = np.linspace(0, 0.12, 4000)
    before = gap_beyond(turns * teeth[0] / teeth[1], bases[1], tips[1], bases[0], distance, teeth[1] / teeth[0])
    after = gap_beyond(turns, bases[0], tips[0], bases[1], distance, teeth[0] / teeth[1])
    s = np.concatenate([-before[0][::-1], path + after[0]])
    gaps = np.concatenate([before[1][::-1], after[1]])

    z = (np.arange(slices) + 0.5) / slices * width - width / 2
    step = width / slices
    ends = [number(driven["end_relief_minus"]), number(driven["end_relief_plus"])]
    reach = number(driven["end_relief_length"])
    at_ends = [1 - (z + width / 2) / reach, 1 - (width / 2 - z) / reach]
    crown = sum(amount * np.maximum(part, 0) for amount, part in zip(ends, at_ends))
    # 1/(1 - L² d²/dz²), no slope at the ends
    coupling = (number(given["coupling_length"]) / step) ** 2
    second = np.diag(np.full(slices - 1, 1.0), 1) + np.diag(np.full(slices - 1, 1.0), -1) - 2 * np.eye(slices)
    second[0, 0] = second[-1, -1] = -1
    spread = np.linalg.inv(np.eye(slices) - coupling * second)
    cross = np.eye(len(PAIRS)) + given["cross"] * (np.eye(len(PAIRS), k=1) + np.eye(len(PAIRS), k=-1))
    operator = np.einsum("kj,ab->kajb", cross, spread).reshape(len(PAIRS) * slices, -1)
    decay = number(given["end_decay"])
    plus, minus = np.exp((z - width / 2) / decay), np.exp(-(z + width / 2) / decay)
    # the loaded flank of a right-hand driver is acute at +z, that of the driven gear at -z
    acute, obtuse = given["end_acute"], given["end_obtuse"]
    factors = 1 + acute * plus - obtuse * minus, 1 + acute * minus - obtuse * plus
    relief, relief_length = number(driven["tip_relief"]), number(driven["tip_relief_length"])
    contact = number(given["contact"])

    def displacement(place):
        along = place + PAIRS[:, None] * pitch + z * lead
        t = np.clip(2 * along / path - 1, -1, 1)
        series = lambda gear: number(given[gear]) * (1 + np.polyval([*given[f"{gear}_coefficients"][::-1], 0], t))
        own = np.sqrt(series("driver") * factors[0] + series("driven") * factors[1]).ravel()
        gap = np.interp(along, s, gaps, left=1.0, right=1.0) + crown
        gap = (gap + relief * np.clip(1 - along / relief_length, 0, 1)).ravel()
        active = np.flatnonzero(gap < 60e-6)
        compliance = own[active, None] * operator[np.ix_(active, active)] * own[active]
        compliance[np.diag_indices(len(active))] += contact
        touching = np.ones(len(active), dtype=bool)
        for _ in range(60):
            rows = np.flatnonzero(touching)
            system = np.zeros((len(rows) + 1, len(rows) + 1))
            system[:-1, :-1] = compliance[np.ix_(rows, rows)]
            system[:-1, -1], system[-1, :-1] = -1, step
            found = np.linalg.solve(system, [*-gap[active][rows], force])
            loads = np.zeros(len(active))
            loads[rows] = found[:-1]
            open_by = found[-1] - gap[active] - compliance @ loads
            now = np.where(touching, loads > 0, open_by > 0)
            if (now == touching).all():
                return found[-1]
            touching = now
        raise RuntimeError("no active set")

    return [displacement(place) for place in np.arange(places) / places * pitch]


slices = int(sys.argv[1]) if sys.argv[1:] else 65
places = int(sys.argv[2]) if sys.argv[2:] else 64
begin = time.perf_counter()
found = solve(slices, places)
seconds = time.perf_counter() - begin
swing = max(found) - min(found)
expected = json.loads(CASE.read_text())["results"]["cycle"]
print(json.dumps({"seconds": seconds, "transmission_error": swing, "error": swing / expected["transmission_error"] - 1}))
