"""The table and the figure of the perforations of Weldox 460 E."""

from pathlib import Path
from types import SimpleNamespace

import pytest

from hydro2d import Deck, Summary
from hydro2d.penetration import lambert_jonas
from hydro2d.study.plan import cases
from problems.perforation import residual

SHOTS = Path(residual.__file__).with_name("weldox_velocities.toml")


def case(nose, velocity, left, status="done"):
    crater = {"ejected_mass_kg": 0.03, "ejected_velocity_m_s": 200.0, "exit_diameter_m": 0.021}
    summary = {"outcome": {"perforated": left > 0.0, "residual_velocity_m_s": left}, "crater": crater}
    return SimpleNamespace(values={"nose": nose, "velocity": f"{velocity} m/s"}, status=status, summary=Summary(**summary))


@pytest.fixture
def study(tmp_path, monkeypatch):
    """Runs on a known curve, one that is stopped and one that is not done."""
    speeds = (303.5, 285.4, 244.2, 224.7)
    left = [lambert_jonas.residual_velocity(v, limit_velocity=190.0, a=0.8, p=2.2) for v in speeds]
    records = [case("blunt", *pair) for pair in zip(speeds, left, strict=True)]
    records += [case("blunt", 177.3, 0.0), case("hemispherical", 452.0, 320.0), case("blunt", 200.4, 50.0, status="running")]
    monkeypatch.setattr(residual.hydro2d, "open_study", lambda directory: SimpleNamespace(cases=records))
    return tmp_path


def test_the_table(study, capsys):
    assert residual.main([str(study), "--figure", str(study / "figure.png")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "| blunt | 177.3 | 0.0 | 0.0 | +0 m/s |  |  |" in lines
    assert "| hemispherical | 452 | 325.1 | 320.0 | -5 m/s | 30 g at 200 m/s | 21.0 mm |" in lines
    assert not any("| 200.4 |" in line for line in lines)
    (blunt,) = (line for line in lines if line.startswith("Ballistic limit, blunt"))
    assert "190.0 m/s (a = 0.80, p = 2.20) by the runs" in blunt
    (round_nose,) = (line for line in lines if line.startswith("Ballistic limit, hemispherical"))
    assert "needs perforations at 3 or more velocities by the runs" in round_nose
    assert (study / "figure.png").read_bytes()[:4] == b"\x89PNG"


def test_the_shots_have_the_published_limits():
    """Borvik and others fitted 184.5 m/s with a blunt nose and 292.1 m/s with a hemispherical one."""
    for nose, published in (("blunt", 184.5), ("hemispherical", 292.1)):
        pairs = [(striking, left) for (name, striking), left in residual.experiments().items() if name == nose]
        assert lambert_jonas.fit(*zip(*pairs, strict=True)).limit_velocity == pytest.approx(published, rel=0.02)


def test_a_folder_that_is_no_study(tmp_path, capsys):
    assert residual.main([str(tmp_path / "nothing")]) == 2
    assert "nothing" in capsys.readouterr().err


def test_the_decks_have_the_residual_velocities_of_the_table():
    plan = cases.plan(SHOTS, quiet=True)
    decks = [Deck.from_toml(case.text) for case in plan.cases]
    measured = {(deck.body[0].nose, deck.experiment.velocity): deck.experiment.residual_velocity for deck in decks}
    nose = {"flat": "blunt"}
    assert {(nose.get(shape, shape), velocity): left for (shape, velocity), left in measured.items()} == residual.experiments()
    for name in ("blunt", "hemispherical"):
        shot = Deck.from_file(SHOTS.with_name(f"weldox_{name}.toml"))
        assert shot.experiment.residual_velocity == residual.experiments()[name, shot.body[0].velocity[1]]
