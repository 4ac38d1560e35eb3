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
# the places of the stiffness in ROSS
POINTS = 1000
PYTHON = sys.executable


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True, stdin=subprocess.DEVNULL).stdout


def in_turn(*commands):
    """The least seconds of each process and its output, of runs that alternate."""

    def run(command):
        begin = time.perf_counter()
        text = output(*command)
        return time.perf_counter() - begin, text

    runs = [[run(command) for command in commands] for _ in range(RUNS)]
    return [min(of_one, key=lambda pair: pair[0]) for of_one in zip(*runs)]


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
    (whole, text), (ours, _) = in_turn(
        [PYTHON, script], [program, "stiffness", case, "--points", str(POINTS), "--format", "json"]
    )
    # other packages print warnings before
    found = json.loads(text.splitlines()[-1])
    theirs, points = found["seconds"], str(found["points"])
    assert points == str(POINTS)
    ratio = solved(program, case, "--only", "contact_ratio")["contact_ratio"]["value"]
    agreement = f"contact ratio {ratio:.4f}, ROSS {found['contact_ratio']:.4f}; stiffness: [validation](validation.md)"
    work = f"mesh stiffness at {points} places; tipstrike by three models and both gears by finite elements"
    yield "ROSS 2.3.0", work + ", with its start", ours, theirs, agreement
    yield "ROSS 2.3.0", "the same with the start of Python and the import", ours, whole, ""


def numpy(program, folder):
    case = spread_case(folder)
    script = str(ROOT / "benches/tolerance.py")
    options = ["--samples", str(SAMPLES), "--ranking", "0", "--seed", "7", "--format", "json"]
    study = [program, "tolerance", case]
    (whole, text), (ours, found), (start, _) = in_turn(
        [PYTHON, script, str(SAMPLES)], [*study, *options], [*study, "--samples", "2", *options[2:]]
    )
    theirs = json.loads(text)
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
    [(ours, text)] = in_turn([program, "solve", str(case), *options, "--format", "json"])
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


def field_error(program, case, rows):
    """The greatest error of the finite elements of tipstrike against rows of teeth.json."""
    gear = json.loads(output(program, "stiffness", case, "--points", "401", "--format", "json"))["gears"][0]

    def error(row):
        radius = 1e-3 * row["radius"]
        pairs = zip(gear["points"], gear["points"][1:])
        one, other = next(pair for pair in pairs if radius <= pair[1]["radius"])
        part = (radius - one["radius"]) / (other["radius"] - one["radius"])
        tooth = one["finite_element"] + part * (other["finite_element"] - one["finite_element"])
        return abs((tooth + gear["twist"]) * 206e9 / row["qE_depth"] - 1)

    return max(error(row) for row in rows)


def plane_strain(program, folder):
    """The gear z 20 of tests/reference/field, paired with an equal gear."""
    rows = json.loads((ROOT / "tests/reference/field/teeth.json").read_text())
    gear = "teeth = 20\nprofile_shift = 0\nface_width = '10 mm'\nbore_radius = '3.5 mm'\n"
    case = str(pathlib.Path(folder) / "field.toml")
    pathlib.Path(case).write_text(
        f"format = 1\n[pair]\nmodule = '1 mm'\n[driver]\n{gear}[driven]\n{gear}"
        "[deviations]\nbase_pitch = '0 um'\n[operation]\ntorque = '1 N m'\nspeed = '100 rpm'\n"
    )
    script = str(ROOT / "benches/peers/plane_strain.py")
    (whole, text), (ours, _) = in_turn(
        [PYTHON, script, "0.1", "20"], [program, "stiffness", case, "--points", "6", "--format", "json"]
    )
    found = json.loads(text.splitlines()[-1])
    error = field_error(program, case, [row for row in rows if row["teeth"] == 20])
    agreement = f"errors {100 * error:.2f} %, scikit-fem {100 * found['error']:.2f} %"
    work = "compliance of a tooth, z 20, under six loads; tipstrike by three models for both gears"
    name = f"gmsh and scikit-fem, {found['unknowns']} unknowns"
    yield name, work + ", with its start", ours, found["seconds"], agreement
    yield name, "the same with the start of Python and the imports", ours, whole, ""


def helical(program, folder):
    reference = json.loads((ROOT / "tests/reference/helical/07-beta30-coupled.json").read_text())
    case = str(pathlib.Path(folder) / "helical.toml")
    pathlib.Path(case).write_text(reference["case"])
    key = "static_te_peak_to_peak"
    options = ["--method", "static", "--only", key, "--format", "json"]
    (_, text), (ours, answer) = in_turn(
        [PYTHON, str(ROOT / "benches/peers/helical.py"), "129"], [program, "solve", case, *options]
    )
    found = json.loads(text)
    expected = reference["results"]["cycle"]["transmission_error"]
    error = json.loads(answer)["quantities"][key]["value"] / expected - 1
    agreement = f"transmission error: error {100 * error:.3f} %, NumPy {100 * found['error']:.3f} %"
    work = "transmission error at rest of a helical pair with coupled slices and a given compliance"
    yield "NumPy, 129 slices", work + "; tipstrike with its start, NumPy without", ours, found["seconds"], agreement


def gearpie(program):
    case = str(ROOT / "tests/validation/fzg-c14.toml")
    found = solved(program, case, "--only", "contact_ratio,mesh_force")
    [(ours, _)] = in_turn([program, "solve", case, "--only", "contact_ratio,mesh_force"])
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
        rows = [*ross(program), *plane_strain(program, folder), *numpy(program, folder), *scipy(program)]
        rows += [*helical(program, folder), *gearpie(program)]
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
