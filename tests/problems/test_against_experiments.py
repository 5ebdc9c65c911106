"""The file and the page of all experiments have the kept results, with the comparison errors of ASME V&V 20."""

from dataclasses import replace

import pytest

import hydro2d
from problems import kept
from problems.validation import against_experiments as against
from problems.validation.against_experiments import Row
from tests.rules import source

#: a set whose source gives an error of 3 %, and one whose source gives none
STATED = against.Set("a", "a paper", "nothing", "run x.toml", error=0.03)
NOT_GIVEN = replace(STATED, error=None)


@pytest.fixture(scope="module")
def made():
    return against.records()


def test_the_file_and_the_page_are_those_of_the_kept_results(made):
    assert against.FILE.read_text(encoding="utf-8") == against.text(made), against.REMEDY
    page = against.PAGE.read_text(encoding="utf-8")
    assert kept.filled(page, against.tables(against.read(against.FILE, made))) == page, against.REMEDY
    assert len(made) > 100


def test_a_file_of_another_version_of_the_method_than_it_names_is_refused(made, tmp_path):
    """The whole file, a row that names another version than that of its runs, and a row without runs."""
    text, file, own = against.text(made), tmp_path / "validation.csv", made[0]["method"]

    def refusal(changed):
        assert changed != text
        file.write_text(changed, encoding="utf-8")
        with pytest.raises(hydro2d.StudyError) as problem:
            against.read(file, made)
        (line,) = str(problem.value).splitlines()
        assert line.endswith("; python -m problems.validation.against_experiments makes it anew")
        return line

    assert "validation.csv:1: has " in refusal(text.replace(hydro2d.METHOD, "2020-01-01", 1))
    assert (f"validation.csv: {made[0]['set']}, {made[0]['shot']}: names the method 2020-01-01, and its runs are of {own}"
            ) in refusal(text.replace(f",{own}\n", ",2020-01-01\n", 1))
    assert "and its runs are of none" in refusal(text.replace('"hemispherical, 5083, 1086 m/s"', "another shot", 1))


def test_sets_with_choices_are_separate(made):
    tables = against.tables(made)
    for each in against.SETS:
        assert any(f"| {each.name} |" in line for line in tables["predicted"]()) == each.predicted
        assert any(f"| {each.name} |" in line for line in tables["chosen"]()) != each.predicted
        assert each.predicted == each.chosen.startswith("nothing")
    assert all(row["source"] not in ("", against.SAME) for row in made)


def test_every_set_has_shots_and_a_study_that_exists():
    for name, rows in against.rows().items():
        assert rows, name
    for each in against.SETS:
        assert (source.ROOT / each.command.split()[1]).is_file()


def test_a_row_has_the_comparison_error_and_its_uncertainties():
    """E is 0.5, u_num 1.5, u_input 2 and u_D 0.3; of several runs the median counts."""
    row = Row("a", "b", 10.0, "cm", (9.0, 12.0, 10.5), around=((9.0, 12.0, 10.5), 2), sampled=((8.0, 10.0, 12.0), "2026-11-28"))
    record = row.record(STATED)
    numbers = {name: float(record[name]) for name in ("computed", "E", "u_num", "u_input", "u_D", "u_val")}
    assert numbers == pytest.approx({"computed": 10.5, "E": 0.5, "u_num": 1.5, "u_input": 2.0, "u_D": 0.3,
                                     "u_val": (1.5**2 + 2.0**2 + 0.3**2) ** 0.5}, rel=1e-5)
    assert against.line(record) == ("| a | b | 10.0 cm | 10.5 cm (9.0 to 12.0, 3 runs) | +0.5, +5 % | 1.5 (3 runs, 2 meshes) | "
                                    "2 (3 samples of 2026-11-28) | 0.3 (3 %, stated) | 2.5 | yes | unknown |")


def test_what_is_not_known_is_said():
    record = Row("a", "b", 10.0, "cm", (9.0,), method="2026-11-25").record(NOT_GIVEN)
    assert against.line(record) == ("| a | b | 10.0 cm | 9.0 cm | -1.0, -10 % | not known | not sampled | 0.5 (not given; 5 % "
                                    "assumed) | at least 0.5 | no | 2026-11-25 |")


@pytest.mark.parametrize(("computed", "error", "verdict"), [
    (10.99, None, "yes"), (11.01, None, "no"), (8.99, None, "no"), (10.5, 0.03, "yes"), (10.7, 0.03, "no"), (10.0, 0.0, "open"),
])
def test_an_error_is_within_twice_the_uncertainty_or_not(computed, error, verdict):
    assert Row("a", "b", 10.0, "cm", (computed,)).record(replace(STATED, error=error))["within"] == verdict


@pytest.mark.parametrize(("measured", "ended", "said", "verdict"), [
    (None, "perforated", "perforated in 1 of 1 runs", "ended alike"), (None, "stopped", "stopped", "ended alike"),
    (10.0, "", "perforated in 1 of 1 runs", "ended otherwise"), (None, "perforated", "", "ended otherwise"),
    (97.0, "", "stopped", "ended otherwise"),
])
def test_shots_without_a_value_end_alike_or_otherwise(measured, ended, said, verdict):
    record = Row("a", "b", measured, "cm", (53.3,), said, ended=ended).record(STATED)
    assert (record["within"], record["E"], record["u_val"]) == (verdict, "", "")
    assert record["computed"] == ("" if said else "53.3"), "the thickness of the plate is no depth"
    assert f"| {verdict} |" in against.line(record)


def test_failures_are_in_the_file(made):
    verdicts = {row["within"] for row in made}
    assert {against.NO, against.OTHERWISE} < verdicts <= set(against.VERDICTS)


def test_meshes_of_a_shot_are_of_the_method_of_its_value(made):
    (row,) = (row for row in made if (row["set"], row["shot"]) == ("tungsten into aluminium", "hemispherical, 5083, 1086 m/s"))
    runs = hydro2d.runs(source.PROBLEMS / "cth_nose_shape/results/convergence.csv")
    own = runs[(runs["shot"] == "5083-1086") & (runs["method"] == row["method"])]
    assert len(own) > 4
    assert float(row["u_num"]) == pytest.approx(100.0 * own["depth_m"].std(), rel=1e-5)
    assert row["u_num_from"].startswith(f"{len(own)} runs, {own['cells_across'].nunique()} mesh")


def test_a_check_writes_nothing(monkeypatch, tmp_path, made):
    page, file = tmp_path / "page.md", tmp_path / "validation.csv"
    page.write_text("<!-- verdicts -->\nold\n<!-- end -->\n")
    monkeypatch.setattr(against, "PAGE", page)
    monkeypatch.setattr(against, "FILE", file)
    monkeypatch.setattr(against, "records", lambda: made)
    assert against.main(["--check"]) == 1
    assert not file.exists()
    assert "old" in page.read_text()
    assert against.main([]) == 0
    assert "| predicted: " in page.read_text()
    assert against.main(["--check"]) == 0


def test_shots_that_were_run_once_are_those_of_the_folders():
    """Each value stands in the README beside the deck of its set."""
    commands = {each.name: each.command for each in against.SETS}
    rows = kept.rows(against.HERE / "single_runs.csv", ("set", "measured", "computed", "unit"))
    assert {row["set"] for row in rows} == set(against.SINGLE)
    for row in rows:
        page = (source.ROOT / commands[row["set"]].split()[1]).with_name("README.md").read_text(encoding="utf-8")
        assert row["measured"] in page
        assert f"{row['computed']} " in page
