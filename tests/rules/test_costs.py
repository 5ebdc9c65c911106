"""The table of CONTRIBUTING of what an addition costs: the files of an example are those that its row names."""

import re

import pytest

from tests.rules import source

#: how code names the example of a row: its module, its class or its word in decks
NAMED = {
    "kinematic_hardening": r"kinematic[-_]hardening",
    "p_alpha": r"p[-_]alpha",
    "hourglass": r"^    hourglass: |\.hourglass\b|\bhourglass=|['\"]hourglass['\"]",
    "radius_at_z_max_m": r"radius_at_z_max_m",
    "piston": r"\bpiston|Piston",
    "heating": r"sources\.heating|class Heating\(Source",
    "sphere": r"shapes\.sphere|\bSphere\b",
    "flat_rounded": r"flat[-_]rounded|FlatRounded",
    "walker_anderson_finite": r"walker[-_]anderson[-_]finite",
    "perforation": r"outcomes\.perforation import Perforation|\bPerforation[,(]",
    "fit_strength": r"cli\.fit_strength|^def fit_strength",
}


def rows() -> dict[str, tuple[str, set[str]]]:
    """Addition and files by the example of each row, and the additions without one under their own names."""
    text = (source.ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").split("## What an addition costs")[1]
    table = {}
    for line in text.split("\n## ")[0].splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 4 and cells[0] not in ("addition", "---"):
            example = cells[3].strip("`")
            files = re.findall(r"`([\w/]+\.py)`", f"{cells[1]} {cells[2]}")
            table[example or cells[0]] = cells[0], {file.replace("NAME", example) for file in files}
    return table


@pytest.mark.parametrize("example", NAMED)
def test_an_addition_touches_the_files_of_its_row(example):
    addition, files = rows()[example]
    pattern = re.compile(NAMED[example], re.MULTILINE)
    files_with_it = {file.relative_to(source.ROOT).as_posix() for name, file in source.modules().items()
                     if pattern.search(file.read_text(encoding="utf-8"))}
    assert files_with_it == files, f"CONTRIBUTING.md: {addition}"


def test_the_counts_are_those_of_the_code():
    """Every file is counted once, and the places of an example are in the files of its row."""
    from tests.rules import counts  # which imports this file

    said = list(counts.lines())
    files = [file for file in source.tracked_files() if file.suffix == ".py"]
    total = sum(int(line.split()[0]) for line in said if re.fullmatch(r" +\d+ [\w.]+/", line))
    assert total == sum(file.read_text(encoding="utf-8").count("\n") for file in files)
    for example, what in (("radius_at_z_max_m", "result"), ("hourglass", "number of the method")):
        assert {place.split(":")[0] for place in counts.places(counts.EXAMPLES[what])} == rows()[example][1]
    assert "hydro2d.study.records.keeping.Row" in counts.forms_of_a_row()


def test_every_file_of_the_table_exists():
    named = {file for _, files in rows().values() for file in files}
    assert [file for file in sorted(named) if not (source.ROOT / file).is_file()] == []
    assert set(NAMED) == {example for example, (addition, _) in rows().items() if example != addition}
