"""A run in a notebook: the output below the cell, in a kernel like Jupyter's; other processes are not notebooks."""

import nbformat
import pytest
from nbclient import NotebookClient

from hydro2d.base import moving

CELLS = [
    "import hydro2d\n"
    "deck = hydro2d.Deck.from_file('problems/templates/taylor.toml', {'stop.time': '2 us', 'mesh.cells_across': 3})\n"
    "deck",
    "shot = hydro2d.run(deck, 'shot', threads=1)",
    "shot",
    "hydro2d.run(deck, 'quiet', threads=1, quiet=True);",
    "import time\n"
    "from hydro2d import jit\n"
    "from hydro2d.jit import compilation\n"
    "compilation.BEAT = 0.1\n"
    "compilation.expect('none', lambda: [])\n"
    "with compilation.events.trigger_event(jit.FIRST_CALL, data={'kernel': 'a'}):\n"
    "    time.sleep(0.5)",
]


@pytest.fixture(scope="module")
def cells(tmp_path_factory):
    """The notebook after its run."""
    pages = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text) for text in CELLS])
    place = tmp_path_factory.mktemp("notebook")
    NotebookClient(pages, timeout=600, resources={"metadata": {"path": str(place)}}).execute()
    return pages.cells


@pytest.mark.thorough
def test_one_place_below_the_cell_has_the_title_and_the_result(cells):
    (shown,) = cells[1].outputs
    assert shown.output_type == "display_data"
    page = shown.data["text/html"]
    assert page.startswith("<pre>Copper bar on a rigid wall at 190 m/s\nwarning: ")
    assert "done: end time" in page
    assert "<progress" not in page  # the run is over
    assert "ipykernel" not in page


def test_the_results_are_one_line_and_a_quiet_run_shows_nothing(cells):
    assert cells[0].outputs[0].data["text/plain"] == "<Deck taylor: Copper bar on a rigid wall at 190 m/s; bodies bar>"
    assert cells[2].outputs[0].data["text/plain"].startswith("<Results shot: end time at 2.0")
    assert cells[3].outputs == []


def test_a_line_below_the_cell_tells_what_a_program_compiles(cells):
    """Nothing is compiled here: the first call of a kernel just takes long."""
    (shown,) = cells[4].outputs
    assert shown.data["text/html"].startswith("<pre>compiled kernels: ")
    assert shown.data["text/plain"].endswith(", 1 s") or shown.data["text/plain"].endswith(", 0 s")


def test_the_page_of_a_line_has_a_bar():
    page = moving.Page(["compiling kernels: 1 of 2, 3 s"], 0.5, bar=True)
    assert page._repr_html_().startswith('<pre>compiling kernels: 1 of 2, 3 s</pre><progress max="1" value="0.5000"')


def test_the_page_has_a_bar_and_a_table_and_escapes_names():
    page = moving.Page(["<b>"], 0.25, {"time": "1 & 2"})
    assert page._repr_html_().startswith('<pre>&lt;b&gt;</pre><progress max="1" value="0.2500"')
    assert "<tr><th>time</th><td>1 &amp; 2</td></tr>" in page._repr_html_()
    assert repr(page) == "<b>\ntime  1 & 2"
    assert " value=" not in moving.Page([], None, {"time": "1"})._repr_html_()


def test_a_test_is_no_notebook():
    assert not moving.is_notebook()
