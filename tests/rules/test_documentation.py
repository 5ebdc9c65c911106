"""The pages and the code agree: cited equations, models, the generated reference, links."""

import ast
import functools
import importlib.util
import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Annotated

import pytest
from pydantic import TypeAdapter

import eos
import hydro2d
import strength
from hydro2d.base import units
from hydro2d.deck import deck, mesh_sections, sections
from hydro2d.deck.shapes import body
from hydro2d.deck.shapes import registry as shapes
from hydro2d.materials import library, quantities
from hydro2d.mesh import fields
from hydro2d.mesh.edges import registry as edge_kinds
from hydro2d.penetration import catalogue
from strength import melting, tensile_pressure
from tests.rules import source

DOCS = source.ROOT / "docs"
EXPLANATION = DOCS / "explanation"
#: pages by name, those of the analytic models as penetration/NAME
PAGES = {
    str(file.relative_to(EXPLANATION).with_suffix("")): file.read_text(encoding="utf-8")
    for file in sorted(EXPLANATION.rglob("*.md"))
}
#: hand-written text: the pages and notebooks without the generated ones, and the README
WRITTEN = [file for file in source.tracked_files() if file.suffix in (".md", ".ipynb") and DOCS in file.parents]
WRITTEN.append(source.ROOT / "README.md")
CITATION = re.compile(
    r"\b(?P<page>" + "|".join(sorted(PAGES, key=len, reverse=True)) + r")(?:\.md)?,\s+"
    r"(?:equations?\s+)?(?P<list>\(?\d+\)?(?:(?:,|\s+and|\s+to)\s*\(?\d+\)?)*)"
)


def sentences(file) -> list[str]:
    """The sentences of a page, of a notebook with its quotes."""
    return re.split(r"(?<=[.:;])\s", re.sub(r'[\s"]+|\\\\n', " ", file.read_text(encoding="utf-8")))


def test_how_long_the_first_compilation_takes_is_said_once():
    """In the README; measurements in explanations say when and on what they were made."""
    files = [file for file in WRITTEN if EXPLANATION not in file.parents]
    mentions = [(name_of(file), text) for file in files for text in sentences(file) if "compil" in text and "minute" in text]
    assert [name for name, _ in mentions] == ["README.md"], mentions


@pytest.mark.parametrize("file", WRITTEN, ids=lambda file: str(file.relative_to(source.ROOT)))
def test_no_line_begins_with_a_per_cent_sign(file):
    """MyST takes such a line for a comment, so that the page would lose it."""
    lines = file.read_text(encoding="utf-8").splitlines()
    assert [number for number, line in enumerate(lines, 1) if line.lstrip().startswith("%") and file.suffix == ".md"] == []


def name_of(file) -> str:
    return str(file.relative_to(source.ROOT))


@functools.cache
def tags(page: str) -> tuple[int, ...]:
    """Numbers of a page's equations, in order."""
    return tuple(int(number) for number in re.findall(r"\\tag\{(\d+)\}", PAGES[page]))


def wrong_citations(text: str) -> list[str]:
    """Equations that a text cites but no page has."""
    wrong = []
    for match in CITATION.finditer(re.sub(r"\s+", " ", text)):
        for number in re.findall(r"\d+", match["list"]):
            if int(number) not in tags(match["page"]):
                wrong.append(f"explanation/{match['page']}.md has no equation {number}")
    return wrong


def docstrings(syntax: ast.AST) -> str:
    kinds = (ast.Module, ast.FunctionDef, ast.ClassDef)
    return "\n\n".join(ast.get_docstring(node) or "" for node in ast.walk(syntax) if isinstance(node, kinds))


@pytest.mark.parametrize("name", sorted(source.modules()))
def test_cited_equations_exist(name):
    assert wrong_citations(docstrings(source.tree(source.modules()[name]))) == []


def test_docstrings_cite_equations():
    cited = "".join(docstrings(source.tree(file)) for file in source.modules().values())
    assert CITATION.search(re.sub(r"\s+", " ", cited))


def test_a_wrong_citation_is_found():
    assert wrong_citations("see explanation/remap, equation 1") == []
    assert wrong_citations("see explanation/remap, equations 1 and\n 99") != []
    assert wrong_citations("(lagrangian-step, (5) and (77))") != []


@pytest.mark.parametrize("page", PAGES)
def test_equation_numbers_are_unique_and_complete(page):
    assert sorted(tags(page)) == list(range(1, len(tags(page)) + 1))


@pytest.mark.parametrize(
    ("page", "names"),
    [
        ("equation-of-state", tuple(eos.MODELS)),
        ("strength", tuple(strength.STRENGTH_MODELS)),
        ("fracture", tuple(strength.DAMAGE_MODELS)),
    ],
)
def test_every_model_is_explained(page, names):
    assert names
    assert [name for name in names if f"`{name}`" not in PAGES[page]] == []


def test_every_penetration_model_is_explained():
    """Each module has a page of its name with the figure of each of its models, and the table of all models names them."""
    lost = []
    for module in catalogue.MODULES:
        page = "penetration/" + module.__name__.rsplit(".", 1)[-1].replace("_", "-")
        names = [name for name, model in catalogue.MODELS.items() if model in catalogue.of(module)]
        assert names
        lost += [f"{page}: {name}" for name in names if f"generated/models/{name}.png" not in PAGES.get(page, "")]
        linked = f"({page.removeprefix('penetration/')}.md)" in PAGES["penetration/index"]
        lost += [f"penetration/index: {name}" for name in names if not linked or f"`{name}`" not in PAGES["penetration/index"]]
    assert lost == []


def choices(section: str, key: str) -> list[str]:
    """Words that a key of a deck accepts."""
    definition = next(d for d in deck.schema()["$defs"].values() if d.get("title") == section)
    return definition["properties"][key]["enum"]


@pytest.mark.parametrize(
    ("page", "section", "key"),
    [
        ("remap", "Numerics", "advection"),
        ("mixed-cells", "Numerics", "mixed_cell"),
        ("mixed-cells", "Numerics", "mixed_strength"),
        ("sliding", "Sliding", "method"),
    ],
)
def test_every_choice_of_method_is_explained(page, section, key):
    assert [word for word in choices(section, key) if not re.search(rf"[`{{:]{word}[`:}}]", PAGES[page])] == []


@functools.cache
def generator():
    """The module that writes the reference."""
    sys.path.insert(0, str(DOCS))
    try:
        return importlib.import_module("_generate")
    finally:
        sys.path.remove(str(DOCS))


@functools.cache
def generated() -> dict[str, str]:
    return generator().pages()


def test_the_reference_has_everything():
    pages = generated()
    assert [field.name for field in fields.FIELDS if f"`{field.name}`" not in pages["fields.md"]] == []
    assert [entry.key for entry in quantities.TABLE if f"`{entry.key}`" not in pages["fields.md"]] == []
    models = [*eos.MODELS, *strength.STRENGTH_MODELS, *strength.DAMAGE_MODELS, tensile_pressure.NAME]
    assert [name for name in models if f"### `{name}`" not in pages["models.md"]] == []
    assert [name for name in library.names() if f"## `{name}`" not in pages["materials.md"]] == []
    assert [key for key in deck.schema()["properties"] if key not in pages["deck.md"]] == []
    assert [entry.name for entry in edge_kinds.KINDS if f"| `{entry.name}` |" not in pages["deck.md"]] == []
    assert [name for name in catalogue.MODELS if f"## `{name}`" not in pages["penetration-models.md"]] == []
    assert [name for name in getattr(hydro2d, "__all__", ()) if f"## `hydro2d.{name}`" not in pages["api.md"]] == []


def test_docstrings_have_their_arguments_as_definitions():
    generator()
    docstrings = importlib.import_module("_pages.docstrings")
    lines = [
        "Runs.", "", "deck, out : where", "    it is", "**keys : more", "", "Raises Error.", "", "Attributes", "----------",
        "rows : int", "    how many", "left : what is left",
    ]
    assert docstrings.converted(lines) == [
        "Runs.", "", "deck, out", "    where", "    it is", r"\*\*keys", "    more", "", "Raises Error.", "",
        ".. rubric:: Attributes", "", "rows : int", "    how many", "left", "    what is left", "",
    ]
    prose = ["The name: that of the file.", "It is short."]
    assert docstrings.converted(prose) == [*prose, ""]


def test_the_page_of_commands_has_every_command_and_argument():
    from hydro2d.cli import main

    page = generated()["commands.md"]
    names = [name for name in main.app if not name.startswith("-")]
    assert [name for name in [*names, "model transition"] if f"## `hydro2d {name}`\n" not in page] == []
    for name in names:
        text = page.split(f"## `hydro2d {name}`\n")[1].split("\n## ")[0]
        arguments = main.app[name].assemble_argument_collection(parse_docstring=True).filter_by(show=True)
        shown = [entry.names[0].lstrip("-").upper() if entry.index is not None else entry.names[0] for entry in arguments]
        assert [word for word in shown if f"| `{word}" not in text] == []
        assert len(re.findall("^[|] `", text, re.MULTILINE)) == len(shown)
    assert "| `--set` | text, several |" in page
    assert "| `--kind` | `section`, `history`, `line`, `xt`, `crater`, `debris`, `cutaway` | `section` |" in page


def test_the_page_of_materials_says_how_many_numbers_are_how_sure():
    """All numbers of the library, each once; at most a quarter are from memory."""
    generator()
    many = importlib.import_module("_pages.materials").counts()
    page = generated()["materials.md"]
    words = set(library.CONFIDENCE) - {"default", "deck"}
    assert all(f"| `{word}` | {number} |" in page for word, number in many.items())
    listed = sum(len(re.findall(rf"^\| `[^|]*` \| `[^|]*` \| [^|]* \| [^|]* \| {word} \|", part, re.MULTILINE))
                 for part in (each.split("**Variant**")[0] for each in page.split("\n## ")) for word in words)
    assert sum(many.values()) == listed
    assert many["recalled"] < 0.25 * many.total()


def test_the_page_of_materials_has_every_source_in_full():
    page = generated()["materials.md"].replace("\\", "")
    lost = []
    for name in library.names():
        for material in (library.load(name, variant) for variant in (None, *library.load(name).variants)):
            parts = (material.eos, material.strength, material.damage)
            numbers = [*(number for part in parts for number in part.numbers.values()), *material.melting.values()]
            lost += [f"{name}: {text}" for number in numbers for text in (number.source, number.note) if text not in page]
    assert lost == []


def sections_of_the_page() -> dict[str, dict[str, str]]:
    """Examples of the page of deck keys: heading -> key -> line of a deck."""
    sections = {}
    for part in generated()["deck.md"].split("\n## ")[1:]:
        heading, *rows = part.splitlines()
        cells = [re.split(r"(?<!\\) \| ", row) for row in rows if row.startswith("| `")]
        if not heading.startswith("Boundary"):
            sections[heading] = {row[0].strip("| `"): row[4].strip("`").replace("\\|", "|") for row in cells}
    return sections


#: sections of the page of deck keys and the classes that check them
SECTIONS = {
    "Top level": sections.Deck, "`[mesh]`": mesh_sections.Mesh, "`[boundaries]`": sections.Boundaries,
    "`[numerics]`": sections.Numerics, "`[sliding]`": sections.Sliding, "`[failure]`": sections.Failure,
    "`[stop]`": sections.Stop, "`[output]`": sections.Output, "`[[tracer]]`": sections.Tracer, "`[[gauge]]`": sections.Gauge,
    "`[result.NAME]`": sections.OwnFile, "`[experiment]`": sections.Experiment, "`[penetration]`": sections.Penetration,
    "Segment: a table of `mesh.r` and `mesh.z`": mesh_sections.Segment, "Flow: a table of `body.flow`": body.Flow,
    **{f'`[[body]]` with `shape = "{shape}"`': kind for shape, kind in shapes.KINDS.items()},
}


@pytest.mark.parametrize("heading", SECTIONS)
def test_the_example_of_every_key_is_valid(heading):
    """Each line is parsed and checked against the type and the bounds of its key in the code."""
    lines, kind = sections_of_the_page()[heading], SECTIONS[heading]
    tables = {"mesh", "boundaries", "body", "materials", "numerics", "sliding", "failure", "stop", "output", "tracer", "gauge",
              "source", "result", "experiment", "penetration"} if kind is sections.Deck else set()
    assert set(lines) - {"include"} == set(kind.model_fields) - tables
    for key, line in lines.items():
        value = tomllib.loads(line)[key]
        if key != "include":
            field = kind.model_fields[key]
            TypeAdapter(Annotated[(field.annotation, field, *field.metadata)]).validate_python(value)


def test_an_example_that_is_not_valid_is_found():
    field = sections.Numerics.model_fields["courant"]
    with pytest.raises(ValueError, match="above 1 "):
        TypeAdapter(Annotated[(field.annotation, field, *field.metadata)]).validate_python(1.1)


def test_examples_of_materials_are_valid():
    """Numbers are checked against the parameters of the models, the keys of a material against the library."""
    page = sections_of_the_page()
    kinds = {"Eos": eos.MODELS, "Strength": strength.STRENGTH_MODELS, "Damage": strength.DAMAGE_MODELS,
             "Melting": {melting.NAME: melting}}
    for name, models in kinds.items():
        lines = page[f"{name}: a table of `materials.{name.lower()}`"]
        for key, line in lines.items():
            value = tomllib.loads(line)[key]
            for parameter in (entry for model in models.values() for entry in model.PARAMETERS if entry.name == key):
                parameter.check(units.to_si(value, parameter.unit or "1"))
    for key, line in page["`[materials.NAME]`"].items():
        table = {"based_on": "W_alloy", **tomllib.loads(line)}
        assert library.from_deck("mine", {"mine": table}, lambda path, text: ValueError(f"{path}: {text}")), key


def test_every_key_has_an_example():
    empty = [f"{heading} {key}" for heading, lines in sections_of_the_page().items() for key, line in lines.items() if not line]
    assert empty == []
    assert sum(map(len, sections_of_the_page().values())) > 150


def test_declared_examples_are_those_of_the_schema():
    schema = deck.schema()
    parts = [part for section in schema["$defs"].values() for part in section.get("properties", {}).values()]
    declared = [part["examples"] for part in parts if "examples" in part]
    assert len(declared) > 50
    assert all(isinstance(entry, list) and entry for entry in declared)


NEEDED = ("sphinx", "myst_nb", "furo", "sphinx-mathjax-offline")


@pytest.fixture(scope="module")
def built(tmp_path_factory) -> Path:
    """The pages as a browser gets them, built with every warning an error."""
    lost = [name for name in NEEDED if importlib.util.find_spec(name) is None]
    if lost:
        pytest.skip(f"the extra [docs] is not installed: no {', '.join(lost)}")
    folder = tmp_path_factory.mktemp("pages") / "html"
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", str(DOCS), str(folder)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


#: addresses that a browser fetches by itself; links that a reader follows are not among them
FETCHED = re.compile(
    r"<(?:script|img|iframe|source|video|audio|embed)\b[^>]*\ssrc=[\"']?(?:https?:)?//"
    r"|<link\b(?![^>]*rel=[\"'](?:canonical|license|author))[^>]*\shref=[\"']?(?:https?:)?//"
    r"|url\([\"']?(?:https?:)?//|@import\s+[\"'](?:https?:)?//"
)


def test_fetched_addresses_are_distinguished_from_links():
    assert FETCHED.search('<script defer src="https://cdn.example.org/mathjax/tex-mml-chtml.js">')
    assert FETCHED.search('<link rel="stylesheet" href="//fonts.example.org/a.css" />')
    assert FETCHED.search("@font-face { src: url(https://fonts.example.org/a.woff2) }")
    assert not FETCHED.search('<a href="https://www.sphinx-doc.org/">Sphinx</a> <script src="_static/doctools.js">')


@pytest.mark.thorough
def test_pages_fetch_nothing_from_another_host(built):
    files = [*built.rglob("*.html"), *built.rglob("*.css")]
    assert [str(file) for file in files if FETCHED.search(file.read_text(encoding="utf-8"))] == []
    page = (built / "explanation" / "remap.html").read_text(encoding="utf-8")
    script = re.search(r'src="([^"]*mathjax[^"]*)"', page)[1]
    assert (built / "explanation" / script).resolve().is_file()


@pytest.mark.thorough
def test_search_knows_the_reference(built):
    text = (built / "searchindex.js").read_text(encoding="utf-8")
    index = json.loads(text[text.index("{") : text.rindex("}") + 1])
    pages = {f"reference/generated/{name.removesuffix('.md')}" for name in generated()}
    assert pages - set(index["docnames"]) == set()
    assert {"courant", "weldox"} - set(index["terms"]) == set()


def test_every_key_of_a_deck_says_what_it_is():
    """A key without a description has a value list or a name that needs none."""
    plain = set("title name r z radius thickness shape r_max z_min z_max penetration qualifier".split())
    sections = [d for d in deck.schema()["$defs"].values() if "properties" in d]
    keys = [(key, part) for section in sections for key, part in section["properties"].items()]
    bare = {key for key, part in keys if "description" not in part and "$ref" not in part}
    assert bare - plain == set()


@pytest.mark.parametrize("file", WRITTEN, ids=name_of)
def test_links_lead_somewhere(file):
    figures = [f"models/{name}.png" for name in catalogue.MODELS] + [f"shapes/{name}.png" for name in generator().SHAPES]
    made = {f"generated/{name}" for name in [*generated(), *figures]}
    lost = []
    for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", file.read_text(encoding="utf-8")):
        if "://" in target:
            continue
        path = (file.parent / target).resolve()
        if not path.exists() and not any(str(path).endswith(name) for name in made):
            lost.append(target)
    assert lost == []
