"""Runs every script of docs/scripting.md and docs/studies.md: python recipes.py TIPSTRIKE.

The Python blocks of a page run as one script, each Snakemake block as a file of its own with fewer
points, and the Slurm script once per task with the variables that Slurm sets.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SPREAD = '\n[spread]\n"deviations.base_pitch" = { normal = "2 um" }\n'


def blocks(page, language):
    text = (ROOT / "docs" / page).read_text()
    found = re.findall(rf"^```{language}\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    assert found, f"{page} has no block of {language}"
    return found


def run(folder, *command, **variables):
    done = subprocess.run(command, cwd=folder, env=os.environ | variables, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"recipes: {' '.join(command)} fails\n{done.stdout}{done.stderr}")
    return done.stdout


def fresh(folder, name):
    place = folder / name
    place.mkdir()
    case = (ROOT / "cases/zhou-chen-2014.toml").read_text()
    (place / "gear.toml").write_text(case + SPREAD)
    return place


def python(folder):
    place = folder / "python"
    place.mkdir()
    [files] = blocks("scripting.md", "sh")
    run(place, "sh", "-c", files)
    (place / "script.py").write_text("\n".join(blocks("scripting.md", "python")))
    out = run(place, sys.executable, "script.py")
    assert "the force grows with the speed to the power 1." in out, out
    assert "corner-contact 2191.0" in out, out
    assert "operation.speed 0." in out, out
    print(out, end="")


def slurm(folder):
    place = fresh(folder, "slurm")
    [script] = [text for text in blocks("studies.md", "sh") if "#SBATCH" in text]
    assert "--samples 100000000" in script and "/64" in script
    (place / "job.sh").write_text(script.replace("100000000", "64").replace("/64", "/2"))
    for task in ("1", "2"):
        run(place, "sh", "job.sh", SLURM_ARRAY_TASK_ID=task, SLURM_CPUS_PER_TASK="2")
    run(place, "tipstrike", "gather", "part-1.shard", "part-2.shard", "--out", "whole.txt")
    assert (place / "whole.txt").stat().st_size > 0


def snakemake(folder):
    pages = [("scripting.md", "gear.html"), ("studies.md", "whole.csv")]
    for page, result in pages:
        [text] = blocks(page, "snakemake")
        place = fresh(folder, f"snakemake-{page}")
        text = text.replace("N = 64", "N = 2").replace("--points 100000", "--points 20")
        (place / "Snakefile").write_text(text)
        run(place, sys.executable, "-m", "snakemake", "--cores", "2", "--quiet", "all")
        assert (place / result).stat().st_size > 0, result


def main(program):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        tools = folder / "bin"
        tools.mkdir()
        shutil.copy(program, tools / "tipstrike")
        os.environ["PATH"] = f"{tools}:{os.environ['PATH']}"
        os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
        for recipe in (python, slurm, snakemake):
            recipe(folder)
            print(f"{recipe.__name__}: ok")


main(sys.argv[1])
