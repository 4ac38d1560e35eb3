"""Runs the notebooks of docs/notebooks, which are kept without outputs: python notebooks.py [NAME...]."""

import json
import pathlib
import sys
import time

FOLDER = pathlib.Path(__file__).resolve().parent.parent.parent / "docs/notebooks"


def run(path):
    cells = [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]
    assert not any(cell["outputs"] or cell["execution_count"] for cell in cells), f"{path.name} has outputs"
    names = {}
    for cell in cells:
        exec(compile("".join(cell["source"]), path.name, "exec"), names)


paths = sorted(FOLDER.glob("*.ipynb"))
wanted = [path for path in paths if not sys.argv[1:] or path.stem in sys.argv[1:]]
assert wanted, f"{FOLDER} has no such notebook"
for path in wanted:
    begin = time.perf_counter()
    print(f"== {path.stem}")
    run(path)
    print(f"{path.stem}: ok in {time.perf_counter() - begin:.0f} s")
