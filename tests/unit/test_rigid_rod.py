"""The table and the figure of what ends a rigid rod."""

from types import SimpleNamespace

import pytest

from problems.cth_nose_shape import rigid_rod
from problems.cth_nose_shape.rigid_rod import Shot
from tests.unit.test_cli import DECK


def case(folder, values, depth, length, status="done", reason="speed of rod below 5 m/s"):
    folder.mkdir(exist_ok=True)
    (folder / "deck.toml").write_text(DECK)
    summary = {"penetration_depth_m": depth, "rod_length_m": length, "rod_initial_length_m": 0.1, "stop_reason": reason,
               "rod_residual_velocity_m_s": 123.4}  # fmt: skip
    return SimpleNamespace(values=values, status=status, summary=summary, directory=folder)


@pytest.fixture
def study(tmp_path, monkeypatch):
    cases = (
        case(tmp_path / "a", {"law": "A", "shot": "5083-1086"}, 0.4168, 0.0958),
        case(tmp_path / "b", {"law": "A", "shot": "ogive-7039-1291"}, 0.537, 0.0995, reason="perforation of plate"),
        case(tmp_path / "c", {"law": "B", "shot": "hemi 7039 1165"}, 0.156, 0.0384),
        case(tmp_path / "d", {"law": "B", "shot": "5083-1200"}, 0.1, 0.09, status="running"),
        case(tmp_path / "e", {"law": "B", "shot": "something else"}, 0.1, 0.09),
    )
    monkeypatch.setattr(rigid_rod.layout, "read", lambda directory: SimpleNamespace(cases=cases))
    return tmp_path


@pytest.mark.parametrize(("label", "shot"), [
    ("5083-1086", Shot("hemispherical", "5083", 1086.0)), ("hemi 7039 1165", Shot("hemispherical", "7039", 1165.0)),
    ("ogive-5083-923", Shot("ogival", "5083", 923.0)), ("6061-967", None), ("", None)])
def test_labels(label, shot):
    assert Shot.named(label) == shot


def test_all_twelve_shots_are_known():
    found = rigid_rod.experiments()
    assert len(found) == 12
    assert str(found[Shot("hemispherical", "5083", 1086.0)]) == "44.8 cm"
    assert str(found[Shot("ogival", "7039", 1291.0)]) == "perforated"
    assert str(found[Shot("hemispherical", "7039", 1165.0)]) == "11.4 cm (estimated)"


def test_the_table(study):
    assert rigid_rod.table(rigid_rod.runs([study])) == [
        "| shot | experiment | A | B |", "|---|---|---|---|",
        "| hemispherical, 5083, 1086 m/s | 44.8 cm | 41.7 cm, 4.2 % |  |",
        "| hemispherical, 7039, 1165 m/s | 11.4 cm (estimated) |  | 15.6 cm, 62 % |",
        "| ogival, 7039, 1291 m/s | perforated | perforated at 123 m/s, 0.5 % |  |",
    ]  # fmt: skip


def test_the_figure(study, capsys):
    assert rigid_rod.main([str(study), "--figure", str(study / "figure.png")]) == 0
    assert (study / "figure.png").read_bytes()[:4] == b"\x89PNG"
    panels = rigid_rod.draw(rigid_rod.runs([study])).axes
    lines = {line.get_label(): line for line in panels[0].lines}
    assert lines["A"].get_xdata() == pytest.approx([1086.0])
    assert lines["A"].get_ydata() == pytest.approx([41.68])
    assert max(lines["model forrestal"].get_ydata()) > max(lines["model tate"].get_ydata()) > 0.0


def test_nothing_to_show(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(rigid_rod.layout, "read", lambda directory: SimpleNamespace(cases=()))
    assert rigid_rod.main([str(tmp_path)]) == 2


def test_the_list_has_every_case_that_is_done(tmp_path, monkeypatch, capsys):
    summary = {"penetration_depth_m": 0.4168, "rod_length_m": 0.05, "rod_initial_length_m": 0.1, "regime": "eroding",
               "stop_reason": "speed of rod below 5 m/s", "wall_s": 150.0, "time_s": 3.2e-4}  # fmt: skip
    cases = (SimpleNamespace(name="A_5083-1086", status="done", summary=summary),
             SimpleNamespace(name="B_x", status="waiting", summary={}),
             SimpleNamespace(name="C_x", status="interrupted", summary=summary))  # fmt: skip
    monkeypatch.setattr(rigid_rod.layout, "read", lambda directory: SimpleNamespace(name="laws", cases=cases))
    assert rigid_rod.main([str(tmp_path), "--list"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "laws: 1 of 3 runs.", "",
        "| case | depth, loss of length | regime | time of flight, us | minutes |", "|---|---|---|---|---|",
        "| `A_5083-1086` | 41.7 cm, 50 % | eroding | 320 | 2.5 |",
    ]  # fmt: skip
