"""Names and numbers that a deck cannot have are refused with their key; no deck causes a traceback."""

import contextlib
import tomllib

import numpy as np
import pytest

from hydro2d.base.errors import DeckError, nearest, unknown
from hydro2d.cli.main import call
from hydro2d.deck import deck
from hydro2d.running import run
from hydro2d.study.plan import definition
from tests.measure.test_sanity import TEXT

TRACED = TEXT + '''
[[tracer]]
name = "tail"
r = "1 mm"
z = "3 mm"
[[tracer]]
name = "tip"
r = "1 mm"
z = "7 mm"
[penetration]
rod = "flyer"
target = "wall"
[experiment]
penetration = "1 mm"
source = "nowhere"
'''

STUDY = '''
deck = "shot.toml"
[[axis]]
name = "v"
key = "stop.time"
values = [1e-6]
'''
NAMES = ["", "  ", "a/b", "..", ".", "a\\\\b", "a\\u0000b", "a\\nb", "../../x"]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("key", ["body.wall.name", "tracer.tail.name", "name"])
def test_names_that_would_ruin_files(key, name):
    with pytest.raises(DeckError, match="name: "):
        deck.loads(TRACED, [f'{key}="{name}"', *(['penetration.target="x"'] if "wall" in key else [])])


@pytest.mark.parametrize("name", ["x", "Größe", "a b", "a:b", "W-Ni-Fe (93 %)", "{body}"])
def test_names_may_be_changed_by_an_override(name):
    changed = deck.loads(TRACED, [f'body.wall.name="{name}"', f'penetration.target="{name}"', f'tracer.tail.name="{name}"'])
    assert changed.body[1].name == changed.tracer[0].name == name


def test_two_tracers_of_one_name():
    with pytest.raises(DeckError, match=r'tracer\[1\].name: the name "tail" is already used by an earlier tracer'):
        deck.loads(TRACED, ['tracer.tip.name="tail"'])


def leaves(data, path=()):
    """Dotted keys of all numbers of a deck, and of all texts that are quantities."""
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in entries:
        if isinstance(value, (dict, list)):
            yield from leaves(value, (*path, key))
        elif isinstance(value, (int, float)) and not isinstance(value, bool):
            yield ".".join(str(part) for part in (*path, key))


KEYS = sorted(leaves(tomllib.loads(deck.loads(TRACED).to_toml())))
ABSURD = ["1e308", "-1e308", "1e30", "1e-300", "-1e-300", "0", "nan", "inf", "-inf", "1e400", '"1e308 us"', '"1e308 mm"',
          "true", "[]", "{}", '""', '"\\u0000"', "9999999999999999999", "2.5"]


@pytest.mark.parametrize("key", KEYS)
def test_an_absurd_number_is_refused_or_harmless(key):
    """Every number of a resolved deck, replaced by every absurdity: the result is a message that names the key, or a deck."""
    text = deck.loads(TRACED).to_toml()
    for value in ABSURD:
        with contextlib.suppress(DeckError):  # any other error is a traceback for the user
            deck.loads(text, [f"{key}={value}"])


def test_there_are_keys_to_try():
    assert {"numerics.courant", "stop.time", "body.0.velocity.1", "mesh.z.0.cells", "tracer.0.r"} <= set(KEYS)


@pytest.mark.parametrize(("override", "reason"), [
    ("body.flyer.velocity=1e30", "beyond 1e+06: matter that meets"), ("body.flyer.velocity=[0, -1e7]", "beyond 1e+06"),
    ("body.flyer.density=1e30", "no matter on earth is denser"), ('stop.time="1e308 us"', "no impact lasts longer"),
    ("numerics.dt_min=1e300", "no impact lasts longer"), ("mesh.r=[{to=1e30, cells=3}]", "no mesh of an impact"),
    ("mesh.z=[{to='20 mm', first='1 mm', ratio=1e-300}]", "must lie between 0.001 and 1000"),
    ('output.directory=""', "is not a path")])
def test_ranges_have_reasons(override, reason):
    with pytest.raises(DeckError) as refused:
        deck.loads(TRACED, [override])
    assert reason in str(refused.value)


def test_the_override_that_had_the_last_word_is_quoted():
    with pytest.raises(DeckError, match=r"^--set numerics.courant=7: "):
        deck.loads(TRACED, ["numerics={courant=0.3}", "numerics.courant=0.4", "numerics.courant=7"])


def test_a_byte_order_mark_is_no_statement(tmp_path):
    (tmp_path / "shot.toml").write_bytes(b"\xef\xbb\xbf" + TEXT.encode())
    assert deck.load(tmp_path / "shot.toml").name == "shot"
    (tmp_path / "study.toml").write_bytes(b"\xef\xbb\xbf" + STUDY.encode())
    assert definition.read(tmp_path / "study.toml", [])[0].axis[0].name == "v"


def test_decks_and_studies_are_distinguished(tmp_path, capsys):
    (tmp_path / "shot.toml").write_text(TEXT)
    (tmp_path / "study.toml").write_text(STUDY)
    assert call(["sweep", str(tmp_path / "shot.toml")]) == 2
    assert "is a deck; run it with `hydro2d run`" in capsys.readouterr().err
    assert call(["run", str(tmp_path / "study.toml")]) == 2
    assert "is a study, not a deck; run it with `hydro2d sweep`" in capsys.readouterr().err


def test_a_deck_of_the_user_is_not_overwritten(tmp_path, capsys):
    (tmp_path / "deck.toml").write_text(TEXT)
    assert call(["run", str(tmp_path / "deck.toml"), "--out", str(tmp_path), "--overwrite", "--quiet"]) == 2
    assert "deck.toml does not belong to a run" in capsys.readouterr().err
    assert (tmp_path / "deck.toml").read_text() == TEXT
    run.run(deck.loads(TEXT, ["stop.cycles=1"]), tmp_path / "out", quiet=True)
    assert run.run(deck.loads(TEXT, ["stop.cycles=1"]), tmp_path / "out", overwrite=True, quiet=True)["cycles"] == 1


def test_an_end_that_nearly_fits_whole_cells_is_met_and_reported():
    """For example 13.291833 mm where 13.2918335 mm was meant."""
    meant = deck.loads(TEXT, ['mesh.z=[{to="20 mm", size="0.5 mm"}]'])
    assert [text for text in deck.warnings(meant) if text.startswith("mesh")] == []
    snapped = deck.loads(TEXT, ['mesh.z=[{to="20.00004 mm", size="0.5 mm"}]'])
    assert deck.warnings(snapped)[0] == "mesh.z[0]: ends 8e-05 of a cell from a whole number; the cells were adjusted"
    edges = deck.edges(snapped)[1]
    assert (len(edges), edges[-1]) == (41, 20.00004e-3)
    assert np.ptp(np.diff(edges)) < 1e-15
    with pytest.raises(DeckError, match="do not divide"):
        deck.loads(TEXT, ['mesh.z=[{to="20.0001 mm", size="0.5 mm"}]'])


@pytest.mark.parametrize(
    ("segment", "said"),
    [
        ('{to="2.3 cm", size="0.3 mm"}', "0.3 mm do not divide 2.3 cm; to = 2.28 cm or 2.31 cm would fit, or cells = "
         "76 (of 0.3026 mm) or 77 (of 0.2987 mm)"),
        ("{to=0.023, size=3e-4}", "0.0003 m do not divide 0.023 m; to = 0.0228 m or 0.0231 m"),
        ('{to="1 in", size="2 mm"}', "2 mm do not divide 0.0254 m; to = 0.024 m or 0.026 m"),
        ('{to="1 mm", size="3 cm"}', "3 cm do not divide 1 mm; to = 30 mm would fit, or cells = 1 (of 0.1 cm)"),
    ],
)
def test_a_size_that_does_not_divide_is_reported_in_the_units_of_the_deck(segment, said):
    with pytest.raises(DeckError, match=r"mesh\.z\[0\]") as error:
        deck.loads(TEXT, [f"mesh.z=[{segment}]"])
    assert said in str(error.value)


@pytest.mark.parametrize(
    ("name", "allowed", "near"),
    [
        ("depth", ("dt", "time", "cycle"), None), ("taylor", ("to", "ratio", "cells"), None), ("length", ("left",), None),
        ("velocity", ("density",), None), ("sl", ("slip-layer",), None), ("dept", ("depth", "dt"), "depth"),
        ("rdo", ("rho", "rod"), "rod"), ("Tylor", ("to", "taylor"), "taylor"), ("slip", ("none", "slip-layer"), "slip-layer"),
        ("steinberg", ("steinberg-guinan", "johnson-cook"), "steinberg-guinan"),
    ],
)
def test_only_a_name_that_is_near_is_suggested(name, allowed, near):
    assert nearest(name, allowed) == near
    assert ("did you mean" in unknown("key", name, allowed)) == (near is not None)
