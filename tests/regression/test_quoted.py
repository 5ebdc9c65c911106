"""The numbers that pages quote are those of the runs and results that they are of: docs/quoted.py."""

import re
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pandas
import pytest

import hydro2d
from hydro2d.cli.main import call
from hydro2d.materials import library
from tests.rules import source

DOCS = source.ROOT / "docs"
sys.path.insert(0, str(DOCS))
import quoted  # noqa: E402
from _pages import claims, materials  # noqa: E402

sys.path.remove(str(DOCS))

#: the two runs that cost least, and decks of which a page shows what `hydro2d check` prints
CHEAPEST, CHECKED = ("ball_tail", "two"), {"docs/tutorials/first-run.md": "problems/cth_nose_shape/hemi_5083_1086_quick.toml"}
#: a run of one sentence and of one block, made up
KNOWN = {"quick": {"values": {"quick.depth": 0.45123, "quick.cycles": 12840, "quick.regime": "rigid"},
                   "closing": ["done: at rest", "12840 cycles to 822.416 us", "penetration depth     45.12 cm",
                               "regime   rigid"]}}


def test_every_run_is_of_this_method_and_of_the_decks_of_today():
    """A change of the method or of a deck lands with `python docs/quoted.py --write`."""
    assert quoted.faults_of_runs(quoted.kept()) == {}


def test_every_page_has_the_numbers_of_its_runs_and_results():
    assert quoted.faults_of_pages(quoted.kept()) == []


@pytest.mark.parametrize("file", quoted.notebooks(), ids=lambda file: file.stem)
def test_a_notebook_is_of_this_method_and_of_the_decks_of_today(file):
    assert quoted.fault_of_notebook(quoted.read(file)) == ""


@pytest.mark.parametrize("page", CHECKED)
def test_what_check_prints_is_that_of_the_page(page, capsys):
    assert call(["check", CHECKED[page]]) == 0
    said = capsys.readouterr().out
    blocks = [match[2] for match in quoted.figures.FENCE.finditer(quoted.prose(source.ROOT / page))]
    shown = [block for block in blocks if "cylindrical;" in block]
    assert shown
    assert all(block in said for block in shown)


@pytest.mark.thorough
@pytest.mark.parametrize("name", CHEAPEST)
def test_a_run_has_the_numbers_that_are_kept(name, tmp_path, monkeypatch):
    monkeypatch.setattr(quoted, "RUNS", tmp_path)
    assert quoted.measured(name, again=True) == quoted.kept()[name]


@pytest.fixture
def one_run(monkeypatch):
    monkeypatch.setattr(quoted, "listed", lambda: {"runs": {"quick": "run quick.toml"}, "page": []})


@pytest.mark.parametrize(("text", "template", "new"), [
    ("It goes 46.3 cm\ndeep.", "goes {quick.depth * 100:.1f} cm deep", None),
    ("It goes 46.3 cm\ndeep.", "goes {quick.depth:.3f} cm deep", "It goes 0.451 cm\ndeep."),
    ("After 9 999 cycles the rod is eroded.", "After {quick.cycles:,.0f} cycles the rod is {quick.regime}.",
     "After 12 840 cycles the rod is rigid."),
    ("| a | 1 | 2 |", "| a | {quick.cycles:.0f} | {quick.depth:.1f} |", "| a | 12840 | 0.5 |"),
])
def test_a_sentence_gets_its_numbers(one_run, text, template, new):
    if new is None:
        with pytest.raises(KeyError, match="depth"):  # an expression that no run was asked for
            quoted.quoted(text, template, KNOWN)
    else:
        assert quoted.quoted(text, template, KNOWN) == new


@pytest.mark.parametrize(("text", "said"), [("It stops.", "no sentence"), ("goes 1 cm, goes 2 cm", "2 sentences")])
def test_a_page_has_a_sentence_once(one_run, text, said):
    with pytest.raises(ValueError, match=said):
        quoted.quoted(text, "goes {quick.depth:.1f} cm", KNOWN)


def test_a_quote_does_not_end_with_a_number(one_run):
    """Nothing would say where it ends."""
    with pytest.raises(ValueError, match="ends with a number"):
        quoted.quoted("goes 1 cm", "goes {quick.depth:.1f}", KNOWN)


BLOCK = "```\ndone: at rest\n9 cycles to 9.9 us in 27 s (391 ns per cell)\npenetration depth     46.30 cm\n```\n"


def test_a_block_gets_the_lines_of_its_run_and_keeps_the_times_of_the_machine(one_run):
    new, wrong = quoted.renewed(BLOCK, {"blocks": ["quick"]}, KNOWN)
    assert new == BLOCK.replace("9 cycles to 9.9", "12840 cycles to 822.416").replace("46.30", "45.12")
    assert wrong == []
    assert quoted.renewed(new, {"blocks": ["quick"]}, KNOWN)[0] == new


@pytest.mark.parametrize(("text", "runs", "said"), [
    (BLOCK, [], "has 1 block"), ("", ["quick"], "has 0 block"),
    ("```\nresidual ball         1279.2 m/s\n```\n", ["quick"], "no such line"),
])
def test_a_block_that_no_run_has_is_found(one_run, text, runs, said):
    assert said in " ".join(quoted.renewed(text, {"blocks": runs}, KNOWN)[1])


def test_a_block_of_a_page_that_is_not_listed_is_found(monkeypatch):
    """Of any page of the first hour."""
    monkeypatch.setattr(quoted, "prose", lambda file: BLOCK if file.name == "spall.md" else "")
    monkeypatch.setattr(quoted, "listed", lambda: {"runs": {}, "page": []})
    (fault,) = quoted.faults_of_pages({})
    assert fault.startswith("docs/how-to/spall.md: has 1 block(s) with closing lines of a run")


def test_what_makes_a_run_stale(monkeypatch):
    name, command = "ball", quoted.listed()["runs"]["ball"]
    monkeypatch.setattr(quoted, "listed", lambda: {"runs": {name: command}, "page": []})
    entry = {"command": command, "method": quoted.METHOD, "setups": quoted.setups(command), "values": {}}
    assert quoted.faults_of_runs({name: entry}) == {}
    assert "of the method" in quoted.faults_of_runs({})[name]
    assert "of the method 2026-01-01" in quoted.faults_of_runs({name: {**entry, "method": "2026-01-01"}})[name]
    assert "another deck" in quoted.faults_of_runs({name: {**entry, "setups": {"sphere.toml": "0"}}})[name]
    monkeypatch.setattr(quoted, "wanted", lambda run: ["ball.cycles"])
    assert "lacks a number" in quoted.faults_of_runs({name: entry})[name]


@pytest.mark.parametrize("spoil", [
    lambda notebook: notebook.metadata.pop("hydro2d"),
    lambda notebook: notebook.metadata["hydro2d"].update(method="2026-01-01"),
    lambda notebook: notebook.metadata["hydro2d"].update(setups={}),
    lambda notebook: notebook.cells[1].update(source='END = "4 us"'),
])
def test_what_makes_a_notebook_stale(spoil):
    notebook = quoted.read(quoted.notebooks()[1])
    assert quoted.fault_of_notebook(notebook) == ""
    spoil(notebook)
    assert quoted.fault_of_notebook(notebook)


def test_the_prose_of_a_notebook_is_read_and_written(tmp_path):
    file = tmp_path / "page.ipynb"
    file.write_text(quoted.notebooks()[0].read_text(encoding="utf-8"), encoding="utf-8")
    text = quoted.prose(file)
    quoted.save(file, text.replace("Taylor bar", "bar of Taylor"))
    assert quoted.prose(file) == text.replace("Taylor bar", "bar of Taylor")
    before, after = (quoted.read(each).cells for each in (quoted.notebooks()[0], file))
    assert [cell.get("outputs") for cell in before] == [cell.get("outputs") for cell in after]


def test_numbers_of_tables_of_runs():
    table = pandas.DataFrame({"velocity": ["1 m/s", "1 m/s", "2 m/s"], "scheme": ["a", "a", "b"], "depth_m": [0.5, 0.4, 0.1]},
                             index=pandas.MultiIndex.from_tuples([("x", 1), ("x", 0), ("y", 0)], names=["case", "member"]))
    assert claims.depths(table, "1 m/s", "a") == "40.0, 50.0"
    assert claims.depth(table, "2 m/s", "b") == pytest.approx(10.0)
    assert claims.depths(table, "1 m/s", "b") == ""
    assert claims.apart(claims.rows(table, "1 m/s")) == pytest.approx(100.0 * 0.1 / 0.45)


def test_a_file_of_a_page_has_the_others_of_the_page_beside_it():
    """bar.toml names my_model.py."""
    file = quoted.file_of("bar.toml")
    assert (file.name, (file.parent / "my_model.py").is_file()) == ("bar.toml", True)
    with pytest.raises(FileNotFoundError, match="no page has its reader save it"):
        quoted.file_of("nothing.toml")


def test_the_first_case_of_the_study_has_the_members_of_the_repeated_shot():
    """The tutorial quotes the repeats of the first shot for those of the first case of its study."""
    study = quoted.file_of("first_study.toml")
    repeated = study.with_name("repeated.toml")
    repeated.write_text(study.read_text(encoding="utf-8") + "\n[ensemble]\nrepeats = 4\n", encoding="utf-8")
    shot = {"deck": str(source.ROOT / quoted.arguments_of(quoted.listed()["runs"]["quick"]).file), "ensemble": {"repeats": 4}}
    plans = quoted.cases.plan(repeated, [], quiet=True), quoted.cases.plan_of(shot, "shot", [])
    first, alone = ([hydro2d.Deck.from_toml(case.text).setup for case in plan.cases[:4]] for plan in plans)
    assert len(set(first)) == 4
    assert first == alone


def test_the_mesh_and_the_predicted_end_of_a_run():
    """A body that slows by 1 m/s every microsecond is below 5 m/s after 95 of them."""
    time = np.linspace(0.0, 50e-6, 51)
    run = SimpleNamespace(dump=lambda: SimpleNamespace(z_edges=np.array([0.1, 0.2, 0.4])), stop={"speed_below": 5.0},
                          history={"time": time, "rod_core_velocity_m_s": 100.0 - 1e6 * time}, directory="run")
    assert claims.mesh_z(run) == (0.1, 0.4)
    assert claims.predicted_end(run, 40e-6) == pytest.approx(95e-6)


def test_velocities_left_of_the_conical_rod():
    assert [round(claims.cone(each)) for each in (260.0, 300.0)] == [91, 176]
    assert claims.cone_measured(300.0) == pytest.approx((300.0**2 - 249.0**2) ** 0.5)


def test_words_for_numbers():
    assert [claims.words(each) for each in ([10, 10], [5, 6, 5], [2, 5])] == ["ten", "five or six", "two to five"]


def test_the_shots_that_end_otherwise_lie_next_to_the_transition():
    """As the README says: of each nose and alloy they are the fastest rod that stayed rigid, or the slowest that eroded."""
    stayed = claims.members.rigid()
    for score, _ in claims.twelve().values():
        for shot in set(score.shots) - set(score.sure):
            alike = [other.velocity for other, rigid in stayed.items()
                     if (other.nose, other.alloy, rigid) == (shot.nose, shot.alloy, stayed[shot])]
            assert shot.velocity == (max if stayed[shot] else min)(alike)


def test_every_number_of_the_library_has_a_source():
    assert re.fullmatch(r"\d{3,}", str(claims.library_numbers()))
    assert 0 < claims.recalled() < claims.library_numbers()
    assert set(materials.counts()) <= set(library.CONFIDENCE)


def test_the_command_says_what_it_takes():
    done = subprocess.run([sys.executable, str(DOCS / "quoted.py"), "--help"], capture_output=True, text=True, check=True)
    assert "--write" in done.stdout
