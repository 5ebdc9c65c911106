"""The layout of a deck: made once, and anew for other sections."""

import pytest

from hydro2d.deck import deck

JACKET = "problems/cth_nose_shape/hemi_5083_1086.toml"


def test_a_layout_is_made_once_and_cannot_be_changed():
    loaded = deck.load(JACKET)
    first = deck.layout(loaded)
    assert deck.layout(loaded) is first
    assert deck.edges(loaded)[0] is deck.edges(loaded)[0]
    with pytest.raises(ValueError, match="read-only"):
        first.edges["z"][0] = 0.0


def test_a_deck_with_another_mesh_has_another_layout():
    loaded = deck.load(JACKET)
    start = deck.edges(loaded)[1][0]
    shifted = loaded.model_copy(update={"mesh": loaded.mesh.model_copy(update={"z_start": loaded.mesh.z_start - 0.01})})
    assert deck.edges(shifted)[1][0] == start - 0.01
    assert deck.edges(loaded)[1][0] == start


def test_bodies_in_their_places():
    loaded = deck.load(JACKET)
    rod, plate = deck.layout(loaded).bodies
    assert rod.extent == {"r": (-0.0033784, 0.0033784), "z": (-0.09779, 0.0)}
    assert plate.extent["z"] == pytest.approx((0.0, 0.5334))
    assert deck.layout(loaded).of(loaded.body[1]) is plate
    assert (deck.layout(loaded).slots, deck.layout(loaded).groups) == (["rod", "plate"], [1, 0])
