"""The pages and the code agree: cited equations, models, the generated reference, links, decks in the text."""

import ast
import functools
import importlib.util
import re

import pytest

import eos
import hydro2d
import strength
from hydro2d.deck import deck
from hydro2d.materials import library
from hydro2d.mesh import edges, fields, quantities
from hydro2d.penetration import catalogue
from strength import tensile_pressure
from tests.rules import source

DOCS = source.ROOT / "docs"
EXPLANATION = DOCS / "explanation"
#: pages by name, those of the analytic models as penetration/NAME
PAGES = {
    str(file.relative_to(EXPLANATION).with_suffix("")): file.read_text(encoding="utf-8")
    for file in sorted(EXPLANATION.rglob("*.md"))
}
#: what people wrote: the pages and notebooks without the generated ones, and the README
WRITTEN = [file for file in source.tracked_files() if file.suffix in (".md", ".ipynb") and DOCS in file.parents]
WRITTEN.append(source.ROOT / "README.md")
CITATION = re.compile(
    r"\b(?P<page>" + "|".join(sorted(PAGES, key=len, reverse=True)) + r")(?:\.md)?,\s+"
    r"(?:equations?\s+)?(?P<list>\(?\d+\)?(?:(?:,|\s+and|\s+to)\s*\(?\d+\)?)*)"
)


def name_of(file) -> str:
    return str(file.relative_to(source.ROOT))


@functools.cache
def tags(page: str) -> tuple[int, ...]:
    """Numbers of a page's equations, in their order."""
    return tuple(int(number) for number in re.findall(r"\\tag\{(\d+)\}", PAGES[page]))


def wrong_citations(text: str) -> list[str]:
    """Equations that a text cites and that no page has."""
    found = []
    for match in CITATION.finditer(re.sub(r"\s+", " ", text)):
        for number in re.findall(r"\d+", match["list"]):
            if int(number) not in tags(match["page"]):
                found.append(f"explanation/{match['page']}.md has no equation {number}")
    return found


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
    """Each module has a page of its name with the figure of each of its models, and the table of all names them."""
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
    """Words that a key of a deck may have."""
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
def generated() -> dict[str, str]:
    spec = importlib.util.spec_from_file_location("_generate", DOCS / "_generate.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.pages()


def test_the_reference_has_everything():
    pages = generated()
    assert [field.name for field in fields.FIELDS if f"`{field.name}`" not in pages["fields.md"]] == []
    assert [entry.key for entry in quantities.TABLE if f"`{entry.key}`" not in pages["fields.md"]] == []
    models = [*eos.MODELS, *strength.STRENGTH_MODELS, *strength.DAMAGE_MODELS, tensile_pressure.NAME]
    assert [name for name in models if f"### `{name}`" not in pages["models.md"]] == []
    assert [name for name in library.names() if f"## `{name}`" not in pages["materials.md"]] == []
    assert [key for key in deck.schema()["properties"] if key not in pages["deck.md"]] == []
    assert [entry.name for entry in edges.BOUNDARIES if f"| `{entry.name}` |" not in pages["deck.md"]] == []
    assert [name for name in catalogue.MODELS if f"## `{name}`" not in pages["penetration-models.md"]] == []
    assert "hydro2d run" in pages["commands.md"]
    assert "hydro2d model transition" in pages["commands.md"]


def test_every_key_of_a_deck_says_what_it_is():
    """A key without a description has a value list or a name that needs none."""
    plain = set("title name r z radius thickness shape r_max z_min z_max penetration qualifier".split())
    sections = [d for d in deck.schema()["$defs"].values() if "properties" in d]
    keys = [(key, part) for section in sections for key, part in section["properties"].items()]
    bare = {key for key, part in keys if "description" not in part and "$ref" not in part}
    assert bare - plain == set()


@pytest.mark.parametrize("file", WRITTEN, ids=name_of)
def test_links_lead_somewhere(file):
    made = {f"generated/{name}" for name in [*generated(), *(f"models/{name}.png" for name in catalogue.MODELS)]}
    lost = []
    for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", file.read_text(encoding="utf-8")):
        if "://" in target:
            continue
        path = (file.parent / target).resolve()
        if not path.exists() and not any(str(path).endswith(name) for name in made):
            lost.append(target)
    assert lost == []


@pytest.mark.parametrize("file", WRITTEN, ids=name_of)
def test_commands_in_the_text_exist(file):
    from hydro2d.cli import main

    text = file.read_text(encoding="utf-8")
    used = set(re.findall(r"(?:`|^|/|&& )hydro2d ([a-z]+)\b", text, re.M))
    assert used - set(main.app) == set()


PYTHON_IN_TEXT = [
    pytest.param(text, id=f"{file.stem}-{number}")
    for file in WRITTEN
    for number, text in enumerate(re.findall(r"```python\n(.*?)```", file.read_text(encoding="utf-8"), re.S))
]


@pytest.mark.parametrize("text", PYTHON_IN_TEXT)
def test_python_in_the_text_is_there(text):
    """Code of the pages parses, and what it takes from the package exists."""
    attributes = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Attribute)]
    used = {node.attr for node in attributes if getattr(node.value, "id", None) == "hydro2d"}
    assert [name for name in used if not hasattr(hydro2d, name)] == []


DECKS_IN_TEXT = [
    pytest.param(text, id=f"{file.stem}-{number}")
    for file in WRITTEN
    for number, text in enumerate(re.findall(r"```toml\n(.*?)```", file.read_text(encoding="utf-8"), re.S))
    if "[mesh]" in text
]


@pytest.mark.parametrize("text", DECKS_IN_TEXT)
def test_decks_in_the_text_load(text):
    assert deck.loads(text).body
