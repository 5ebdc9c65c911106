"""The list contains every column of a history and every key of a summary, and no others."""

import re

import pytest

from hydro2d.deck import deck as decks
from hydro2d.measure import audit
from hydro2d.mesh.sinks import SINKS
from hydro2d.output import history
from hydro2d.output.directory import HISTORY
from hydro2d.running import columns, run
from tests.decks import contact, entry, mesh, plate, rod, table

DECK = (
    mesh(("6 mm", 12), ("-14 mm", "10 mm", 48))
    + rod("2 mm", "10 mm", tip="-0.1 mm", velocity="1000 m/s")
    + plate("8 mm")
    + contact("rod")
    + entry("tracer", name="tip", r=0.0, z="-1 mm")
    + entry("gauge", name="line", r="1 mm", z="1 mm", z_end="7 mm", points=3)
    + table("experiment", velocity="1000 m/s", penetration="1 cm", residual_velocity="0 m/s", source="none")
    + '[derived]\n"P/L" = "depth / length0"\n'
    + table("stop", cycles=5)
    + table("output", history_interval="1 ns", vtk_interval="1 us")
)
NAMES = {
    "BODY": "rod|plate", "TARGET": "plate", "STATION": "tracer_tip|gauge_line_[123]", "SINK": "|".join(SINKS),
    "DERIVED": "P/L", "TRANSFER": "|".join(audit.CONTACT_TRANSFERS),
}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    directory = tmp_path_factory.mktemp("columns") / "run"
    return run.run(decks.loads(DECK), directory, quiet=True), history.read(directory / HISTORY)


def unlisted(names, listed) -> tuple[set[str], set[str]]:
    """Names missing from the list, and entries of the list that match no name."""
    words = re.compile("|".join(NAMES))
    patterns = {name: re.compile(words.sub(lambda word: f"(?:{NAMES[word[0]]})", re.escape(name))) for name in listed}
    unknown = {name for name in names if not any(pattern.fullmatch(name) for pattern in patterns.values())}
    return unknown, {name for name, pattern in patterns.items() if not any(pattern.fullmatch(each) for each in names)}


def flat(table: dict, path: str = "") -> set[str]:
    """Dotted keys of a summary; the provenance counts as one."""
    keys = set()
    for key, value in table.items():
        keys |= flat(value, f"{path}{key}.") if isinstance(value, dict) and key != "provenance" else {f"{path}{key}"}
    return keys


def test_the_history(made):
    assert unlisted(made[1], columns.HISTORY) == (set(), set())


def test_the_summary(made):
    assert unlisted(flat(made[0].model_dump()), columns.SUMMARY) == (set(), set())


def test_all_have_meanings():
    assert all(meaning.strip() for meaning in (*columns.HISTORY.values(), *columns.SUMMARY.values()))
