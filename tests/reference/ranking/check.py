"""Compare the ranking of `tipstrike tolerance` with SALib on the same solves.

    python3 -m venv VENV && VENV/bin/pip install -r tests/reference/ranking/requirements.txt
    cargo build --release
    VENV/bin/python tests/reference/ranking/check.py target/release/tipstrike

Every sample, percentile and index is computed a second time from the rows of `--format csv`: the indices by SALib,
the percentiles by NumPy. A difference above 1e-9 is an error.
"""

import csv
import io
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from SALib.analyze import sobol

ROOT = Path(__file__).resolve().parents[3]
SPREAD = """
[spread]
"deviations.base_pitch" = { normal = "2 um" }
"operation.speed" = { uniform = "200 rpm" }
"driven.tip_relief" = { truncated = "6 um" }
"driver.young" = { triangular = "8 GPa" }
"""


def tolerance(program, case, *options):
    command = [program, "tolerance", case, "--set", "driven.tip_relief=8 um", "--samples", "4000", "--ranking", "2000"]
    return subprocess.run([*command, *options], check=True, capture_output=True, text=True).stdout


def compare(name, ours, theirs):
    difference = abs(ours - theirs)
    print(f"{name:40} {ours:.12g} {theirs:.12g}")
    if not difference <= 1e-9 * max(1.0, abs(theirs)):
        sys.exit(f"{name}: {ours} is not {theirs}")


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        case = Path(folder) / "case.toml"
        case.write_text((ROOT / "cases/zhou-chen-2014.toml").read_text() + SPREAD)
        found = json.loads(tolerance(program, case, "--format", "json"))
        rows = list(csv.DictReader(io.StringIO(tolerance(program, case, "--format", "csv"))))
    force = found["quantities"]["impact_force"]
    value = {(row["set"], int(row["sample"])): float(row["impact_force [N]"]) for row in rows}

    samples = np.array([value["a", number] for number in range(found["samples"])])
    figures = force["figures"]
    for percent in (5, 50, 95):
        compare(f"P{percent}", figures[f"p{percent}"]["value"], np.percentile(samples, percent))
    compare("mean", figures["mean"]["value"], samples.mean())
    compare("standard deviation", figures["standard_deviation"], samples.std(ddof=1))

    fields = [share["field"] for share in force["ranking"]]
    sets = ["a", *(f"b:{field}" for field in fields), "b"]
    ordered = np.array([value[which, number] for number in range(force["ranked"]) for which in sets])
    problem = {"num_vars": len(fields), "names": fields, "bounds": [[0, 1]] * len(fields)}
    theirs = sobol.analyze(problem, ordered, calc_second_order=False, print_to_console=False, seed=1)
    for at, share in enumerate(force["ranking"]):
        compare(f"first-order {share['field']}", share["first_order"]["value"], theirs["S1"][at])
        compare(f"total {share['field']}", share["total"]["value"], theirs["ST"][at])
        # Their intervals are resampled, ours are by the delta method.
        for ours, name in ((share["first_order"], "S1_conf"), (share["total"], "ST_conf")):
            half, resampled = (ours["to"] - ours["from"]) / 2, theirs[name][at]
            if not 0.75 < half / resampled < 1.33:
                sys.exit(f"{share['field']}: interval {half} is not {resampled}")


if __name__ == "__main__":
    main(sys.argv[1])
