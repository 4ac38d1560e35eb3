"""The cost of the Python module: python python_module.py TIPSTRIKE, with the wheel of the same commit.

Prints the microseconds that a solve from Python takes longer than the same solve in a study on one
thread, by `exact` and by `dynamic`, and the seconds of 10,000 solves on all cores from Python and by
`tipstrike sweep`. Every time is the least of several runs, which alternate.
"""

import subprocess
import sys
import time

import numpy as np
import tipstrike

# A study computes no curve at the stations.
CASE = tipstrike.example("zhou-chen-2014").changed([("model.stations", "1")], None)
# Each value needs another geometry and mesh: a study keeps no stage from one point to the next.
MODULES = np.linspace(4.9, 5.1, 51)
SPEEDS = "500..3000 rpm"
MANY = 10_000


def least(runs, *works):
    """The least seconds of each work."""

    def seconds(work):
        begin = time.perf_counter()
        work()
        return time.perf_counter() - begin

    return [min(times) for times in zip(*([seconds(work) for work in works] for _ in range(runs)))]


def overhead(method, quantity):
    study = lambda: tipstrike.sweep(CASE, {"pair.module": (MODULES, "mm")}, method=method, only=quantity, jobs=1)
    values = [(module, "mm") for module in MODULES]
    calls = lambda: [tipstrike.solve(CASE, method, only=quantity, **{"pair.module": value})[quantity] for value in values]
    assert np.array_equal(study()[quantity], calls())
    inside, outside = least(50, study, calls)
    print(f"a solve by {method}: {1e6 * outside / len(values):.1f} us from Python,"
          f" {1e6 * inside / len(values):.1f} us in a study,"
          f" {1e6 * (outside - inside) / len(values):.1f} us more")


def many(program, path):
    arguments = [program, "sweep", path, "--method", "dynamic", "--vary", f"operation.speed={SPEEDS}", "--points",
                 str(MANY), "--only", "dynamic_peak_force"]
    command = lambda: subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    module = lambda: tipstrike.sweep(path, {"operation.speed": SPEEDS}, points=MANY, method="dynamic",
                                     only="dynamic_peak_force")
    theirs, ours = least(5, command, module)
    print(f"{MANY} solves by dynamic on all cores: {ours:.2f} s from Python, {theirs:.2f} s by tipstrike sweep,"
          f" {100 * (ours / theirs - 1):+.1f} %")


overhead("exact", "impact_force")
overhead("dynamic", "dynamic_peak_force")
if sys.argv[1:]:
    many(sys.argv[1], "cases/zhou-chen-2014.toml")
