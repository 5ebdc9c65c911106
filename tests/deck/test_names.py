"""Names of bodies, tracers and gauges: no two of them share a column of the history."""

import unicodedata

import pytest

from hydro2d.base.errors import DeckError
from hydro2d.deck import deck
from tests.decks import box, entry, mesh, stop

MESH = mesh(("10 mm", 10), ("30 mm", 30)) + stop("1 us")


def bodies(*names: str) -> str:
    return MESH + "".join(box(name, "Al5083", z=[f"{5 * n} mm", f"{5 * n + 4} mm"]) for n, name in enumerate(names))


@pytest.mark.parametrize(("one", "other", "column"), [
    ("plate", "plate_failed", "body_plate_failed_mass_kg"),
    ("X", "X_initial", "body_X_initial_length_m"),
    ("X", "X_radius_at", "body_X_radius_at_z_min_m"),
])
def test_bodies_that_would_share_a_column_are_refused(one, other, column):
    for names in ((one, other), (other, one)):
        with pytest.raises(DeckError, match=rf"the history would have the column {column} for"):
            deck.loads(bodies(*names))


def test_names_that_look_alike_are_refused():
    names = [unicodedata.normalize(form, "plaqué") for form in ("NFC", "NFD")]
    assert names[0] != names[1]
    with pytest.raises(DeckError, match="looks like that of an earlier body"):
        deck.loads(bodies(*names))


def test_other_names_are_free():
    deck.loads(bodies("plate", "plate_2", "plate_mass", "failed"))


def test_tracers_that_would_share_a_column_are_refused():
    tracers = [entry("tracer", name=name, r="1 mm", z="2 mm") for name in ("a", "b")]
    deck.loads(bodies("plate") + "".join(tracers))


def test_corners_of_a_polygon_at_one_height_but_for_round_off():
    """A corner at 3e-19 m beside one at 0 makes no slab of its own."""
    for low, high in (("3e-16 mm", "6 mm"), ("0 mm", "6.0000000000000009 mm")):
        points = [[0.0, "0 mm"], ["4 mm", low], ["4 mm", high], ["1e-17 mm", "6 mm"]]
        text = MESH + entry("body", name="block", material="Al5083", shape="polygon", points=points)
        outline = deck.loads(text).body[0].outline(0.0)
        assert [(slab.low, slab.high) for slab in outline.slabs] == [(0.0, pytest.approx(6e-3))]


@pytest.mark.parametrize("cutoff", [0.0, 1e-300, 1e-13])
def test_a_cutoff_that_is_round_off_is_refused(cutoff):
    with pytest.raises(DeckError, match=r"numerics.cutoff: should be greater than or equal to 0\.000000000001"):
        deck.loads(bodies("plate"), [f"numerics.cutoff={cutoff}"])
