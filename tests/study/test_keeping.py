"""Rows that a study keeps: which runs are up to date or stale, and the note on a table that mixes versions."""

import csv
import multiprocessing
from dataclasses import replace

import pytest

from hydro2d.deck import deck as decks
from hydro2d.deck import identity
from hydro2d.files.whole import write_json
from hydro2d.study.plan import cases
from hydro2d.study.plan.definition import Part, StudyError
from hydro2d.study.plan.scaling import AS_IT_IS, Size
from hydro2d.study.records import keeping, study_directory
from hydro2d.study.run.choice import Choice
from hydro2d.study.search import transition
from hydro2d.study.study_parts import Chosen
from tests.study import fake, tubes


@pytest.fixture
def study(tmp_path):
    """The plan of a study of two velocities, each with two members, whose runs nobody made."""
    return plan(tmp_path)


def plan(folder, more="", size=AS_IT_IS):
    file = folder / "velocities.toml"
    file.write_text(f"""deck = "{(tubes.ROOT / fake.BASE).as_posix()}"
keep = "rows.csv"
{more}
[ensemble]
repeats = 2
[[axis]]
name = "speed"
key = "body.rod.velocity"
values = ["1086 m/s", "1200 m/s"]
""")
    return cases.plan(file, quiet=True, size=size)


def ended(plan, folder, **summary):
    """The cases of a plan with runs in a folder, as a sweep reads them."""
    for case in plan.cases:
        fake.write_run(folder / "cases" / case.name, text=case.text, **summary)
    study_directory.make(folder)
    study_directory.write(plan, folder)
    return study_directory.read(folder).cases


def rows(plan):
    with open(plan.keep, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("name", ["method", "status", "member", "cells_across"])
def test_an_axis_has_no_name_of_a_column(name, tmp_path):
    study = plan(tmp_path)
    renamed = replace(study, axes=[axis | {"name": name} for axis in study.axes])
    with pytest.raises(StudyError, match=f'has a column "{name}" of its own; give that axis another name'):
        keeping.Keeper(renamed)


def test_rows_of_runs_that_ended(study, tmp_path):
    choice = Choice(study)
    assert len(choice.selected) == 4
    assert not choice.complete
    choice.keep(ended(study, tmp_path / "out"))
    kept = rows(study)
    assert [(row["speed"], row["member"]) for row in kept] == [
        ("1086 m/s", "0"), ("1086 m/s", "1"), ("1200 m/s", "0"), ("1200 m/s", "1")]
    assert {row["cells_across"] for row in kept} == {"5.5"}
    assert {row["method"] for row in kept} == {keeping.METHOD}
    assert len({row["setup"] for row in kept}) == 4
    assert float(kept[0]["depth_m"]) == 0.31
    assert float(kept[0]["length_ratio"]) == pytest.approx(0.98)
    again = Choice(study)
    assert again.complete
    assert again.kept().endswith("4 runs up to date, 0 stale, 0 not made")
    assert not Choice(study, again=True).complete


def test_a_running_case_has_no_row(study, tmp_path):
    cases_of = ended(study, tmp_path / "out")
    Choice(study).keep([replace(cases_of[0], status="interrupted"), *cases_of[1:]])
    assert len(rows(study)) == 3


def test_another_deck_or_method_makes_rows_stale(study, tmp_path):
    Choice(study).keep(ended(study, tmp_path / "out"))
    changed = plan(tmp_path, '[set]\n"sliding.friction" = 0.01\n')
    assert Choice(changed).kept().endswith("0 runs up to date, 4 stale, 0 not made")
    titled = plan(tmp_path, '[set]\ntitle = "another"\n"output.vtk_interval" = "1 ms"\n')
    assert Choice(titled).kept().endswith("4 runs up to date, 0 stale, 0 not made"), "neither changes a result"
    text = study.keep.read_text().replace(keeping.METHOD, "2020-01-01")
    study.keep.write_text(text)
    assert Choice(study).kept().endswith("0 runs up to date, 4 stale, 0 not made")
    choice = Choice(study)
    choice.keep(study_directory.read(tmp_path / "out").cases)
    assert len(rows(study)) == 4, "new rows take the places of stale ones"
    assert Choice(study).complete


def test_runs_of_another_method_are_not_kept(study, tmp_path):
    Choice(study).keep(ended(study, tmp_path / "out", method="2020-01-01"))
    assert not study.keep.exists()


def test_members_and_cells_of_another_size(study, tmp_path):
    Choice(study).keep(ended(study, tmp_path / "out"))
    one = plan(tmp_path, size=Size(members=1))
    assert [case.member for case in one.cases] == [0, 0]
    assert Choice(one).complete
    fine = plan(tmp_path, size=Size(cells=8.5))
    choice = Choice(fine)
    assert choice.kept().endswith("0 runs up to date, 0 stale, 4 not made")
    choice.keep(ended(fine, tmp_path / "fine"))
    assert [row["cells_across"] for row in rows(study)] == ["5.5"] * 4 + ["8.5"] * 4
    assert Choice(study).complete
    assert Choice(fine).complete


def test_a_default_does_not_count_in_a_setup():
    plain = decks.load(fake.BASE)
    assert identity.setup(plain) == identity.setup(decks.load(fake.BASE, [f"numerics.courant={plain.numerics.courant}"]))
    assert identity.setup(plain) != identity.setup(decks.load(fake.BASE, ["numerics.courant=0.4"]))
    alloy = ["body.rod.material=alloy", "materials.alloy.based_on=W_alloy"]
    stronger = [*alloy, "materials.alloy.strength.yield_stress=1.9 GPa"]
    titled = [*alloy, "materials.alloy.title=another"]
    first, second, third = (identity.setup(decks.load(fake.BASE, each)) for each in (alloy, stronger, titled))
    assert first == third != second


def test_a_parameter_that_is_later_than_kept_rows_does_not_count_until_it_is_used():
    """The hash of a shot as it was before mie-grueneisen had S2 and S3."""
    shot = "problems/cth_nose_shape/hemi_5083_1086.toml"
    even = ["mesh.reach=none", "mesh.cells_across=none", "mesh.fine=none", "mesh.z_start=-105.326584 mm",
            'mesh.z=[{to=0.0, cells=265}, {cells=57, across="rod", cells_across=8.5}, {to="101.352 mm", ratio=1.12}]']
    assert identity.setup(decks.load(shot, even)) == "f2195a01cbe5"
    curved = ["materials.alloy.based_on=W_alloy", "body.rod.material=alloy", "materials.alloy.eos.hugoniot_slope_2=0.1"]
    straight = [*curved[:2], "materials.alloy.eos.hugoniot_slope_2=0"]
    assert identity.setup(decks.load(shot, curved)) != identity.setup(decks.load(shot, straight))
    assert identity.setup(decks.load(shot, straight)) == identity.setup(decks.load(shot, curved[:2]))


def test_a_file_of_something_else_is_refused(study):
    study.keep.write_text("a,b\n1,2\n")
    with pytest.raises(StudyError, match=r'rows\.csv:1: has no column "cells_across"; correct it, or'):
        Choice(study)


def test_rows_of_another_study_are_refused(study, tmp_path):
    Choice(study).keep(ended(study, tmp_path / "out"))
    study.keep.write_text(study.keep.read_text().replace("speed,", "velocity,", 1))
    with pytest.raises(StudyError, match=r'rows\.csv:1: has no column "speed"'):
        Choice(study)


def test_a_search_with_all_its_rows_is_complete(tmp_path):
    """Four shots of each of two alloys; a larger budget needs more of them, and --overwrite all of them again."""
    file = tmp_path / "search.toml"

    def search(budget):
        file.write_text(f"""deck = "{(tubes.ROOT / fake.BASE).as_posix()}"
keep = "rows.csv"
[transition]
from = "1000 m/s"
to = "1300 m/s"
of = "length"
budget = {budget}
[[axis]]
name = "plate"
key = "body.plate.material"
values = ["Al5083", "Al7039"]
""")
        return cases.plan(file, quiet=True)

    choice = transition.choice_of(search(4))
    assert not choice.complete
    assert choice.kept().endswith("0 of 8 runs up to date")
    for group in choice.groups:
        for speed in (1000.0, 1300.0, 1150.0, 1100.0):
            choice._add(group, speed)
    choice.keep(ended(choice._planned(), tmp_path / "out"))
    again = transition.choice_of(search(4))
    assert again.complete
    assert again.kept().endswith("8 of 8 runs up to date")
    assert not transition.choice_of(search(4), again=True).complete
    part = Part(study="search.toml")
    assert [Chosen(part, "search", search(4), again).states for again in (False, True)] == [(8, 8, 0), (8, 0, 0)]
    assert not transition.choice_of(search(5)).complete
    file.with_name("rows.csv").write_text(choice.plan.keep.read_text().replace(keeping.METHOD, "2020-01-01"))
    assert not transition.choice_of(search(4)).complete


def _keep_alone(study, mine, start):
    """Keeps the rows of runs one after another, each at the moment at which another process does."""
    for case in mine:
        keeper = keeping.Keeper(study)
        start.wait(60)
        keeper.add([case])


def test_two_processes_that_keep_into_one_file_lose_no_row(tmp_path):
    """16 rows, 8 by each, two at a time."""
    study = plan(tmp_path, size=Size(members=8))
    runs, context = ended(study, tmp_path / "out"), multiprocessing.get_context("fork")
    start = context.Barrier(2)
    processes = [context.Process(target=_keep_alone, args=(study, runs[half::2], start)) for half in (0, 1)]
    for process in processes:
        process.start()
    for process in processes:
        process.join(60)
    assert [process.exitcode for process in processes] == [0, 0]
    assert len(rows(study)) == 16
    assert Choice(study).complete
    assert [file.name for file in tmp_path.glob(".*")] == [], "no lock is left"


def test_a_file_that_is_damaged_under_way_stays_as_it_is(study, tmp_path):
    """The rows that could not be written follow with the next ones."""
    first, *others = ended(study, tmp_path / "out")
    choice = Choice(study)
    choice.keep([first])
    text = study.keep.read_text()
    study.keep.write_text(f"<<<<<<< HEAD\n{text}")
    with pytest.raises(StudyError, match=r"rows\.csv:1: has a mark of git"):
        choice.keep(others[:2])
    assert study.keep.read_text() == f"<<<<<<< HEAD\n{text}"
    study.keep.write_text(text)
    choice.keep(others[2:])
    assert len(rows(study)) == 4


def test_a_row_with_a_renamed_label_gets_that_of_the_study(study, tmp_path):
    Choice(study).keep(ended(study, tmp_path / "out"))
    text = study.keep.read_text()
    study.keep.write_text(text.replace("1086 m/s", "1.086 km/s", 1))
    (said,) = Choice(study).keep([])
    assert said.endswith('rows.csv:2: column "speed": "1.086 km/s" is corrected: its set-up has "1086 m/s"')
    assert study.keep.read_text() == text


def test_a_table_says_that_it_mixes_versions():
    assert keeping.method_note([keeping.METHOD]) == ""
    assert keeping.method_note([keeping.METHOD, "2020-01-01", ""]).endswith(": 1 of 2020-01-01, 1 of unknown.")


def test_a_label_that_a_spreadsheet_would_compute(tmp_path):
    assert [keeping.safe(text) for text in ("=1+1", "-180 m/s", "-1.5", "a")] == ["'=1+1", "'-180 m/s", "-1.5", "a"]


@pytest.mark.thorough
def test_an_older_run_in_a_directory_is_not_used(tmp_path):
    """Only the version of the method is changed in a finished run of this deck."""
    file, out = tubes.write(tmp_path), tmp_path / "out"
    command = [file, "--out", out, "--workers", 1, "--only", "ke_0.1"]
    status, said = tubes.sweep(*command)
    assert status == 0, said
    place = out / "cases" / "ke_0.1" / "summary.json"
    summary = study_directory.read(out).cases[0].summary
    assert summary["method"] == keeping.METHOD
    place.unlink()
    write_json(place, summary.model_dump() | {"method": "2020-01-01"})
    status, said = tubes.sweep(*command, "--resume")
    assert status == 2
    assert "ran with another version of the method" in said
    status, said = tubes.sweep(*command, "--resume", "--overwrite")
    assert status == 0, said
    assert study_directory.read(out).cases[0].summary["method"] == keeping.METHOD
