"""The module against the command, its errors and its interface: pytest, offline."""

import csv
import io
import json
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import tipstrike

TABLE_1 = tipstrike.example("zhou-chen-2014")
HELICAL = {"pair.helix_angle": "15 deg", "pair.driver_hand": "right"}


def run(*arguments):
    words = [sys.executable, "-m", "tipstrike", *map(str, arguments)]
    return subprocess.run(words, capture_output=True, text=True)


def command(*arguments):
    done = run(*arguments)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("cases")
    for name in tipstrike.examples():
        (place / f"{name}.toml").write_text(tipstrike.example(name).text())
    return place


@pytest.mark.parametrize("name", tipstrike.examples())
@pytest.mark.parametrize("method", ["paper", "exact", "static", "dynamic", "auto"])
def test_a_solve_has_the_bits_of_the_command(folder, name, method):
    path = folder / f"{name}.toml"
    only = "impact_force,static_peak_force,dynamic_peak_force,contact_ratio"
    done = run("solve", path, "--method", method, "--only", only, "--stations", 16, "--format", "json")
    try:
        result = tipstrike.solve(path, method, only=only.split(","), stations=16)
    except tipstrike.CaseError as error:
        assert done.returncode == 3 and error.cause in done.stderr and error.fix in done.stderr
        return
    assert result.to_json() == done.stdout
    known = json.loads(done.stdout)
    assert result.value == {key: found["value"] for key, found in known["quantities"].items()}
    assert result.unit == {key: found["unit"] for key, found in known["quantities"].items()}
    for key, column in result.stations.items():
        if not key.startswith("line_load"):
            expected = [station.get(key) for station in known["stations"]]
            assert np.array_equal(column, np.array(expected, float), equal_nan=True), key


def test_a_whole_solve_and_its_text_are_those_of_the_command(folder):
    path = folder / "zhou-chen-2014.toml"
    result = tipstrike.solve(path)
    assert result.to_json() == command("solve", path, "--format", "json")
    assert str(result) == command("solve", path)
    force = result["F_S"]
    assert (force, force.unit, repr(force)) == (result["impact_force"].value, "N", f"{force.value!r} N")
    assert result.notes["impact-outlasts-approach"]
    with pytest.raises(KeyError, match="dynamic_peak_force: no value"):
        result["dynamic_peak_force"]


@pytest.mark.parametrize("changes", [
    {"operation.torque": "50 N m"}, {"operation.torque": "50 N m", "model.method": "dynamic"}, {"model.method": "auto"},
    {"driver.teeth": 31}, {"driver.young": ""}, {"driver.bore_diameter": "30 mm"}, {"deviations.base_pitch": "30 um"},
    {"limits.dynamic_peak_force": "1 kN", "model.method": "auto"}, {**HELICAL, "model.method": "static"},
])
def test_changes_are_those_of_the_command(folder, changes):
    path = folder / "zhou-chen-2014.toml"
    sets = [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]
    line = command("solve", path, *sets, "--only", "impact_force,static_peak_force,contact_ratio", "--format", "json")
    plain = tipstrike.read(path)
    tipstrike.solve(plain, only="contact_ratio")
    for case in plain, tipstrike.read(path):
        only = ["impact_force", "static_peak_force", "contact_ratio"]
        assert tipstrike.solve(case, only=only, **changes).to_json() == line


def test_values_are_texts_pairs_or_si():
    keys = [{"operation.speed": value} for value in ("3000 rpm", (3000, "rpm"), 3000 * 2 * np.pi / 60)]
    one, two, three = (tipstrike.solve(TABLE_1, only="impact_force", **key)["impact_force"] for key in keys)
    assert one == two and three == pytest.approx(one, rel=1e-12)
    bare = {"driver.teeth": 25, "model.damping_ratio": 0.1, "operation.speed": np.float64(200.0)}
    assert tipstrike.solve(TABLE_1, only="contact_ratio", **bare)["contact_ratio"] > 1


def test_a_dict_is_the_case_of_its_file():
    data = {
        "title": "Own pair",
        "pair": {"module": "4 mm"},
        "driver": {"teeth": 20, "face_width": 0.02, "bore_radius": (10, "mm")},
        "driven": {"teeth": 30, "face_width": "20 mm"},
        "operation": {"torque": "100 N m", "speed": (1500, "rpm")},
        "deviations": {"base_pitch": "8 um"},
        "model": {"method": "exact"},
        "limits": {"impact_force": "2 kN"},
        "spread": {"deviations.base_pitch": {"normal": "2 um"}},
        "variants": {"relieved": {"driven.tip_relief": "40 um"}},
    }
    case = tipstrike.case(data)
    assert (case.title, case.variants, case.get("driver.face_width")) == ("Own pair", ["relieved"], "0.02 m")
    assert tipstrike.case(case.text()).text() == case.text()
    plain = tipstrike.solve(data, only="impact_force")["impact_force"]
    relieved = tipstrike.solve(data, only="impact_force", variant="relieved")
    assert "impact_force" not in relieved or relieved["impact_force"] < plain
    table = tipstrike.compare(data, only=["clearing_relief"])
    assert [column["name"] for column in table["columns"]] == ["case", "case:relieved"]
    study = tipstrike.tolerance(data, samples=50, only="impact_force")
    assert len(study.columns["impact_force"]) == 50 and "percentiles" in str(study).lower() or study


def test_an_error_has_place_cause_and_fix(folder):
    bad = folder / "bad.toml"
    bad.write_text(TABLE_1.text().replace('module = "5 mm"', "module = 5"))
    with pytest.raises(tipstrike.CaseError) as found:
        tipstrike.read(bad)
    error = found.value
    assert error.place.startswith(f"{bad}:") and error.field == "pair.module" and error.cause and error.fix
    assert str(error) == f"{error.place}: {error.field}: {error.cause}: {error.fix}"
    assert str(pickle.loads(pickle.dumps(error))) == str(error)
    with pytest.raises(tipstrike.CaseError) as found:
        tipstrike.case({"pair": {"module": (-3, "mm")}})
    assert found.value.place == "case"
    with pytest.raises(tipstrike.CaseError, match="operation.speed=fast"):
        tipstrike.solve(TABLE_1, **{"operation.speed": "fast"})
    with pytest.raises(tipstrike.CaseError, match="did you mean operation.speed"):
        tipstrike.solve(TABLE_1, **{"operation.sped": "1 rpm"})
    with pytest.raises(ValueError, match="only: .*impact_force"):
        tipstrike.solve(TABLE_1, only="impact_forc")
    with pytest.raises(FileNotFoundError, match="check the path"):
        tipstrike.read(folder / "none.toml")
    newer = folder / "newer.toml"
    newer.write_text(TABLE_1.text().replace("format = 1", "format = 99"))
    with pytest.raises(tipstrike.CaseError, match="newer"):
        tipstrike.read(newer)


def test_a_sweep_has_the_rows_of_the_command(folder):
    path = folder / "zhou-chen-2014.toml"
    only = ["impact_force", "sliding_velocity"]
    vary = {"operation.speed": "500..3000 rpm", "deviations.base_pitch": (np.array([0.0, 8.0, 16.0]), "um")}
    table = tipstrike.sweep(path, vary, points=5, only=only, jobs=2)
    text = command("sweep", path, "--vary", "operation.speed=500..3000 rpm", "--points", 5, "--vary",
                   "deviations.base_pitch=0,8,16 um", "--only", ",".join(only))
    header, *rows = csv.reader(io.StringIO(text))
    assert [f"{name} [{unit}]" if unit else name for name, unit in table.units.items()] == header
    for at, (name, column) in enumerate(table.items()):
        cells = [row[at] for row in rows]
        if name not in ("outcome", "method"):
            cells = [float(cell) if cell else np.nan for cell in cells]
            assert isinstance(column, np.ndarray) and np.array_equal(column, cells, equal_nan=True), name
        else:
            assert column == cells
    si = tipstrike.sweep(path, {"operation.speed": np.linspace(50, 300, 4)}, only="impact_force")
    assert si.units["operation.speed"] == "rad/s" and np.array_equal(si["operation.speed"], np.linspace(50, 300, 4))
    with pytest.raises(ValueError, match="operation.speed: the sweep varies this field"):
        tipstrike.sweep(path, {"operation.speed": [50.0]}, **{"operation.speed": 60.0})
    methods = tipstrike.sweep(path, {"model.method": ["paper", "exact"]}, only="impact_force")
    assert methods["model.method"] == ["paper", "exact"] and methods.to_dict()["impact_force"][1] > 2000


def test_studies_are_those_of_their_commands(folder):
    path = folder / "zhou-chen-2014.toml"

    def same(study, *arguments):
        assert study.to_json() == command(*arguments, "--format", "json")
        assert dict(study)

    for vary in ("deviations.base_pitch=0..40 um", {"deviations.base_pitch": "0..40 um"},
                 {"deviations.base_pitch": ([0, 40], "um")}):
        same(tipstrike.seek(path, vary, "impact_force<=2500 N"), "seek", path, "--vary",
             "deviations.base_pitch=0..40 um", "--until", "impact_force<=2500 N")
    same(tipstrike.stiffness(path, points=5), "stiffness", path, "--points", 5)
    same(tipstrike.relief(path, load="80..100%"), "relief", path, "--load", "80..100%")
    spread = folder / "spread.toml"
    spread.write_text(TABLE_1.text() + '\n[spread]\n"deviations.base_pitch" = { normal = "1 um" }\n')
    same(tipstrike.tolerance(spread, samples=200, seed=3), "tolerance", spread, "--samples", 200, "--seed", 3)
    excitation = tipstrike.excitation(path, points=32)
    assert excitation.to_json() == command("excitation", path, "--points", 32, "--format", "json")
    assert len(excitation.period["mesh_stiffness"]) == 32 and excitation.reduced_mass > 0
    assert excitation.harmonics["mesh_stiffness_cosine"][0] == pytest.approx(
        np.mean(excitation.period["mesh_stiffness"]), rel=0.02)


def test_pages_and_pictures(folder, tmp_path):
    path = folder / "zhou-chen-2014.toml"
    picture = tipstrike.plot(path, "force")
    assert picture == command("plot", path, "--chart", "force") and picture._repr_svg_().startswith("<svg")
    tipstrike.report(path, out=tmp_path / "page.csv")
    command("report", path, "--out", tmp_path / "other.csv")
    assert (tmp_path / "page.csv").read_text() == (tmp_path / "other.csv").read_text()
    with pytest.raises(ValueError, match="there is no such chart"):
        tipstrike.plot(path, "farce")


def test_a_pair_in_slices_has_arrays_over_face_and_angle():
    for method in "static", "dynamic":
        result = tipstrike.solve(TABLE_1, method, **HELICAL)
        stations = result.stations
        load, angle, z = (stations[f"line_load{of}"] for of in ("", "_roll_angle_driver", "_z"))
        assert load.shape == (len(angle), len(z)) and angle[0] > angle[-1] and z[0] < 0 < z[-1]
        assert load.max() == pytest.approx(result[f"{method}_peak_line_load"], rel=0.05)
        at = np.unravel_index(load.argmax(), load.shape)
        assert z[at[1]] == pytest.approx(result[f"{method}_peak_line_load_position"], abs=z[1] - z[0])
        assert np.shape(stations.to_dict()["line_load"]) == load.shape
    assert "line_load" not in tipstrike.solve(TABLE_1, "static").stations


def test_work_in_threads_runs_beside_the_interpreter():
    counted = []
    work = threading.Thread(target=lambda: tipstrike.sweep(
        TABLE_1, {"operation.speed": np.linspace(100, 300, 200)}, method="dynamic", only="dynamic_peak_force"))
    work.start()
    while work.is_alive():
        counted.append(time.perf_counter())
        time.sleep(0.001)
    work.join()
    assert len(counted) > 10


def test_progress_is_reported_on_request_alone(capfd):
    seen = []
    vary = {"operation.speed": np.linspace(100, 300, 3000)}
    tipstrike.sweep(TABLE_1, vary, method="dynamic", only="dynamic_peak_force",
                    progress=lambda done, of: seen.append((done, of)))
    assert seen and all(of == 3000 for _, of in seen)
    assert capfd.readouterr() == ("", "")
    with pytest.raises(ZeroDivisionError):
        tipstrike.sweep(TABLE_1, vary, method="dynamic", only="dynamic_peak_force", progress=lambda *_: 1 / 0)


@pytest.mark.skipif(os.name != "posix", reason="signals of Unix")
def test_ctrl_c_ends_a_study():
    # A job in the background of a script ignores the signal.
    script = ("import signal, tipstrike, numpy as np\nsignal.signal(signal.SIGINT, signal.default_int_handler)\n"
              "print('begun', flush=True)\n"
              "tipstrike.sweep(tipstrike.example('zhou-chen-2014'), {'operation.speed': np.linspace(100, 300, 10**6)},"
              " method='dynamic', only='dynamic_peak_force')")
    work = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert work.stdout.readline() == "begun\n"
    time.sleep(1)
    work.send_signal(signal.SIGINT)
    _, errors = work.communicate(timeout=60)
    assert work.returncode != 0 and "KeyboardInterrupt" in errors


def test_the_command_of_the_wheel_is_the_program():
    assert command("--version").startswith("tipstrike ")
    script = pathlib.Path(sys.executable).with_name("tipstrike")
    assert not script.exists() or subprocess.run([script, "--help"], capture_output=True).returncode == 0
    done = run("solve", "none.toml")
    assert done.returncode == 5 and "none.toml" in done.stderr


def test_the_command_starts_without_numpy():
    words = [sys.executable, "-X", "importtime", "-m", "tipstrike", "--version"]
    assert "numpy" not in subprocess.run(words, capture_output=True, text=True, check=True).stderr


@pytest.mark.parametrize("before, sentence", [
    ("import sys; sys.modules['numpy'] = None", "tipstrike needs NumPy: pip install 'numpy"),
    ("import numpy; numpy.__version__ = '1.17.0'", "NumPy 1.21 or newer, this is 1.17.0: pip install -U numpy"),
    ("import sys; sys.modules['tipstrike._tipstrike'] = None", "no wheel for this interpreter (cpython 3."),
    ("import numpy, sys, importlib.machinery as m; sys.modules['tipstrike._tipstrike'] = None;"
     " m.EXTENSION_SUFFIXES.clear()", "loads no shared library, and so no wheel: use one with dynamic loading"),
])
def test_a_failed_import_names_the_cause_and_the_fix(before, sentence):
    first = "import tipstrike\ntipstrike.sweep(tipstrike.example('zhou-chen-2014'), {'pair.module': [5e-3]})"
    done = subprocess.run([sys.executable, "-c", f"{before}\n{first}"], capture_output=True, text=True)
    assert done.returncode == 1 and "ImportError" in done.stderr and sentence in done.stderr
