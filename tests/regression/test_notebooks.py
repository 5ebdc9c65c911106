"""The tutorial notebooks: their code runs as in Jupyter, and their output is stored with them.

``jupyter execute --inplace docs/tutorials/NAME.ipynb`` stores it anew.
"""

import re

import nbformat
import pytest
from nbclient import NotebookClient

from tests.rules import source

NOTEBOOKS = [file for file in source.tracked_files() if file.suffix == ".ipynb"]
#: the first code cell, which sets the length of the run, and its replacement in the test
SIZE, SMALL = re.compile(r'END = "[^"]+"'), 'END = "4 us"'
#: largest size of a stored notebook, bytes
HEAVY = 1_500_000


def read(file):
    return nbformat.read(file, as_version=4)


def code(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def shown(notebook):
    """The output of every cell, by its name: stream names and kinds of data."""
    return {cell.id: [sorted(output.get("data", [output.get("name")])) for output in cell.outputs] for cell in code(notebook)}


def faults(notebook):
    """Faults of a stored notebook."""
    size, *others = code(notebook)
    wrong = [] if SIZE.fullmatch(size.source) else [f"{size.id}: the first cell sets END and nothing else"]
    counts = [cell.execution_count for cell in (size, *others)]
    if counts != list(range(1, len(counts) + 1)):
        wrong.append(f"the cells were not run once each, in order: {counts}")
    wrong += [f"{cell.id}: shows nothing" for cell in others if not cell.outputs]
    for cell in others:
        wrong += [f"{cell.id}: {each.ename}" for each in cell.outputs if each.output_type == "error"]
        wrong += [f"{cell.id}: {each.text}" for each in cell.outputs if each.get("name") == "stderr"]
    return wrong


def test_there_is_a_notebook():
    assert [file.stem for file in NOTEBOOKS] == ["calibrate-a-bar", "look-at-a-run"]


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_a_notebook_is_stored_as_it_ran(file):
    assert faults(read(file)) == []
    assert file.stat().st_size < HEAVY


@pytest.mark.thorough
@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_a_notebook_runs(file, tmp_path):
    """On a shot of microseconds, in a folder of its own; the output of every cell is of the stored kind."""
    notebook = read(file)
    stored = shown(notebook)
    code(notebook)[0].source = SMALL
    NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(tmp_path)}}).execute()
    assert shown(notebook) == stored


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda cells: cells[3].outputs.clear(), "shows nothing"),
        (lambda cells: cells.pop(2), "not run once each"),
        (lambda cells: cells[0].update(source='END = "4 us"\nprint(1)'), "sets END"),
        (lambda cells: cells[1].outputs.append(nbformat.v4.new_output("error", ename="ValueError", evalue="", traceback=[])),
         "ValueError"),
        (lambda cells: cells[1].outputs.append(nbformat.v4.new_output("stream", name="stderr", text="a warning")), "a warning"),
    ],
)
def test_a_fault_of_a_notebook_is_found(spoil, said):
    notebook = read(NOTEBOOKS[0])
    cells = code(notebook)
    spoil(cells)
    notebook.cells = cells
    assert said in " ".join(faults(notebook))
