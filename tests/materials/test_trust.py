"""The code carried by a stranger's run is not executed by commands that only read the run."""

import json
import tomllib
from dataclasses import replace

import numpy as np
import pytest

import hydro2d
from hydro2d.cli.main import call
from hydro2d.deck import deck as decks
from hydro2d.files import toml
from hydro2d.materials.outside import ModelError
from hydro2d.output import snapshot, vtk
from hydro2d.study.ensemble import contents
from hydro2d.study.records import record, study_directory
from tests.materials.made_models import GAS, VOCE

SHOT = "problems/cth_nose_shape/hemi_5083_1086.toml"


@pytest.fixture
def mark(tmp_path):
    """The file that the planted code creates."""
    return tmp_path / "was run"


@pytest.fixture
def strange(finished, mark):
    """A run whose deck carries code that leaves a mark, and no dumps."""
    deck = tomllib.loads(decks.load(SHOT).to_toml())
    run = f"\nopen({str(mark)!r}, 'w').close()\n"
    material = deck["materials"]["W_alloy"]
    material["strength"] = {"model": "own-voce", "code": VOCE + run, "code_from": "my_model.py", "shear_modulus": 1.6e11,
                            "yield_stress": 1e9, "saturation": 0.0}
    text = toml.dumps(deck)
    (finished / "deck.toml").write_text(text)
    saved = snapshot.read(finished / "restart.h5")
    snapshot.write(finished / "restart.h5", replace(saved, deck=text))
    (finished / "restart.previous.h5").unlink(missing_ok=True)
    return finished


def test_commands_that_read_a_run_execute_none_of_its_code(strange, mark, tmp_path, capsys):
    run, picture = str(strange), str(tmp_path / "a.png")
    for command in (
        ["report", run, "--out", str(tmp_path / "report")],
        ["plot", run, "-o", picture],
        ["plot", run, "--kind", "history", "-o", picture],
        ["export", run, "-o", str(tmp_path / "export")],
        ["model", "transition", "--rod", "W_alloy", "--target", "Al5083", "--runs", run],
    ):
        assert call(command) == 0, capsys.readouterr().err
        assert not mark.exists(), command
    said = capsys.readouterr().out
    warning = "the code of the strength model own-voce (my_model.py), which the deck of the run carries, is not run"
    assert said.count(warning) == 1
    assert "--trust runs it" in said
    assert "1.09" in said or "1086" in said


def test_reading_a_run_in_python_executes_none_of_its_code(strange, mark):
    assert len(hydro2d.open_run(strange).fields.time) == len(hydro2d.open_run(strange).dumps)
    hydro2d.open_study(strange).table()
    stored = record.read(study_directory.load(strange).cases[0])
    assert stored.velocity == 1086.0
    assert stored.setup.rod == "W_alloy"
    assert stored.problems == []
    assert not mark.exists()


def test_a_summary_of_version_0_3_is_completed_without_running_its_code(strange, mark):
    """Its set-up and its outcome follow from the deck."""
    now = hydro2d.open_run(strange).summary
    written = json.loads((strange / "summary.json").read_text())
    later = ("setup", "cells_across", "outcome", "sha256")
    (strange / "summary.json").write_text(json.dumps({key: value for key, value in written.items() if key not in later}))
    old = hydro2d.open_run(strange).summary
    assert old.outcome.depth_m == now.outcome.depth_m
    assert old.setup == decks.loads((strange / "deck.toml").read_text(), trust=False).setup
    assert not mark.exists()
    assert hydro2d.runs(strange)["setup"].iloc[0] == old.setup
    assert not mark.exists()


def test_the_state_of_a_run_needs_trust(strange, mark, tmp_path, capsys):
    (strange / "series.pvd").unlink()
    assert call(["export", str(strange), "-o", str(tmp_path / "export")]) == 2
    assert not mark.exists()
    assert capsys.readouterr().err.endswith("is not run; --trust, in Python trust=True, runs it\n")
    assert call(["export", str(strange), "-o", str(tmp_path / "export"), "--trust"]) == 0
    assert mark.exists()


def test_python_asks_for_trust_as_well(strange, mark):
    for read in (lambda: hydro2d.open_run(strange).simulation(), lambda: hydro2d.open_run(strange).state()):
        with pytest.raises(ModelError, match="trust=True"):
            read()
    assert not mark.exists()
    assert hydro2d.open_run(strange, trust=True).simulation().cycle > 0
    assert mark.exists()


def test_a_report_with_trust_has_the_models(strange, mark, tmp_path, capsys):
    assert call(["report", str(strange), "--trust", "--out", str(tmp_path / "report")]) == 0
    assert mark.exists()
    assert "is not run" not in capsys.readouterr().out
    assert contents.collect(study_directory.load(strange)).notes == []  # this process has run it already


def test_a_deck_in_a_run_names_no_file(strange, mark, tmp_path):
    deck = tomllib.loads((strange / "deck.toml").read_text())
    (tmp_path / "evil.py").write_text(deck["materials"]["W_alloy"]["strength"].pop("code"))
    deck["materials"]["W_alloy"]["strength"] = {"file": str(tmp_path / "evil.py")}
    (strange / "deck.toml").write_text(toml.dumps(deck))
    stored = record.read(study_directory.load(strange).cases[0])
    assert "names a file of code" in stored.problems[0]
    assert not mark.exists()


def test_numbers_that_code_would_have_checked(strange):
    deck = tomllib.loads((strange / "deck.toml").read_text())
    gas = GAS.replace('"a test"', '"another test"')
    deck["materials"]["Al5083"]["eos"] = {"model": "gamma-two", "code": gas, "code_from": "gas.py"}
    with pytest.raises(decks.DeckError, match="gamma-two needs reference_density"):
        decks.loads(toml.dumps(deck), trust=False)
    deck["materials"]["Al5083"]["eos"]["reference_density"] = 1.2
    loaded = decks.loads(toml.dumps(deck), trust=False).materials["Al5083"]
    assert loaded.reference_density == 1.2
    assert loaded.as_deck()["eos"] == deck["materials"]["Al5083"]["eos"]
    deck["materials"]["Al5083"]["eos"]["reference_density"] = "1.2 kg"
    with pytest.raises(decks.DeckError):
        decks.loads(toml.dumps(deck), trust=False)


def test_variables_of_unknown_models_are_found_by_their_names(tmp_path):
    from hydro2d.output import datasets

    shape = (2, 3)
    fields = {"Volume Fraction for a": np.ones(shape), "Volume Fraction for b of a": np.zeros(shape),
              "Softness of a": np.full(shape, 2.0), "Back Pull rr of b of a [Pa]": np.full(shape, 3.0)}
    data = datasets.of_state(vtk.Dump(np.arange(4.0), np.arange(3.0), fields, 0.0))
    assert set(data) == {"volume_fraction", "softness", "back_pull_rr"}
    assert data.back_pull_rr.attrs["units"] == "Pa"
    np.testing.assert_array_equal(data.back_pull_rr.sel(body="b of a"), 3.0)
    assert np.isnan(data.back_pull_rr.sel(body="a")).all()
