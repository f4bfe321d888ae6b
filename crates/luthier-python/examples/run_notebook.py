"""Runs a notebook, and writes it with what its cells gave: run_notebook.py IN.ipynb OUT.ipynb. Fails where a cell fails or no plot came out."""

import sys

import nbformat
from nbclient import NotebookClient

notebook = nbformat.read(sys.argv[1], as_version=4)
NotebookClient(notebook, timeout=600).execute()
nbformat.write(notebook, sys.argv[2])
outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
plots = sum("image/png" in output.get("data", {}) for output in outputs)
print(f"{len(notebook.cells)} cells, {plots} plots")
sys.exit(plots == 0)
