"""The classic shots: the kept results, the table of their page, and the defaults that follow from it."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from hydro2d.deck.sections import Numerics, Sliding
from hydro2d.measure.audit import CLIPS, REMEDIES
from hydro2d.measure.summary import Summary
from hydro2d.study.plan import cases
from problems.classic import table
from tests.rules import source

FOLDER = source.PROBLEMS / "classic"
KEPT = {name: table.read(FOLDER / "results" / f"{name}.csv") for name in ("methods", "methods_fine")}


def of(shot, sliding, advection):
    return next(result for result in KEPT["methods"] if (result.shot, result.sliding, result.advection) ==
                (shot, sliding, advection))


@pytest.mark.parametrize("name", KEPT)
def test_every_case_of_the_study_is_kept(name):
    planned = [(case.values["shot"], case.values.get("sliding", "none"), case.values["advection"])
               for case in cases.plan(FOLDER / f"{name}.toml", quiet=True).cases]
    assert [(result.shot, result.sliding, result.advection) for result in KEPT[name]] == planned


@pytest.mark.parametrize("name", KEPT)
def test_the_table_of_the_page_is_that_of_the_kept_results(name):
    page = (FOLDER / "README.md").read_text(encoding="utf-8").splitlines()
    rows = table.table(KEPT[name])
    assert len(rows) > 7
    assert [row for row in rows if row not in page] == []


def test_the_shots_are_the_decks_of_the_folder():
    decks, _ = source.problems()
    assert {file.stem for file in decks if file.parent == FOLDER} == set(table.MEASURES) == {
        result.shot for result in KEPT["methods"]}


def test_the_defaults_carry_every_shot():
    """`ke` does not, and `momentum` discards too much energy."""
    carried = {choice: {result.status for result in KEPT["methods"]
                        if result.advection == choice and result.sliding == Sliding().method} == {"trusted"}
               for choice in table.ADVECTION}
    assert Numerics().advection == "both"
    assert carried == {"ke": False, "momentum": False, "both": True}


@pytest.mark.xfail(reason="wanted: below 10 m/s, as until 2026-11-27; got: 10.5, as it still rings about the 7.4 m/s of the "
                          "tube", strict=True, raises=AssertionError)
def test_the_block_sticks_in_its_hole():
    assert of("block_in_hole", Sliding().method, Numerics().advection).value < 10.0


def test_the_remedies_are_those_that_the_table_bears_out():
    """Each clip of the table has a remedy, no other clip has one, and the remedied shots are trusted."""
    failed = [result for result in ended_early() if result.advection == "ke"]
    assert {result.fault for result in failed} == set(REMEDIES) <= set(CLIPS)
    assert len(failed) == 6, "the page says how many"
    discards = [result for result in ended_early() if result not in failed]
    assert [(result.shot, result.sliding, result.advection, result.fault) for result in discards] == [
        (shot, "slip-layer", "momentum", "energy discarded") for shot in ("crater", "block_in_hole")], "the page says so"
    for result in failed:
        assert f'"{Numerics().advection}"' in REMEDIES[result.fault]
        if result.sliding == Sliding().method:
            assert of(result.shot, result.sliding, Numerics().advection).status == "trusted"


def ended_early():
    return [result for result in KEPT["methods"] if result.status == "unphysical"]


def test_statements_of_the_page():
    """`both` is always trusted, `momentum` often not, and sliding changes most numbers little."""
    assert {result.status for results in KEPT.values() for result in results if result.advection == "both"} == {"trusted"}
    momentum = [result for result in KEPT["methods"] if result.advection == "momentum"]
    assert (len(momentum), sum(result.status == "not trusted" for result in momentum)) == (28, 18)
    assert {result.fault for result in momentum if result.status == "not trusted"} == {"energy discarded"}
    for result in momentum:
        if result.sliding == "none":
            assert result.value == pytest.approx(of(result.shot, "none", "both").value, rel=0.02)
    for result in KEPT["methods"]:
        tied = of(result.shot, "none", result.advection)
        if result.shot not in ("block_in_hole", "flyer_spall", "plate_on_wall") and None not in (result.value, tied.value):
            assert result.value == pytest.approx(tied.value, rel=0.08)
    assert {result.method for results in KEPT.values() for result in results} == {"2026-11-29.4"}


def case(directory, shot, advection, status="done", clipped=0.0, fault="", **summary):
    directory.mkdir()
    (directory / "deck.toml").write_text('title = "a shot"\n')
    sinks = {"advection": {"energy_J": -0.04}, "ke_bound": {"energy_J": clipped}}
    data = {"conservation": {"sinks": sinks, "start_energy_J": 40.0}, "trustworthy": not fault,
            "faults": [fault] if fault else [], "time_s": 9.004e-6, "cycles": 12, "status": status, **summary}
    (directory / "summary.json").write_text(json.dumps(data))
    return SimpleNamespace(values={"shot": shot, "sliding": "none", "advection": advection}, status=status,
                           summary=Summary(**data), directory=directory)


@pytest.fixture
def study(tmp_path, monkeypatch):
    bodies = {"block": {"velocity_m_s": 151.26}}
    records = [
        case(tmp_path / "a", "block_in_hole", "both", bodies=bodies),
        case(tmp_path / "b", "block_in_hole", "ke", bodies=bodies, clipped=1.2, fault="cutoff has removed 3 % of it (k)"),
        case(tmp_path / "c", "crater", "ke", "unphysical", 0.9, "ke_bound has removed 2.2 % of it (k; limit 2 %); a remedy"),
        case(tmp_path / "d", "crater", "both", "running"),
    ]
    monkeypatch.setattr(table.hydro2d, "open_study", lambda directory: SimpleNamespace(cases=records))
    return tmp_path


def test_a_study_is_read_and_kept(study, capsys):
    file = study / "kept.csv"
    assert table.main([str(study), "--keep", str(file)]) == 0
    output = capsys.readouterr().out
    assert output.splitlines()[2:] == [
        "| block_in_hole | velocity of the block, m/s | 200 | none | 151.3, 2.9 %, **not trusted: cutoff** |  | 151.3, 0.1 % |",
        "| crater | depth of the crater, mm | 13 or a little more | none | **unphysical after 9.0 us: ke_bound** |  |  |",
    ]
    assert table.main([str(file)]) == 0
    assert capsys.readouterr().out == output


def test_nothing_to_read(tmp_path, capsys):
    assert table.main([str(tmp_path)]) == 2
    assert table.main([str(FOLDER.parent / "validation" / "results" / "eroding_rods.csv")]) == 2
    assert "no file of results: it has no column advection, " in capsys.readouterr().err


def test_the_pull_back_is_from_the_peak_to_the_least_velocity_after_it():
    time = np.linspace(0.0, 4e-6, 401)
    velocity = np.interp(time, [0.0, 1e-6, 1.5e-6, 2.1e-6, 4e-6], [0.0, 490.0, 330.0, 400.0, 100.0])
    run = SimpleNamespace(history={"time": time, "tracer_rear_velocity_z_m_s": velocity})
    assert table.MEASURES["flyer_spall"].of(run) == pytest.approx(160.0)
