"""Reference answers of the methods `static` and `dynamic`: NAME.json for every NAME.toml beside this file (or those named).

    python3 generate.py [NAME ...]

Static: F_0 = sum of k_k max(0, x + e_k - S_k) solved exactly (it is linear between contacts), in f64 and again in 40 digits.
Dynamic: m x'' + c x' + sum F_k = F_0 by DOP853 (rtol 2.3e-14), restarted at every kink and at every change of contact; and again
by the classical Runge-Kutta method of fourth order in fixed steps with its own location of the changes, at two step
widths. `disagreement` stands beside the answers, relative: `static_f64` of f64 from 40 digits, `dynamic_finest_steps` of
the classical method's finer steps from DOP853, `dynamic_extrapolated` of its limit from both widths.

Readings where model.md leaves room
- the incoming tooth k = 0 keeps its error e until it leaves; every other pair has none; all pairs have their relief
- relief h(distance from the end of the flank/length), at the contact point on each flank: before E the driven tip keeps its
  whole relief while the driver's point of contact moves up its flank (rho1 grows), away from its root relief
- no length given: (eps - floor eps) pb
- warm-up from s = -warmup_cycles pb, at rest in static equilibrium; damping c x' whenever any pair carries
- `dynamic_contact_lost`: no pair carries, at some time from one base pitch before E until the incoming tooth leaves
- sliding integral: of F |sliding velocity| dt of the incoming tooth, in J per unit of the friction coefficient
Quantities that do not exist (no contact before E) are left out. Angles count from E (driven) or B (driver); time from E.
"""

import json
import math
import pathlib
import re
import sys

import mpmath
import numpy as np
from scipy.integrate import DOP853, quad, solve_ivp
from scipy.optimize import brentq

from pair import Pair

SAMPLES = 21
mpmath.mp.dps = 40


class Mesh:
    """Every pair of teeth in contact or near it when the incoming tooth stands at s."""

    def __init__(self, pair):
        self.pair = pair
        self.path, self.pitch, self.error = pair.path, pair.pitch, pair.error
        edges = [pair.place(part * pair.path)[1] for part in (0.0, 0.5, 1.0)]
        relief = sum(amount for amount, _, _ in pair.reliefs())
        far = 8 * pair.force / min(edges) + 3 * abs(pair.error) + relief
        self.reach_in = self.reach(lambda d: pair.place(-d)[0], far, pair.pitch)
        self.reach_out = self.reach(lambda d: pair.place(pair.path + d)[0], far, pair.pitch)
        self.points = pair.kinks(float(self.reach_in), float(self.reach_out))

    def reach(self, gap, far, most):
        """How far off the line of action a pair may still touch."""
        distance = most * 1e-4
        while distance < most and gap(distance) < far:
            distance *= 1.1
        return min(distance, most)

    def near(self, s):
        """Numbers k of the pairs near the path of contact."""
        first = math.ceil((-self.reach_in - s) / self.pitch)
        return range(first, math.floor((self.path + self.reach_out - s) / self.pitch) + 1)

    def springs(self, s):
        """[(k, distance that x has to close, stiffness)]."""
        found = []
        for k in self.near(s):
            gap, stiffness, _ = self.pair.place(s + k * self.pitch)
            found.append((k, gap - self.error if k == 0 else gap, stiffness))
        return found

    def static(self, s):
        """x at which the springs carry F_0, exactly."""
        springs = sorted((distance, stiffness) for _, distance, stiffness in self.springs(s))
        moment = stiffness_sum = 0
        for index, (distance, stiffness) in enumerate(springs):
            moment, stiffness_sum = moment + distance * stiffness, stiffness_sum + stiffness
            x = (self.pair.force + moment) / stiffness_sum
            if index + 1 == len(springs) or x <= springs[index + 1][0]:
                return x
        raise ValueError("no pair near the path of contact")

    def incoming(self, s, x):
        """Force on the incoming tooth, in N; below 0 by what it lacks."""
        gap, stiffness, _ = self.pair.place(s)
        return stiffness * (x + self.error - gap)

    def static_force(self, s):
        return self.incoming(s, self.static(s))

    def mean_stiffness(self, integral=lambda f, end: quad(f, 0.0, end, epsabs=0.0, epsrel=1e-13)[0]):
        """Mesh stiffness averaged over a base pitch: pairs on the line of action, no deviation, no relief."""
        return integral(lambda s: self.pair.place(s)[1], self.path) / self.pitch


def static_answers(path, mesh):
    """Quantities of `static`, and where the tooth comes in and leaves."""
    exact = Mesh(Pair(path, mpmath.mp))
    pair, low, high = mesh.pair, -mesh.reach_in, mesh.path + mesh.reach_out
    grid = np.linspace(low, high, 8001)
    force = np.array([mesh.static_force(s) for s in grid])
    carried = np.nonzero(force > 0)[0]
    if len(carried) == 0:
        return {"static_force_at_start": 0.0, "static_peak_force": 0.0}, {}, None, None
    first, last = (refined(mesh, exact, grid, i, j) for i, j in ((carried[0] - 1, carried[0]), (carried[-1], carried[-1] + 1)))
    answers, off = {}, {}

    def put(key, plain, precise):
        answers[key] = float(precise)
        off[key] = abs(float(plain / precise - 1)) if precise else abs(float(plain))

    if first[1] < 0:
        put("static_first_contact_angle", -first[0] / pair.driven.base, -first[1] / exact.pair.driven.base)
    put("static_force_at_start", max(0.0, mesh.static_force(0.0)), max(0, exact.static_force(mpmath.mpf(0))))
    peak = static_peak(mesh, grid, force)
    put("static_peak_force", mesh.static_force(peak), exact.static_force(mpmath.mpf(peak)))
    if last[1] > mesh.path:
        put("static_last_contact_angle", (last[0] - mesh.path) / pair.driver.base, (last[1] - exact.path) / exact.pair.driver.base)
    places = spread(first[0], last[0])
    samples = [(s, max(0.0, mesh.static_force(s)), max(0, exact.static_force(mpmath.mpf(s)))) for s in places]
    off["static_samples"] = max(abs(float(plain - precise)) for _, plain, precise in samples) / float(pair.force)
    answers["static_samples"] = [[-s / pair.driven.base, float(precise)] for s, _, precise in samples]
    put("mean_mesh_stiffness", mesh.mean_stiffness(), exact.mean_stiffness(lambda f, end: mpmath.quad(f, [0, end])))
    return answers, off, first[0], last[0]


def spread(first, last):
    """Places from a little before the tooth comes in until a little after it has left, closer at both ends."""
    half = 0.51 * (last - first)
    return [float((first + last) / 2 - half * math.cos(math.pi * i / (SAMPLES - 1))) for i in range(SAMPLES)]


def refined(mesh, exact, grid, i, j):
    """Where the force vanishes between two places, in f64 and in many digits."""
    plain = brentq(mesh.static_force, grid[i], grid[j], xtol=1e-18, rtol=1e-15)
    width = mpmath.mpf(grid[j] - grid[i]) * 1e-9
    precise = mpmath.findroot(exact.static_force, (plain - width, plain + width), solver="anderson", tol=1e-40, verify=False)
    return plain, precise


def static_peak(mesh, grid, force):
    """Place of the greatest static force: ternary search about the greatest of the grid, and at every kink."""
    top = int(np.argmax(force))
    low, high = grid[max(top - 1, 0)], grid[min(top + 1, len(grid) - 1)]
    best = ternary(mesh.static_force, low, high)
    kinks = [point - k * mesh.pitch for point in mesh.points for k in range(-4, 5)]
    return max([best, grid[top]] + [s for s in kinks if grid[0] < s < grid[-1]], key=mesh.static_force)


def ternary(function, low, high):
    """Place of the greatest value of a function with one hump."""
    for _ in range(70):
        a, b = low + (high - low) / 3, high - (high - low) / 3
        low, high = (a, high) if function(a) < function(b) else (low, b)
    return (low + high) / 2


class Motion:
    """The equation of motion in units in which it is of order 1: x in F_0/kbar, s in base pitches, y = (x, x' per radian
    of the natural frequency, sliding integral). Between changes of contact (`active` pairs) and kinks the right-hand side is smooth."""

    def __init__(self, mesh):
        pair = mesh.pair
        self.mesh, self.mean = mesh, mesh.mean_stiffness()
        self.unit = pair.force / self.mean
        self.frequency = math.sqrt(self.mean / pair.mass) * pair.pitch / pair.velocity
        self.begin, self.finish = -float(pair.warmup), (mesh.path + mesh.reach_out) / mesh.pitch

    def depth(self, k, s, x):
        """How deep pair k is in contact, in units of x."""
        gap = self.mesh.pair.place((s + k) * self.mesh.pitch)[0]
        return x + ((self.mesh.error if k == 0 else 0.0) - gap) / self.unit

    def smooth(self, active, s, y):
        """dy/ds with the given pairs in contact, each as a spring that pulls as well."""
        load, power, pitch = 0.0, 0.0, self.mesh.pitch
        for k in active:
            gap, stiffness, slide = self.mesh.pair.place((s + k) * pitch)
            force = stiffness / self.mean * (y[0] + ((self.mesh.error if k == 0 else 0.0) - gap) / self.unit)
            load += force
            if k == 0:
                power = force * abs(slide) / self.mesh.pair.velocity
        damping = 2 * self.mesh.pair.damping_ratio if active else 0.0
        return (self.frequency * y[1], self.frequency * (1.0 - load - damping * y[1]), power)

    def touching(self, s, y):
        """Pairs in contact from s on. Two pairs on the line of action without error touch and leave at the same instant, so
        that at a change of contact every pair is looked at, those about to change by where they go."""
        ahead, tie = 1e-7, 1e-9
        touching = set()
        for k in self.mesh.near(s * self.mesh.pitch):
            deep = self.depth(k, s, y[0])
            if abs(deep) < tie:
                deep = self.depth(k, s + ahead, y[0] + ahead * self.frequency * y[1])
            if deep > 0:
                touching.add(k)
        return frozenset(touching)

    def start(self):
        return [self.mesh.static(self.begin * self.mesh.pitch) / self.unit, 0.0, 0.0]

    def breaks(self):
        """Kinks along s, in order, E and B of the incoming tooth among them."""
        spread = range(-6, int(-self.begin) + 7)
        ends = [-self.mesh.reach_in, self.mesh.path + self.mesh.reach_out]
        points = {round((point / self.mesh.pitch - k), 15) for point in self.mesh.points + ends for k in spread}
        inside = sorted(point for point in points if self.begin + 1e-12 < point < self.finish - 1e-12)
        return [point for i, point in enumerate(inside) if i == 0 or point - inside[i - 1] > 1e-13] + [self.finish]


class Record:
    """What a run leaves behind: changes of contact, and the force of the incoming tooth on a fine grid."""

    def __init__(self, motion):
        self.motion, self.touches, self.leaves, self.lost = motion, [], [], []
        self.peak, self.approach, self.samples, self.sliding = 0.0, 0.0, {}, 0.0

    def change(self, s, before, after):
        if (0 in before) != (0 in after):
            (self.touches if 0 in after else self.leaves).append(s)
        if not after:
            self.lost.append(s)

    def force(self, s, x):
        mesh = self.motion.mesh
        return max(0.0, mesh.incoming(s * mesh.pitch, x * self.motion.unit))

    def stretch(self, low, high, dense, pieces):
        """Looks for the greatest force on a stretch that is smooth."""
        if high < -0.5 or 0 not in self.motion.mesh.near(low * self.motion.mesh.pitch):
            return
        at = lambda s: self.force(s, dense(s))
        grid = np.linspace(low, high, pieces + 1)
        values = [at(s) for s in grid]
        top = int(np.argmax(values))
        value, left, right = values[top], grid[max(top - 1, 0)], grid[min(top + 1, pieces)]
        inwards = 1e-3 * (right - left)
        if value > 0.99 * self.peak and at(left + inwards) > at(left) and at(right - inwards) > at(right):
            value = max(value, at(ternary(at, left, right)))
        self.peak = max(self.peak, value)
        if high <= 1e-12:
            self.approach = max(self.approach, value)


def by_dop853(motion, samples):
    """The run by SciPy's DOP853, restarted at kinks and at changes of contact."""
    record, state, s = Record(motion), motion.start(), motion.begin
    active = motion.touching(s, state)
    step = min(0.02, 0.25 / motion.frequency)
    for stop in motion.breaks():
        while s < stop:
            watched = list(motion.mesh.near((s + stop) / 2 * motion.mesh.pitch))
            events = [event_of(motion, k, k in active) for k in watched]
            run = solve_ivp(lambda s, y: motion.smooth(active, s, y), (s, stop), state, method="DOP853", rtol=2.3e-14,
                            atol=1e-15, max_step=step, dense_output=True, events=events)
            end = run.t[-1]
            for low, high in zip(run.t, run.t[1:]):
                record.stretch(low, high, lambda s: run.sol(s)[0], 4)
            for place in samples:
                if s <= place < end:
                    record.samples[place] = record.force(place, run.sol(place)[0])
            s, state = end, run.y[:, -1]
            if any(len(found) for found in run.t_events):
                before, active = active, motion.touching(s, state)
                record.change(s, before, active)
    record.sliding = state[2]
    return record


def event_of(motion, k, inside):
    """Event at which pair k changes its contact."""
    event = lambda s, y: motion.depth(k, s, y[0])
    event.terminal, event.direction = True, -1 if inside else 1
    return event


def by_runge_kutta(motion, samples, parts):
    """The run by the classical method in `parts` equal steps a radian of the natural frequency, stretch by stretch."""
    record, state, s = Record(motion), motion.start(), motion.begin
    active = motion.touching(s, state)
    for stop in sorted(set(motion.breaks()) | {place for place in samples if motion.begin < place < motion.finish}):
        steps = max(2, math.ceil((stop - s) * max(motion.frequency, 20.0) * parts))
        watched = list(motion.mesh.near((s + stop) / 2 * motion.mesh.pitch))
        for after in np.linspace(s, stop, steps + 1)[1:]:
            while s < after:
                s, state, active = classical_to(motion, record, watched, active, s, state, after)
        if stop in samples:
            record.samples[stop] = record.force(stop, state[0])
    record.sliding = state[2]
    return record


def classical(motion, active, s, y, h):
    """One step of the classical method."""
    slope = lambda s, y: motion.smooth(active, s, y)
    shifted = lambda by, k: (y[0] + by * k[0], y[1] + by * k[1], y[2] + by * k[2])
    k1 = slope(s, y)
    k2 = slope(s + h / 2, shifted(h / 2, k1))
    k3 = slope(s + h / 2, shifted(h / 2, k2))
    k4 = slope(s + h, shifted(h, k3))
    return tuple(y[i] + h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]) for i in range(3))


def classical_to(motion, record, watched, active, s, state, stop):
    """One step, cut at the first change of contact in it."""
    h, changed = stop - s, False
    after = classical(motion, active, s, state, h)
    for k in watched:
        if (motion.depth(k, s + h, after[0]) > 0) != (k in active):
            deep = lambda part: motion.depth(k, s + part, classical(motion, active, s, state, part)[0])
            if (deep(0.0) > 0) != (deep(h) > 0):
                h, changed = brentq(deep, 0.0, h, xtol=1e-17, rtol=1e-14), True
                after = classical(motion, active, s, state, h)
    record.stretch(s, s + h, lambda t: classical(motion, active, s, state, t - s)[0], 1)
    if not changed:
        return stop, after, active
    touching = motion.touching(s + h, after)
    record.change(s + h, active, touching)
    return s + h, after, touching


def dynamic_answers(mesh, first, last):
    """Quantities of `dynamic` by both methods and their relative difference."""
    motion, pair = Motion(mesh), mesh.pair
    low, high = (first, last) if first is not None else (0.0, mesh.path)
    places = [s / mesh.pitch for s in spread(low, high)]
    runs = [by_dop853(motion, places), by_runge_kutta(motion, places, 40), by_runge_kutta(motion, places, 80)]
    found = [quantities(motion, run) for run in runs]
    extrapolated = {key: richardson(value, found[2][key]) for key, value in found[1].items()}
    off = [differences(pair, other, found[0]) for other in (extrapolated, found[2])]
    answers = {
        "equivalent_mass": pair.mass, "periods_per_base_pitch": motion.frequency / (2 * math.pi), **found[0],
        "incoming_contact_changes": [s * mesh.pitch / pair.velocity for s in sorted(runs[0].touches + runs[0].leaves)],
    }
    return answers, off


def richardson(coarse, fine):
    """The limit of a method of fourth order from its answers at h and h/2."""
    if isinstance(fine, bool):
        return fine
    if isinstance(fine, list):
        return [[place, richardson(a, b)] for (place, b), (_, a) in zip(fine, coarse)]
    return (16 * fine - coarse) / 15


def quantities(motion, run):
    """Quantities of one run, SI."""
    mesh, pair = motion.mesh, motion.mesh.pair
    answers, per_second = {}, mesh.pitch / pair.velocity
    if run.touches and run.touches[0] < 0:
        answers["dynamic_first_contact_angle"] = -run.touches[0] * mesh.pitch / pair.driven.base
    answers["dynamic_peak_approach_force"] = run.approach
    answers["dynamic_peak_force"] = run.peak
    end = run.leaves[-1] if run.leaves else 0.0
    answers["dynamic_contact_lost"] = any(-1 <= s < end for s in run.lost)
    answers["contact_lost_anywhere"] = any(s < end for s in run.lost)
    answers["dynamic_last_contact_time"] = end * per_second
    answers["sliding_integral"] = run.sliding * pair.force * mesh.pitch
    answers["dynamic_samples"] = [[s * per_second, run.samples[s]] for s in sorted(run.samples)]
    return answers


def differences(pair, found, reference):
    """Relative differences of two sets of quantities; forces of samples relative to F_0."""
    off = {}
    for key, value in reference.items():
        if key == "dynamic_samples":
            off[key] = max(abs(a[1] - b[1]) for a, b in zip(found[key], value)) / pair.force
        elif isinstance(value, bool):
            off[key] = float(found[key] != value)
        else:
            off[key] = abs(found.get(key, math.inf) - value) / (abs(value) or 1.0)
    return off


def answer(path):
    """Everything for one case."""
    pair = Pair(path)
    mesh = Mesh(pair)
    answers = {"mesh_force": pair.force, "contact_ratio": pair.ratio, "base_pitch": pair.pitch, "static_equivalent_error": pair.error}
    static, off, first, last = static_answers(path, mesh)
    dynamic, (extrapolated, classical_off) = dynamic_answers(mesh, first, last)
    disagreement = {"static_f64": off, "dynamic_extrapolated": extrapolated, "dynamic_finest_steps": classical_off}
    return {**answers, **static, **dynamic, "disagreement": disagreement}


def main():
    folder = pathlib.Path(__file__).parent
    names = sys.argv[1:] or sorted(path.stem for path in folder.glob("*.toml"))
    for name in names:
        answers = answer(folder / f"{name}.toml")
        text = re.sub(r"\[\s+([^\[\],]+?),\s+([^\[\],]+?)\s+\]", r"[\1, \2]", json.dumps(answers, indent=1))
        (folder / f"{name}.json").write_text(text + "\n")
        worst = {kind: max(values.values(), default=0.0) for kind, values in answers["disagreement"].items()}
        print(name, {kind: f"{value:.1e}" for kind, value in worst.items()}, flush=True)


if __name__ == "__main__":
    main()
