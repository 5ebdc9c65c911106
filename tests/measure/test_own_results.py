"""Results of one's own in a file: where the values appear, and the one line of every mistake, with file, line and remedy."""

import csv
from pathlib import Path

import pytest

import hydro2d
from hydro2d.base.errors import DeckError
from hydro2d.cli.main import call
from hydro2d.deck import deck as decks
from hydro2d.measure.own_results import wrong_ending
from hydro2d.measure.result import UNITS
from hydro2d.measure.summary import Outcome, Summary
from hydro2d.running.run import run
from hydro2d.solver.recorder import ColumnError
from tests.running.test_derived import DECK

RIM = '''"""The lip around a crater."""

from hydro2d.measure.result import Number, Result, result


class Rim(Result):
    """The lip around a crater."""

    lip_m: Number = result("height of the lip above the face of the plate")
    cycles_so_far: Number = result("number of cycles")


def measure(sim):
    lip = sim.deck.penetration.surface - sim.of_bodies()["back plate"].z_min_m
    return Rim(lip_m=lip, cycles_so_far=sim.cycle)
'''
NAMED = DECK + 'twice_m = "2 * lip_m"\n[result.rim]\nfile = "rim.py"\n'
#: the line of "file" in it
LINE = NAMED.splitlines().index('file = "rim.py"') + 1


@pytest.fixture
def shot(tmp_path, monkeypatch):
    """A function that writes the deck and its file of results, some words replaced; the folder is the current one."""
    monkeypatch.chdir(tmp_path)

    def write(*replaced: tuple[str, str], deck: str = NAMED) -> str:
        text = RIM
        for old, new in replaced:
            assert text.count(old) == 1
            text = text.replace(old, new)
        (tmp_path / "rim.py").write_text(text)
        (tmp_path / "shot.toml").write_text(deck)
        return "shot.toml"

    return write


def test_the_values_are_wherever_results_are(shot, capsys):
    name = shot()
    result = hydro2d.run(name, "out", quiet=True)
    body, derived = result.summary["bodies"]["back plate"], result.summary["derived"]
    assert derived["lip_m"] == -body["z_min_m"] > 0.0
    assert derived["cycles_so_far"] == 40.0
    assert derived["twice_m"] == 2.0 * derived["lip_m"]
    assert result.history["lip_m"][-1] == derived["lip_m"]
    assert result.to_pandas().attrs["units"]["lip_m"] == "m"
    row = hydro2d.runs("out").iloc[0]
    assert row["derived.lip_m"] == derived["lip_m"]
    assert hydro2d.open_study("out").table()["derived.lip_m"].iloc[0] == derived["lip_m"]
    about = result.summary["provenance"]["models"]
    assert [(each["kind"], each["name"], each["file"]) for each in about] == [("result", "rim", "rim.py")]
    assert call(["plot", "out", "-o", "lip.png", "--kind", "history", "--quantity", "lip_m"]) == 0
    assert decks.loads(Path("out/deck.toml").read_text()).result["rim"].code == RIM  # the file is no longer needed


def test_kept_rows_have_them(shot):
    name = shot()
    study = f'deck = "{name}"\nkeep = "kept.csv"\n[[axis]]\nname = "speed"\nkey = "body.ball.velocity"\nvalues = ["900 m/s"]\n'
    Path("study.toml").write_text(study)
    assert call(["sweep", "study.toml", "--workers", "1", "--threads", "1", "--out", "out"]) == 0
    kept = next(csv.DictReader(Path("kept.csv").read_text().splitlines()))
    value = hydro2d.runs("out")["derived.lip_m"].iloc[0]
    assert float(kept["derived.lip_m"]) == pytest.approx(value, rel=1e-5)
    assert hydro2d.runs("kept.csv")["derived.lip_m"].iloc[0] == float(kept["derived.lip_m"])
    assert hydro2d.runs("kept.csv").index.equals(hydro2d.runs("out").index), "the label of the case is its speed alone"


def test_the_file_lies_next_to_the_deck(shot, tmp_path, monkeypatch):
    name = shot()
    (elsewhere := tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(elsewhere)
    assert decks.load(tmp_path / name).result["rim"].code_from == "rim.py"
    with pytest.raises(DeckError, match=r"result\.rim\.file: .*rim\.py"):
        decks.loads(DECK, ["result.rim.file=rim.py"])  # as of a command line, in the working directory


def test_the_text_is_part_of_the_set_up(shot):
    one = decks.load(shot()).setup
    assert decks.load(shot(("height of", "the height of"))).setup != one
    assert decks.loads(DECK).setup == decks.loads(DECK + "[result]").setup


#: what is changed in the file, the line of the mistake, and what is said of it
WRONG = [
    (("class Rim(Result):", "class Rim(Result:"), 6, "is not Python"),
    (("from hydro2d.measure", "import requests\nfrom hydro2d.measure"), 3, "imports requests; a file of results may import"),
    (("class Rim(Result)", "class Rim"), 1, "has 0 classes of results; write one, such as class Rim(Result)"),
    (("def measure(sim)", "def measured(sim)"), 1, "has no function measure(sim)"),
    (("def measure(sim)", "def measure(sim, time)"), 13, "measure takes one argument, the simulation"),
    (("lip_m: Number", "lip_m: str"), 9, "lip_m is declared as str; a result of a file is a Number"),
    (('result("number of cycles")', 'result("")'), 10, 'has no meaning; write cycles_so_far: Number = result("what it is")'),
    (("    lip_m:", "    lip_mm:"), 9, "lip_mm ends in mm, which no unit of results is written as; numbers are in SI"),
    (("    lip_m:", "    rod_length_m:"), 9, "rod_length_m is the name of another quantity; give it another"),
    (("    lip_m:", "    wall_s:"), 9, "wall_s is the name of another quantity; give it another"),
    (("    lip_m:", "    cycle:"), 9, "cycle is not allowed as the name of a result; give it another"),
    (("def measure", "1 / 0\n\n\ndef measure"), 13, "cannot be imported: ZeroDivisionError: division by zero"),
]


@pytest.mark.parametrize(("change", "line", "said"), WRONG)
def test_a_wrong_file_is_refused_with_the_deck(shot, change, line, said):
    with pytest.raises(DeckError) as refused:
        decks.load(shot(change, deck=NAMED.replace('twice_m = "2 * lip_m"\n', "")))
    message = str(refused.value)
    assert message.startswith(f"shot.toml:{LINE - 1}: result.rim.file: rim.py:{line}: ")
    assert said in message
    assert "\n" not in message


@pytest.mark.parametrize(
    ("change", "line", "said"),
    [
        (("return Rim(lip_m=lip, cycles_so_far=sim.cycle)", "return {'lip_m': lip}"), 13,
         "measure returns dict; return Rim(...)"),
        (("lip_m=lip,", "lip_m='high',"), 15, "lip_m is 'high', not a number; write float(...), or None without one"),
        (("lip_m=lip,", "lip_m=float('nan'),"), 9, "lip_m is nan; return None where there is no number"),
        (("lip_m=lip,", "lip_m=1e400,"), 9, "lip_m is inf; return None where there is no number"),
        (("back plate", "wall"), 14, "measure raises KeyError: 'wall'; correct it, and --restart continues the run"),
        (("return Rim(", "raise SystemExit\n    return Rim("), 15, "measure raises SystemExit; correct it"),
    ],
)
def test_a_wrong_measurement_ends_the_run_with_one_line(shot, change, line, said):
    with pytest.raises(ColumnError) as failed:
        run(decks.load(shot(change)), "out", quiet=True)
    assert str(failed.value).startswith(f"rim.py:{line}: {said}")
    assert "\n" not in str(failed.value)


def test_a_corrected_file_continues_the_run(shot):
    later = ("lip = sim.", "if sim.cycle > 20:\n        raise ValueError('late')\n    lip = sim.")
    with pytest.raises(ColumnError, match=r"^rim.py:15: measure raises ValueError: late; correct it, and --restart continues"):
        run(decks.load(shot(later)), "out", quiet=True)
    summary = run(decks.load(shot()), "out", quiet=True, restart=True)
    assert summary["derived"]["cycles_so_far"] == 40.0
    assert summary["derived"] == run(decks.load(shot()), "whole", quiet=True)["derived"]


def test_the_code_of_a_stranger_is_not_run(shot):
    mark = "open('was run', 'w').close()\n"
    text = decks.load(shot()).to_toml().replace("class Rim", f"{mark}class Rim")
    deck = decks.loads(text, trust=False)  # names and units are known without running it
    with pytest.raises(ColumnError, match="rim.py, which the deck of the run carries, is not run; --trust"):
        hydro2d.Simulation(deck).run(until=lambda sim: True)
    assert not Path("was run").exists()
    with pytest.raises(DeckError, match="names a file, which only a deck that is run may do"):
        decks.load("shot.toml", trust=False)


@pytest.mark.parametrize(
    ("name", "ending"),
    [("depth_mm", "mm"), ("speed_km_s", "km_s"), ("speed_ms", "ms"), ("speed_m_S", "S"), ("p_pa", "pa"), ("p_MPa", "MPa"),
     ("rho_kgm3", "kgm3"), ("a_m_per_s", "per_s"), ("torque_N_m", "N_m"), ("mass_g", "g"), ("speed_m_s", ""), ("depth_m", ""),
     ("count", ""), ("length_ratio", ""), ("volume_per_energy_m3_J", ""), ("depth_in_m", "")],
)
def test_an_ending_that_looks_like_a_unit_and_is_none(name, ending):
    assert wrong_ending(name) == ending


def test_no_result_of_hydro2d_has_such_an_ending():
    names = {each.name.split(".")[-1] for each in Summary.listed() if each.number} | set(Outcome.model_fields)
    assert [name for name in names if wrong_ending(name)] == []
    assert all(not wrong_ending(f"x{ending}") for ending in UNITS)
