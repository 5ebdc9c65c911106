"""The page of all experiments shows the kept results."""

from problems import kept
from problems.validation import against_experiments as against
from problems.validation.against_experiments import Row
from tests.rules import source


def test_the_page_has_every_line_of_the_tables():
    lines = (source.ROOT / "docs/explanation/validation.md").read_text(encoding="utf-8").splitlines()
    printed = against.tables()
    assert len(printed) > 55
    assert [line for line in printed if line not in lines] == []


def test_sets_with_choices_are_separate():
    tables = "\n".join(against.tables()).split("\n\n")
    assert len(tables) == 3
    for each in against.SETS:
        assert (f"| {each.name} |" in tables[1]) == each.predicted
        assert (f"| {each.name} |" in tables[2]) != each.predicted
        assert each.predicted == each.chosen.startswith("nothing")


def test_every_set_has_shots_and_a_study_that_exists():
    for name, rows in against.rows().items():
        assert rows, name
    for each in against.SETS:
        assert (source.ROOT / each.command.split()[1]).is_file()


def test_a_row_has_the_median_the_spread_and_the_difference():
    assert str(Row("a", "b", 10.0, "cm", (9.0, 12.0, 10.5))) == "| a | b | 10.0 cm | 10.5 cm (9.0 to 12.0, 3 runs) | +5 % |"
    assert str(Row("a", "b", 10.0, "cm", (9.0,))) == "| a | b | 10.0 cm | 9.0 cm | -10 % |"
    assert str(Row("a", "b", None, "cm", (53.3,), "perforated in 1 of 1 runs")) == (
        "| a | b | perforated | perforated in 1 of 1 runs |  |")


def test_shots_that_were_run_once_are_those_of_the_folders():
    """Each value stands in the README beside the deck of its set."""
    commands = {each.name: each.command for each in against.SETS}
    rows = kept.rows(against.HERE / "single_runs.csv", ("set", "measured", "computed", "unit"))
    assert {row["set"] for row in rows} == set(against.SINGLE)
    for row in rows:
        page = (source.ROOT / commands[row["set"]].split()[1]).with_name("README.md").read_text(encoding="utf-8")
        assert row["measured"] in page
        assert f"{row['computed']} " in page
