"""Runs the notebooks: notebooks_test.py FOLDER, with the built package on PYTHONPATH. By Jupyter where it is installed, else
cell by cell."""

import json
import os
import sys
import tempfile
from pathlib import Path

try:
    import ipykernel  # noqa: F401
    import nbformat
    from nbconvert.preprocessors import ExecutePreprocessor
except ImportError:
    nbformat = None


def by_jupyter(notebook):
    cells = nbformat.read(notebook, as_version=4)
    ExecutePreprocessor(timeout=600, kernel_name="python3").preprocess(cells, {"metadata": {"path": tempfile.mkdtemp()}})


def cell_by_cell(notebook):
    os.chdir(tempfile.mkdtemp())
    names = {"__name__": "__main__"}
    for n, cell in enumerate(json.loads(notebook.read_text())["cells"]):
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), f"{notebook.name} cell {n}", "exec"), names)


os.environ["MPLBACKEND"] = "Agg"
notebooks = sorted(Path(sys.argv[1]).resolve().glob("*.ipynb"))
assert len(notebooks) == 4, notebooks
for notebook in notebooks:
    print(notebook.name, "by Jupyter" if nbformat else "cell by cell", flush=True)
    (by_jupyter if nbformat else cell_by_cell)(notebook)
