"""Runs the notebooks cell by cell: notebooks_test.py FOLDER, with the built package on PYTHONPATH."""

import json
import os
import sys
import tempfile
from pathlib import Path

folder = Path(sys.argv[1]).resolve()
os.environ["MPLBACKEND"] = "Agg"
notebooks = sorted(folder.glob("*.ipynb"))
assert len(notebooks) == 3, notebooks
for notebook in notebooks:
    print("==", notebook.name, flush=True)
    os.chdir(tempfile.mkdtemp())
    names = {"__name__": "__main__"}
    for n, cell in enumerate(json.loads(notebook.read_text())["cells"]):
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), f"{notebook.name} cell {n}", "exec"), names)
