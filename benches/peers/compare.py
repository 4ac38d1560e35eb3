"""Times of tipstrike and of its peers on the same work: python compare.py TIPSTRIKE PAGE.

Replaces the table between the marks in PAGE. Every time is the least of several runs. Times of a
whole process contain its start; times inside of a process do not.
"""

import datetime
import json
import os
import pathlib
import platform
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
OPEN, CLOSE = "<!-- peers -->\n", "<!-- /peers -->"
RUNS = 3
SAMPLES = 100_000
PYTHON = sys.executable


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True, stdin=subprocess.DEVNULL).stdout


def least(*command):
    """The least seconds of a process, and its output."""

    def run():
        begin = time.perf_counter()
        text = output(*command)
        return time.perf_counter() - begin, text

    return min((run() for _ in range(RUNS)), key=lambda pair: pair[0])


def solved(program, case, *options):
    return json.loads(output(program, "solve", case, "--format", "json", *options))["quantities"]


def spread_case(folder):
    """The case of benches/tolerance.py: Table 1, deflection by the load, a relief, distributions."""
    text = (ROOT / "cases/zhou-chen-2014.toml").read_text()
    lines = [line for line in text.splitlines() if not line.startswith("deflection")]
    driver, driven = "\n".join(lines).split("[driven]")
    driven = driven.replace('tip_relief = "0 um"', 'tip_relief = "24 um"', 1)
    driven = driven.replace('"2500 N"', '"1000 N"')
    path = pathlib.Path(folder) / "spread.toml"
    path.write_text(
        f"{driver}[driven]{driven}\n[spread]\n"
        '"deviations.base_pitch" = { normal = "2 um" }\n'
        '"operation.power" = { uniform = "1 kW" }\n'
        '"driven.tip_relief" = { normal = "3 um" }\n'
    )
    return str(path)


def ross(program):
    case = str(ROOT / "tests/validation/ross-62-62.toml")
    script = str(ROOT / "benches/peers/ross_mesh.py")
    whole, text = least(PYTHON, script)
    # other packages print warnings before
    found = json.loads(text.splitlines()[-1])
    theirs, points = found["seconds"], str(found["points"])
    ours, _ = least(program, "stiffness", case, "--points", points, "--format", "json")
    ratio = solved(program, case, "--only", "contact_ratio")["contact_ratio"]["value"]
    agreement = f"contact ratio {ratio:.4f}, ROSS {found['contact_ratio']:.4f}; stiffness: [validation](validation.md)"
    work = f"mesh stiffness at {points} places; tipstrike by three models and both gears by finite elements"
    yield "ROSS 2.3.0", work + ", with its start", ours, theirs, agreement
    yield "ROSS 2.3.0", "the same with the start of Python and the import", ours, whole, ""


def numpy(program, folder):
    case = spread_case(folder)
    script = str(ROOT / "benches/tolerance.py")
    whole, text = least(PYTHON, script, str(SAMPLES))
    theirs = json.loads(text)
    options = ["--samples", str(SAMPLES), "--ranking", "0", "--seed", "7", "--format", "json"]
    ours, found = least(program, "tolerance", case, *options)
    start, _ = least(program, "tolerance", case, "--samples", "2", *options[2:])
    median = json.loads(found)["quantities"]["impact_force"]["figures"]["p50"]["value"]
    agreement = f"median force {median:.1f} N, NumPy {theirs['percentiles'][1]:.1f} N"
    work = f"{SAMPLES} samples of the impact force by `exact`"
    yield "NumPy, two threads", work + ", whole processes", ours, whole, agreement
    yield "NumPy, two threads", "the same without the start of either", ours - start, theirs["seconds"], ""


def scipy(program):
    case = ROOT / "tests/reference/mesh/table-1.toml"
    lines = output(PYTHON, str(ROOT / "benches/scipy_dynamic.py"), str(case), "--repeat", str(RUNS)).splitlines()
    first, *runs = [json.loads(line) for line in lines]
    worst = lambda run: max(value for key, value in run.items() if key in ("error_peak", "error_approach", "error_first"))
    reference = json.loads(case.with_suffix(".json").read_text())
    keys = ["dynamic_peak_force", "dynamic_peak_approach_force", "dynamic_first_contact_angle"]
    options = ["--method", "dynamic", "--only", ",".join(keys)]
    ours, text = least(program, "solve", str(case), *options, "--format", "json")
    found = json.loads(text)["quantities"]
    error = max(abs(found[key]["value"] / reference[key] - 1) for key in keys if key in reference)
    good = [run for run in runs if worst(run) <= 1e-5]
    quickest = min(good, key=lambda run: run["seconds"])
    name = f"{quickest['method'].upper()} at {quickest['rtol']:g}"
    agreement = f"errors {error:.0e}, SciPy {worst(quickest):.0e}"
    work = "one motion (`dynamic`) of Table 1 with errors below 1e-5"
    setup = first["setup_seconds"]
    yield f"SciPy, {name}", work + "; tipstrike with its start, SciPy without", ours, setup + quickest["seconds"], agreement
    yield f"SciPy, {name}", "the same, SciPy on given tables of stiffness", ours, quickest["seconds"], ""


def gearpie(program):
    case = str(ROOT / "tests/validation/fzg-c14.toml")
    found = solved(program, case, "--only", "contact_ratio,mesh_force")
    ours, _ = least(program, "solve", case, "--only", "contact_ratio,mesh_force")
    ratio, force = found["contact_ratio"]["value"], found["mesh_force"]["value"]
    agreement = f"contact ratio {ratio:.3f}, GEARpie 1.46; force {force:.1f} N, GEARpie 5912.1 N"
    yield "GEARpie's report", "geometry and load of FZG C14; its figures only, no package runs it", ours, None, agreement


def shown(seconds):
    if seconds is None:
        return "-"
    for unit, size in (("s", 1.0), ("ms", 1e-3)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e6:.3g} us"


def processor():
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines() if os.path.exists("/proc/cpuinfo") else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def table(program):
    with tempfile.TemporaryDirectory() as folder:
        rows = [*ross(program), *numpy(program, folder), *scipy(program), *gearpie(program)]
    cells = [["peer", "work", "tipstrike", "peer's time", "ratio", "results"], ["---"] * 6]
    for name, work, ours, theirs, agreement in rows:
        ratio = f"{theirs / ours:.3g}" if theirs else "-"
        cells.append([name, work, shown(ours), shown(theirs), ratio, agreement])
    load = os.getloadavg()[0]
    version = output(program, "--version").strip()
    date = datetime.date.today()
    where = f"{version}, {processor()}, {os.cpu_count()} cores, load {load:.1f} at the end, {date:%-d %B %Y}."
    return "".join(f"| {' | '.join(row)} |\n" for row in cells) + f"\n{where}\n"


def main(program, page):
    path = pathlib.Path(page)
    text = path.read_text()
    head, rest = text.split(OPEN)
    _, tail = rest.split(CLOSE)
    made = table(os.path.abspath(program))
    path.write_text(head + OPEN + made + CLOSE + tail)
    print(made)


main(*sys.argv[1:])
