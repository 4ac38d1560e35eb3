"""The method `dynamic` in SciPy: how long it takes, and how far it is off, by tolerance.

    python3 benches/scipy_dynamic.py [CASE.toml] [REFERENCE.json] [--repeat N]

Without arguments: Table 1, tests/reference/mesh/table-1. One JSON object a line:
- {"setup_seconds": ...}: geometry, and the tables of gap and stiffness along the line of action (cubic splines between the
  kinks; what they are off by stands beside it); wanted once a case
- {"method", "split", "rtol", "seconds", "evaluations", "error_peak", "error_approach", "error_first", ...}: one run from the
  static equilibrium through the warm-up until the incoming tooth has left, its peaks and first contact located; seconds
  is the least of the repeats, errors are relative to the reference (absent where it has no such quantity)

Methods: `dop853` and `lsoda` are compiled (`ode`, `odeint`) in the warm-up and `solve_ivp` with dense output in the window
that is looked at; `dop853-python` and `lsoda-python` are `solve_ivp` throughout. `split` restarts at every kink along the
line of action (E, B and ends of relief of every pair). A change of contact is left to the step control.
The right-hand side is plain Python on tables: with two states that is several times as fast as NumPy arrays.
"""

import argparse
import json
import math
import pathlib
import sys
import time
from bisect import bisect_right

import numpy as np
from scipy.integrate import ode, odeint, solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq, minimize_scalar

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tests/reference/mesh"))
from generate import Mesh, Motion  # noqa: E402
from pair import Pair  # noqa: E402

WINDOW = -0.75
INTERVALS = 480
TOLERANCES = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12]


class Table:
    """Gap and stiffness of a pair against its place along the line of action, in the units of `Motion`."""

    def __init__(self, motion):
        mesh, pitch = motion.mesh, motion.mesh.pitch
        ends = {0.0, mesh.path, -mesh.reach_in, mesh.path + mesh.reach_out}
        self.edges = [edge / pitch for edge in sorted(ends | set(mesh.points))]
        self.zones, self.splines, worst = [], [], [0.0, 0.0]
        for low, high in zip(self.edges, self.edges[1:]):
            nodes = np.linspace(low, high, INTERVALS + 1)
            places = [min(max(s * pitch, low * pitch), high * pitch) for s in nodes]
            inner = [s + (1e-13 if i == 0 else -1e-13 if i == INTERVALS else 0.0) * pitch for i, s in enumerate(places)]
            exact = lambda s: (lambda g, k, _: (g / motion.unit, k / motion.mean))(*mesh.pair.place(s))
            spline = CubicSpline(nodes, [exact(s) for s in inner])
            step = (high - low) / INTERVALS
            rows = [tuple(column) for column in spline.c.transpose(1, 0, 2).reshape(INTERVALS, 8).tolist()]
            self.zones.append((low, 1.0 / step, step, rows))
            self.splines.append(spline)
            for s in (nodes[:-1] + nodes[1:])[:: INTERVALS // 12] / 2:
                off = np.abs(spline(s) - exact(s * pitch))
                worst = [max(worst[0], off[0]), max(worst[1], off[1])]
        self.worst = [float(value) for value in worst]

    def at(self, places):
        """Gap and stiffness at many places."""
        found = np.full((len(places), 2), (1e9, 0.0))
        for low, high, spline in zip(self.edges, self.edges[1:], self.splines):
            inside = (places >= low) & (places <= high)
            found[inside] = spline(places[inside])
        return found[:, 0], found[:, 1]


class Run:
    """The equation of motion of a case, and the integrators' way through it."""

    def __init__(self, path):
        self.motion = motion = Motion(Mesh(Pair(path)))
        self.table = Table(motion)
        self.error = motion.mesh.error / motion.unit
        self.breaks = [point for point in motion.breaks() if point > motion.begin]
        self.start = motion.start()[:2]
        self.count = 0
        self.slope = self.right_hand_side()

    def right_hand_side(self):
        table, error = self.table, self.error
        edges, zones, last = table.edges, table.zones, INTERVALS - 1
        low, high = edges[0], edges[-1]
        omega, drag = self.motion.frequency, 2 * self.motion.mesh.pair.damping_ratio
        ceil = math.ceil

        def slope(s, y):
            self.count += 1
            x, v = y
            k = ceil(low - s)
            place = s + k
            load = 0.0
            while place < high:
                zone = bisect_right(edges, place) - 1
                start, inverse, step, rows = zones[zone if zone > 0 else 0]
                index = int((place - start) * inverse)
                if index > last:
                    index = last
                gap3, stiff3, gap2, stiff2, gap1, stiff1, gap0, stiff0 = rows[index]
                d = place - start - index * step
                depth = x - (((gap3 * d + gap2) * d + gap1) * d + gap0)
                if k == 0:
                    depth += error
                if depth > 0.0:
                    load += depth * (((stiff3 * d + stiff2) * d + stiff1) * d + stiff0)
                k += 1
                place += 1.0
            if load > 0.0:
                return omega * v, omega * (1.0 - load - drag * v)
            return omega * v, omega

        return slope

    def stretches(self, split):
        """Ends of the stretches of the warm-up and of the window."""
        begin, finish = self.motion.begin, self.motion.finish
        inner = self.breaks if split else [finish]
        warm = [begin] + [s for s in inner if begin < s < WINDOW] + [WINDOW]
        return warm, [WINDOW] + [s for s in inner if s > WINDOW]

    def solve(self, method, split, rtol):
        """(peak, peak before E, first contact in base pitches before E or None)."""
        warm, window = self.stretches(split)
        state = self.warm_up(method, warm, rtol)
        pieces = []
        for low, high in zip(window, window[1:]):
            run = self.by_solve_ivp(method, low, high, state, rtol, True)
            pieces.append((low, high, lambda s, run=run: run.sol(s)[0]))
            state = run.y[:, -1]
        return self.look(pieces)

    def warm_up(self, method, ends, rtol):
        state = self.start
        for low, high in zip(ends, ends[1:]):
            if method == "lsoda":
                state = odeint(self.slope, state, [low, high], tfirst=True, rtol=rtol, atol=rtol * 0.1, mxstep=1000000)[-1]
            elif method == "dop853":
                solver = ode(self.slope).set_integrator("dop853", rtol=rtol, atol=rtol * 0.1, nsteps=1000000)
                state = solver.set_initial_value(state, low).integrate(high)
            else:
                state = self.by_solve_ivp(method, low, high, state, rtol, False).y[:, -1]
        return state

    def by_solve_ivp(self, method, low, high, state, rtol, dense):
        name = "LSODA" if method.startswith("lsoda") else "DOP853"
        return solve_ivp(self.slope, (low, high), state, method=name, rtol=rtol, atol=rtol * 0.1, dense_output=dense)

    def look(self, pieces):
        """Peaks and first contact of the incoming tooth."""
        peak, approach, first = 0.0, 0.0, None
        for low, high, x in pieces:
            grid = np.linspace(low, high, max(16, math.ceil((high - low) * self.motion.frequency * 6)))
            gap, stiffness = self.table.at(grid)
            depth = x(grid) + self.error - gap
            force = stiffness * np.maximum(0.0, depth)
            if first is None and depth.max() > 0:
                i = int(np.argmax(depth > 0))
                first = brentq(lambda s: x(s) - self.single(s)[0], grid[i - 1], grid[i], xtol=1e-15) if i else low
            peak = max(peak, self.top(x, grid, force))
            if low < 0:
                before = grid[grid <= 0]
                edges = np.append(before, 0.0) if high > 0 else before
                gap, stiffness = self.table.at(edges)
                approach = max(approach, self.top(x, edges, stiffness * np.maximum(0.0, x(edges) + self.error - gap)))
        return peak, approach, first

    def single(self, s):
        gap, stiffness = self.table.at(np.array([s]))
        return gap[0] - self.error, stiffness[0]

    def top(self, x, grid, force):
        """Greatest force near the greatest of a grid."""
        i = int(np.argmax(force))
        if force[i] <= 0.0:
            return 0.0
        low, high = grid[max(i - 1, 0)], grid[min(i + 1, len(grid) - 1)]
        lack = lambda s: -(lambda rest, stiffness: stiffness * (x(s) - rest))(*self.single(s))
        found = minimize_scalar(lack, bounds=(low, high), method="bounded", options={"xatol": 1e-7})
        return max(float(force[i]), -float(found.fun))


def measured(run, reference, method, split, rtol, repeat):
    """One line: the least time of the repeats, and the errors."""
    force, radians = run.motion.mesh.pair.force, run.motion.mesh.pitch / run.motion.mesh.pair.driven.base
    seconds = []
    for _ in range(repeat):
        run.count, begin = 0, time.perf_counter()
        peak, approach, first = run.solve(method, split, rtol)
        seconds.append(time.perf_counter() - begin)
    found = {
        "dynamic_peak_force": peak * force,
        "dynamic_peak_approach_force": approach * force,
        "dynamic_first_contact_angle": -first * radians if first is not None and first < 0 else None,
    }
    line = {"method": method, "split": split, "rtol": rtol, "seconds": min(seconds), "evaluations": run.count}
    names = {"dynamic_peak_force": "peak", "dynamic_peak_approach_force": "approach", "dynamic_first_contact_angle": "first"}
    for key, name in names.items():
        if found[key] is not None and reference.get(key):
            line[f"error_{name}"] = abs(found[key] / reference[key] - 1)
    return {**line, **{key: value for key, value in found.items() if value is not None}}


def main():
    folder = ROOT / "tests/reference/mesh"
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("case", nargs="?", default=folder / "table-1.toml")
    arguments.add_argument("reference", nargs="?")
    arguments.add_argument("--repeat", type=int, default=5)
    given = arguments.parse_args()
    path = pathlib.Path(given.reference or pathlib.Path(given.case).with_suffix(".json"))
    reference = json.loads(path.read_text())
    begin = time.perf_counter()
    run = Run(given.case)
    setup = time.perf_counter() - begin
    print(json.dumps({"case": str(given.case), "setup_seconds": setup, "error_gap": run.table.worst[0], "error_stiffness": run.table.worst[1]}))
    for method in ("dop853", "dop853-python", "lsoda", "lsoda-python"):
        for split in (False, True):
            for rtol in TOLERANCES:
                print(json.dumps(measured(run, reference, method, split, rtol, given.repeat)), flush=True)


if __name__ == "__main__":
    main()
