"""Names in every format: what is read back is what was written, and no name means anything to the format."""

import csv
import html
import html.parser
import io
import json
import shlex
import subprocess
import tomllib
import unicodedata
import warnings
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree

import h5py
import matplotlib.text
import pytest
from matplotlib.figure import Figure
from rich.console import Console
from rich.text import Text

from hydro2d.base import formats
from hydro2d.base.errors import DeckError
from hydro2d.deck import deck
from hydro2d.study.report import rods
from hydro2d.study.report.report import report
from tests.cli.test_main import DECK
from tests.names import PLACED
from tests.study import fake
from tests.study.html import Page


class Words(html.parser.HTMLParser):
    """The attributes and the text of a page, and its tags."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.said, self.values = [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.values += [value for _, value in attrs]

    def handle_data(self, data):
        self.said.append(data)


def test_the_names_are_of_every_printable_category():
    kinds = {unicodedata.category(character) for name in PLACED for character in name}
    assert kinds >= {"Lu", "Ll", "Lo", "Lm", "Mn", "Mc", "Me", "Nd", "No", "Sm", "Sc", "Sk", "So", "Pd", "Ps", "Pe", "Po", "Zs"}
    assert len(PLACED) > 400


def test_files(tmp_path):
    """A file of each name, on a file system that ignores capitals and the way of writing accents as well."""
    names = formats.distinct(map(formats.file_name, PLACED))
    assert len({unicodedata.normalize("NFC", name).casefold() for name in names}) == len(PLACED)
    for name in names:
        (tmp_path / f"{name}.png").write_text(name)
        assert name.isascii()
        assert not set(name) & set('<>:"/\\|?* ')
        assert not name.startswith(("-", "."))
        assert not name.endswith(("-", "."))
        assert name.lower().split(".")[0] not in ("con", "nul", "com1")
    assert len(list(tmp_path.iterdir())) == len(PLACED)
    assert formats.file_name("W_alloy-1.5") == "W_alloy-1.5"


def test_ids_of_elements():
    assert formats.html_id("Depth: <b>Ø 3 mm</b>") == "Depth-b-Ø-3-mm-b"
    assert not any(set(formats.html_id(name)) & set(" \t\"'<>&") for name in PLACED)


@pytest.mark.parametrize("name", PLACED, ids=ascii)
def test_texts(name):
    page = Words(f'<p title="{formats.in_html(name)}">{formats.in_html(name)}</p>')
    assert (page.tags, page.values, "".join(page.said)) == (["p"], [name], name)
    plotly = formats.in_plotly(name)
    assert html.unescape(plotly) == name
    assert "<" not in plotly
    script = formats.in_script({name: name})
    assert json.loads(script) == {name: name}
    assert "<" not in script
    assert tomllib.loads(f"{formats.in_toml(name)} = 1") == {name: 1}
    assert shlex.split(formats.in_shell(name)) == [name]
    assert shlex.split(formats.in_shell(Path(name)))[0].startswith("-") is False
    assert ElementTree.fromstring(f'<DataArray Name="{formats.in_xml(name)}"/>').get("Name") == name
    assert matplotlib.text.Text()._preprocess_math(formats.in_figure(name)) == (name, False)
    console = Console(file=io.StringIO(), width=1000)
    console.print(Text(formats.one_line(name)))
    assert console.file.getvalue() == f"{name}\n"


def test_a_shell_runs_none_of_them():
    line = formats.in_shell("printf", "%s\\n", *PLACED)
    done = subprocess.run(["sh", "-c", line], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n")[:-1] == list(PLACED)


def test_cells():
    """Every name is another cell, none is a formula, and all are read back."""
    names = [*PLACED, *(f"'{name}" for name in PLACED)]
    text = io.StringIO()
    csv.writer(text).writerows([formats.cell(name)] for name in names)
    cells = [row[0] for row in csv.reader(io.StringIO(text.getvalue(), newline=""))]
    assert [formats.of_cell(cell) for cell in cells] == names
    assert not [cell for cell in cells if cell.startswith(tuple("=+-@＝＋－＠"))]


def test_datasets(tmp_path):
    given = {name: formats.in_hdf5(name) for name in PLACED if name not in (".", "/")}
    with h5py.File(tmp_path / "a.h5", "w") as file:
        for name in dict.fromkeys(given.values()):
            file[name] = 1.0
    with h5py.File(tmp_path / "a.h5") as file:
        assert set(file) == set(given.values())


def test_legends(tmp_path):
    """No label is left out, and none is a formula."""
    names = ["_rod", "__", "$a$", "rod"]
    figure = Figure()
    axes = figure.subplots()
    for name in names:
        axes.plot([0, 1], [0, 1], label=formats.in_legend(name))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        entries = axes.legend().get_texts()
        figure.savefig(tmp_path / "a.png")
    assert [entry._preprocess_math(entry.get_text())[0].strip() for entry in entries] == names


HOSTILE = ("=1+1", "<img src=x onerror=alert(1)>", "$x_", "[b]a[/b]", "_a", 60 * "$", "CON", "con", "</script>", "%{x}", "{0}",
           "'=2")


def test_a_report_of_a_study_of_such_names(tmp_path):
    """Its axis and variants have them: the page is well-formed, the table holds them, and the pictures are there."""
    labels = {name: (f"numerics.courant=0.{number + 20}",) for number, name in enumerate(HOSTILE)}
    study = fake.write_study(tmp_path / "study", {"=<b>$_[x]": labels, "velocity": fake.velocities(1086)})
    said = []
    file = report([study], say=said.append)
    page = Page(file.read_text(encoding="utf-8"))
    assert page.faults == []
    assert not [attributes for _, attributes in page.elements if "onerror" in attributes]
    rows = list(csv.DictReader(io.StringIO((file.parent / "cases.csv").read_text(encoding="utf-8"), newline="")))
    assert {formats.of_cell(row["'=<b>$_[x]"]) for row in rows} == set(HOSTILE)
    assert list(file.parent.glob("rods_*.png"))


def test_dollar_signs_on_several_lines_of_a_picture():
    """A line that ended within an escaped sign began a formula."""
    for begin in ("", "a"):
        case = SimpleNamespace(name=begin + 25 * "$", values={})
        record = SimpleNamespace(case=case, perforated=False, outcome=SimpleNamespace(depth_m=None), unfinished="")
        lines = rods._label(record).split("\n")
        drawn = [matplotlib.text.Text()._preprocess_math(line) for line in lines]
        assert len(lines) > 1
        assert ("".join(text for text, _ in drawn), any(formula for _, formula in drawn)) == (case.name, False)


@pytest.mark.parametrize(("key", "name", "reason"), [
    ("materials", "a\nb", r"""materials\."a\\nb": 'a\\nb' has '\\n'"""), ("materials", "", 'materials."": is empty'),
    ("materials", "a\u200bb", r"'a\\u200bb' has '\\u200b'"), ("materials", 201 * "x", "has 201 characters"),
])
def test_names_of_materials_are_printable(key, name, reason):
    with pytest.raises(DeckError, match=reason) as error:
        deck.loads(f'{DECK}\n[{key}.{json.dumps(name)}]\nbased_on = "Al5083"\n')
    assert "\n" not in str(error.value)


def test_the_name_of_a_run_is_that_of_a_folder():
    with pytest.raises(DeckError, match="name: has 400 bytes; the name of a folder has at most 200"):
        deck.loads(DECK, [f'name="{100 * "😀"}"'])
    assert deck.loads(DECK, ['name="Größe"']).name == "Größe"
