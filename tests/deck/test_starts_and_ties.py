"""Messages on a deck before it runs: order of targets, starts, overlaps, numbers without units, what bears tension."""

import math
from pathlib import Path

import numpy as np
import pytest

from hydro2d.base.errors import DeckError
from hydro2d.deck import deck
from hydro2d.deck.shapes.outlines import rectangle, shared_volume
from hydro2d.deck.shapes.sphere import sphere_outline
from hydro2d.deck.warnings import warnings
from hydro2d.materials import library, starts
from hydro2d.running import check
from hydro2d.solver.simulation import Simulation
from tests.decks import body, entry, mesh, plate, rod, stop, table

ROOT = Path(__file__).parents[2]
MESH = mesh(("20 mm", 20), ("-14 mm", "26 mm", "1 mm")) + stop("1 us")
ROD = rod("3 mm", "10 mm", tip=0.0, velocity="1000 m/s")
SHIPPED = sorted(str(file.relative_to(ROOT)) for file in (ROOT / "problems").glob("*/*.toml") if "[mesh]" in file.read_text())


def box_of(name, r, z, material="Al5083", **keys):
    return body(name, material, "box", r=[f"{x} mm" for x in r], z=[f"{x} mm" for x in z], **keys)


@pytest.mark.parametrize("name", SHIPPED)
def test_a_resolved_deck_is_a_fixed_point(name):
    loaded = deck.load(ROOT / name)
    text = loaded.to_toml()
    assert deck.loads(text, name=loaded.name).to_toml() == text


@pytest.mark.parametrize("seed", range(30))
def test_resolved_decks_of_random_boxes_are_fixed_points(seed):
    """Nested, side by side, behind one another, in any order, ahead of and behind the rod."""
    rng = np.random.default_rng(seed)
    bodies = [ROD]
    for number in range(int(rng.integers(1, 6))):
        (r0, r1), (z0, z1) = (np.sort(rng.choice(np.arange(21), 2, replace=False)) for _ in range(2))
        bodies.append(box_of(f"box {number}", (r0 if rng.random() < 0.3 else 0, r1), (z0, z1)))
    rng.shuffle(bodies)
    text = deck.loads(MESH + "".join(bodies)).to_toml()
    assert deck.loads(text).to_toml() == text


def test_an_insert_is_reached_after_the_block_around_it():
    loaded = deck.loads(MESH + ROD + box_of("insert", (0, 8), (5, 8)) + plate("20 mm", name="block"))
    assert loaded.penetration.targets == ("block", "insert")
    assert loaded.penetration.surface == 0.0


COPPER = table("materials.copper", based_on="copper_OFHC", variant="johnson-cook")


def state(**keys):
    """Density, pressure and temperature of copper."""
    loaded = deck.loads(MESH + COPPER + box_of("bar", (0, 3), (0, 10), material="copper", **keys))
    slots = library.resolve(loaded)
    rho, e = starts.body_state(loaded.body[0], slots, 0)
    return rho, *(slots.evaluate(0, rho, e)[n] for n in (0, 3))


def test_a_temperature_alone_means_no_pressure():
    """Copper at 718 K: 1.7 % lighter than at 298 K, with a linear expansion of 17e-6 /K it would be 2.2 %."""
    rho, p, temperature = state(temperature="718 K")
    assert (rho, temperature) == (pytest.approx(8776.0, rel=1e-3), pytest.approx(718.0, rel=1e-9))
    assert abs(p) < 1.0


def test_two_of_density_pressure_and_temperature_give_the_third():
    rho, p, temperature = state(temperature="718 K", pressure="1 GPa")
    assert (p, temperature) == (pytest.approx(1e9, rel=1e-7), pytest.approx(718.0, rel=1e-9))
    assert state(temperature="718 K", density=f"{rho!r} kg/m^3")[1] == pytest.approx(1e9, rel=1e-6)
    assert state(temperature="718 K", density="8960 kg/m^3")[1] == pytest.approx(2.90e9, rel=0.01)
    with pytest.raises(deck.DeckError, match="give two of density, pressure and temperature"):
        state(temperature="718 K", pressure="1 GPa", density="8960 kg/m^3")


def test_a_temperature_that_no_density_has_without_pressure_is_reported():
    with pytest.raises(deck.DeckError, match='body "bar": copper has no density with a pressure of -1e.11 Pa at 718 K'):
        state(temperature="718 K", pressure="-100 GPa")


def test_a_gas_has_its_own_density():
    text = MESH + box_of("air", (0, 3), (0, 10), material="air", temperature="400 K") + (
        '[materials.air.eos]\nmodel = "ideal-gas"\nreference_density = 1.2\nadiabatic_index = 1.4\n')
    loaded = deck.loads(text)
    assert starts.body_state(loaded.body[0], library.resolve(loaded), 0)[0] == 1.2


def test_a_hot_bar_at_rest_stays_at_rest():
    sim = Simulation(deck.loads(MESH + box_of("bar", (0, 3), (0, 10), material="copper_OFHC", temperature="718 K")))
    sim.run()
    assert np.abs(sim.state.v).max() < 1e-3


@pytest.mark.parametrize(("first", "second", "said"), [
    (box_of("plate", (0, 20), (0, 10)), box_of("rod", (0, 3), (-10, 3)), 'bodies "plate" and "rod" overlap by 84.8 mm^3'),
    (box_of("insert", (0, 8), (5, 8)), box_of("block", (0, 20), (0, 20)), ""),  # all of it inside, and intended
    (box_of("a", (0, 3), (0, 3)), box_of("b", (3, 6), (0, 3)), ""),
    (box_of("a", (0, 3), (0, 3)), box_of("b", (0, 3), (2, 5), join="a"), ""),
])
def test_overlaps_are_reported_with_their_volume(first, second, said):
    texts = [text for text in warnings(deck.loads(MESH + first + second)) if "overlap" in text]
    assert [text.startswith(said) and "the earlier one" in text for text in texts] == [True] * bool(said)


def test_the_volume_that_two_bodies_share():
    """A ball and a box that cuts off its upper half; planar, a disc."""
    ball, upper = sphere_outline(0.0, 0.0, 2.0), rectangle((0.0, 5.0), (0.0, 5.0))
    volume = shared_volume(ball, upper, (0.0, 5.0), (-5.0, 5.0), False)
    assert volume == pytest.approx((2 / 3 * math.pi * 8.0, 4 / 3 * math.pi * 8.0), rel=1e-4)
    volume = shared_volume(ball, upper, (0.0, 5.0), (-5.0, 5.0), True)
    assert volume == pytest.approx((math.pi, 2.0 * math.pi), rel=1e-3)
    assert shared_volume(ball, upper, (0.0, 5.0), (-5.0, 0.0), False)[0] == 0.0


def lines(text):
    return "\n".join(check.check(deck.loads(text)).lines(1))


def test_ties_are_reported():
    pair = box_of("flyer", (0, 3), (-2, 0), velocity="100 m/s") + box_of("target", (0, 3), (0, 10), material="W_alloy")
    said = "flyer is tied to target where they touch, until one of them fractures, at "
    assert said in lines(MESH + pair)
    assert 'sliding.method = "contact" lets them part' in lines(MESH + pair)
    assert "is tied to" not in lines(MESH + pair + table("sliding", method="contact", hard=["target"]))
    assert "is tied to" not in lines(MESH + pair.replace('velocity = "100 m/s"', ""))
    assert "where they touch, always" in lines(MESH + pair + table("failure", tensile="none"))


def test_walls_that_bear_tension_are_reported():
    alone = box_of("bar", (0, 3), (-14, 0), velocity="-20 m/s")
    at_wall = lines(MESH + alone + table("boundaries", z_min="wall"))
    assert "a wall (z_min) also resists tension: it holds" in at_wall
    assert "It is smooth" in at_wall
    assert "resists tension" not in lines(MESH + alone)


LEAVES = "leaves it before the end"


@pytest.mark.parametrize(("kind", "start", "leaves"), [
    ("outflow", -14, True), ("outflow", -13, True), ("anvil", -14, False), ("anvil", -13, False), ("held", -14, False),
    ("wall", -14, False), ("transmit", -14, False), ("transmit", -13, True)])
def test_a_body_at_an_edge_that_keeps_it_is_not_said_to_leave(kind, start, leaves):
    """The mesh begins at -14 mm. Earlier, a bar on an anvil was to leave it after -0 us; a cut body has no end that leaves."""
    bar = box_of("bar", (0, 3), (start, 0), velocity="-20 m/s") + table("boundaries", z_min=kind)
    said = [text for text in warnings(deck.loads(MESH + bar, ["stop.time=1 ms"])) if LEAVES in text]
    assert len(said) == leaves
    assert not any("-0 us" in text for text in said)


@pytest.mark.parametrize(("settings", "stuck"), [
    ({}, ["plate"]), ({"r_max_axial": "100 m/s"}, []), ({"r_max_radial": "1 m/s"}, ["plate"])])
def test_bodies_that_a_held_edge_starts_to_shear_are_reported(settings, stuck):
    bodies = (box_of("plate", (0, 20), (0, 10), velocity="100 m/s") + box_of("rod", (0, 3), (-10, 0), velocity="200 m/s")
              + table("boundaries", r_max="held", **settings))
    said = [text for text in warnings(deck.loads(MESH + bodies)) if 'r_max = "held"' in text]
    assert [name for name in ("plate", "rod") if any(f'"{name}" starts at' in text for text in said)] == stuck


@pytest.mark.parametrize(("width", "share"), [(20, ""), (12, "40% of it")])
def test_void_beside_a_body_under_a_pressure_is_reported(width, share):
    text = MESH + box_of("plate", (0, width), (-14, 10)) + table("boundaries", z_min="pressure", z_min_pressure="1 GPa")
    said = [text for text in warnings(deck.loads(text)) if "void lies at" in text]
    assert [share in text for text in said] == [True] * bool(share)


def test_a_pressure_across_void_is_refused():
    text = MESH + box_of("plate", (0, 20), (0, 10)) + table("boundaries", z_min="pressure", z_min_pressure="1 GPa")
    with pytest.raises(DeckError, match=r"no body lies at this edge, and its pressure does not act across void"):
        deck.loads(text)


def test_a_mesh_that_follows_has_no_pressure_and_no_clamp_along_z():
    flying = MESH.replace("[mesh]", '[mesh]\nfollow = "rod"') + box_of("rod", (0, 3), (-10, 0), velocity="200 m/s")
    for kind, said in (("pressure", "an edge with a pressure cannot travel with it"), ("held", "a held edge cannot travel")):
        more = {"z_min_pressure": "1 kPa"} if kind == "pressure" else {}
        with pytest.raises(DeckError, match=said):
            deck.loads(flying + table("boundaries", z_min=kind, **more))


def test_liquids_that_bear_any_tension_are_reported():
    def told(material, **failure):
        text = MESH + box_of("a", (0, 3), (0, 3), material=material) + (table("failure", **failure) if failure else "")
        text += table("materials.melt", eos={"model": "stiffened-gas", "reference_density": "1000 kg/m^3",
                                             "adiabatic_index": 4.4, "sound_speed": "1483 m/s",
                                             "specific_heat": "4180 J/kg/K"})
        return [text for text in warnings(deck.loads(text)) if "bears any tension" in text]

    assert told("melt") == [
        'body "a": melt has no fracture_pressure and bears any tension; give it one, at which it cavitates']
    assert told("melt", tensile="none") == []
    assert told("Al_tillotson") == []
    assert told("water_tillotson") == []


def test_water_cavitates():
    """Two slabs at 400 m/s: a step adds little to the tension at which water cavitates, -20 MPa; it used to bear -108 MPa."""
    water = entry("body", name="flyer", material="water_tillotson", shape="box", r=[0.0, "0.4 mm"], z=["-2 mm", "0 mm"],
                  velocity="400 m/s") + entry("body", name="target", material="water_tillotson", shape="box", r=[0.0, "0.4 mm"],
                                              z=["0 mm", "4 mm"])
    sim = Simulation(deck.loads(
        mesh(("0.4 mm", 4), ("-6 mm", "12 mm", "0.1 mm")) + water + table("boundaries", r_max="wall") + stop("5 us")
        + entry("gauge", name="spall", r="0.05 mm", z="2.25 mm")))
    sim.run()
    assert -25e6 < sim.stations.measure()["gauge_spall"]["least_pressure_Pa"] < 0.0
