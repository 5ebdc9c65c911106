"""Material that has failed by damage: it stays failed, bears neither shear nor tension, and is counted."""

import numpy as np
import pytest

from hydro2d.base.errors import DeckError
from hydro2d.deck import deck
from hydro2d.materials.quantities import FieldError
from hydro2d.mesh.fields import BY_DAMAGE, BY_TENSION, FAILED, SRR, SRZ
from hydro2d.solver.simulation import Simulation
from tests.decks import body, box, mesh, plate, rod, stop, table, walls
from tests.verification.running import finish, to_the_end
from tests.verification.test_translation import ROD

STRAIN_FAILURE = """
[materials.rod_fails]
based_on = "W_alloy"
variant = "strain-failure"
[materials.plate_fails]
based_on = "Al5083"
variant = "strain-failure"
[failure]
damage = "material"
"""
FLIGHT = ROD.replace("W_alloy", "rod_fails") + STRAIN_FAILURE
#: two halves of a bar of one material, which part in the middle; at r = const nothing happens
BAR = (
    mesh(("2 mm", 4), ("-20 mm", "20 mm", 80))
    + walls("r_max")
    + box("low", "rod_fails", z=["-15 mm", "0 mm"], velocity="-20 m/s")
    + box("high", "rod_fails", z=["0 mm", "15 mm"], velocity="20 m/s", join="low")
    + stop("5 us")
    + STRAIN_FAILURE
)
#: a short rod that fails at a strain of 0.5, so that much of it fails within a few microseconds
SHOT = (
    mesh(("9 mm", 18), ("-12 mm", "18 mm", 60))
    + rod("2 mm", "10 mm", material="rod_fails", nose="flat", tip=0.0, velocity="2000 m/s")
    + plate("16 mm", material="plate_fails")
    + stop("9 us")
    + STRAIN_FAILURE.replace("[materials.plate", "damage.D1 = 0.5\n[materials.plate")
)
SLIP_LAYER = """
[sliding]
method = "slip-layer"
hard = ["rod"]
yield_factor = "off"
"""
CONTACT = SLIP_LAYER.replace("slip-layer", "contact")


def fail_everything(simulation: Simulation) -> None:
    simulation.state.dmg[:] = np.where(simulation.state.vof > 0.0, FAILED, 0.0)


def failed(simulation: Simulation) -> np.ndarray:
    """Where a body [m, j, i] has failed."""
    s = simulation.state
    return (s.dmg >= 1.0) & (s.vof > 0.0)


@pytest.mark.parametrize("advection", ["ke", "momentum", "both"])
def test_failed_material_stays_failed_while_it_moves(advection):
    """Some 120 cycles across 24 cells: a mean of ones, with round-off, is one."""
    simulation = Simulation(deck.loads(FLIGHT, ["stop.time=12 us", f'numerics.advection="{advection}"']))
    fail_everything(simulation)
    while simulation.stop_reason() is None:
        simulation.step()
    present = simulation.state.vof > 0.0
    assert np.all(simulation.state.dmg[present] == FAILED)


@pytest.mark.parametrize("cells", [4, 8])
def test_a_thin_failed_layer_does_not_heal_as_it_moves(cells):
    """Rows of a rod that have failed, across 24 cells: half-and-half mixtures with sound material count as failed."""
    simulation = Simulation(deck.loads(FLIGHT, ["stop.time=12 us"]))
    grid, s = simulation.grid, simulation.state
    middle = int(np.median(np.nonzero(grid.interior(s.vof)[0].sum(axis=1))[0]))
    grid.interior(s.dmg)[0, middle - cells // 2 : middle + cells // 2] = FAILED
    before = simulation.of_bodies()["rod"]["failed_mass_kg"]
    while simulation.stop_reason() is None:
        simulation.step()
    assert 0.75 * before < simulation.of_bodies()["rod"]["failed_mass_kg"] < 1.1 * before


@pytest.mark.parametrize(("broken", "speed"), [(True, 20.0), (False, 0.0)], ids=["failed", "intact"])
def test_a_failed_bar_parts_without_tension(broken, speed):
    """Halves at -20 and 20 m/s: a whole bar stops them by 1.5 GPa of tension, which it bears; a failed one parts."""
    simulation = Simulation(deck.loads(BAR))
    if broken:
        fail_everything(simulation)
    pull = 0.0
    while simulation.time < 2e-6:
        simulation.step()
        pull = min(pull, float(simulation.state.p.min()))
    middle = np.abs(simulation.grid.z_edges) < 6e-3
    v = np.abs(simulation.grid.interior_vertices(simulation.state.v)[0, middle])
    assert (pull == 0.0) == broken
    assert np.median(v) == pytest.approx(speed, abs=1.0)


@pytest.mark.parametrize("sliding", ["", SLIP_LAYER, CONTACT], ids=["sticking", "slip-layer", "contact"])
def test_debris_bears_no_shear_and_no_tension_and_is_counted(sliding):
    """In the cells of a shot in which rod and plate fail; the pressure is that of the cells as the cycle before left them."""
    counts, alone = [], []

    def watch(simulation):
        s, where = simulation.state, failed(simulation)
        if alone:
            assert np.all(s.p[alone.pop()] >= 0.0)
        if simulation.cycle % 5 == 0:
            assert np.all(s.q[SRR : SRZ + 1, where] == 0.0)
            alone.append((where & (s.vof == 1.0)).any(axis=0))
            measured = simulation.diagnostics()
            counts.append((measured["rod_failed_mass_kg"], measured["target_failed_mass_kg"]))
            assert measured["rod_failed_mass_kg"] + measured["rod_core_mass_kg"] <= measured["rod_mass_kg"] * (1 + 1e-12)

    simulation = finish(deck.loads(SHOT + sliding), watch)
    measured = simulation.diagnostics()
    rod, plate = counts[-1]
    assert 0.02 < rod / measured["rod_mass_kg"] < 0.9
    assert plate > 0.02 * measured["rod_mass_kg"]
    assert abs(simulation.conservation()["total_energy"]) < 1e-2


# ------------------------------------------------------------------------------------------------ the largest principal stress

#: a copper ring that flies apart, at 150 m/s along r everywhere: hoop stress only, E v t/R while it is elastic
RING = (
    mesh(("36 mm", "62 mm", "0.5 mm"), ("-5 mm", "5 mm", "0.5 mm"))
    + table("materials.ring",
            eos={"model": "mie-grueneisen", "reference_density": 8930, "sound_speed": 3940, "hugoniot_slope": 1.489,
                 "grueneisen": 2.02, "specific_heat": 383},
            strength={"model": "elastic-plastic", "shear_modulus": 47.7e9, "yield_stress": 0.3e9})
    + table("boundaries", r_min="outflow")
    + body("ring", "ring", "box", r=["38.2 mm", "41.9 mm"], z=["-2 mm", "2.1 mm"],
           flow={"pattern": "cylindrical", "speed": "150 m/s", "radius": "40 mm", "exponent": 0})
    + stop("40 us")
)


def share_failed(simulation: Simulation) -> float:
    s, grid = simulation.state, simulation.grid
    mass = grid.interior(s.vof[0] * s.rho[0] * grid.volume)
    return float(mass[grid.interior(s.dmg[0]) >= 1.0].sum() / mass.sum())


def test_a_ring_breaks_when_its_hoop_stress_is_due():
    """At 15 m/s, so that waves across the ring have died down: 0.2 GPa at E v t/R, t = 4.3 us, E = 125 GPa."""
    ring = Simulation(deck.loads(RING.replace("150 m/s", "15 m/s"), ['materials.ring.fracture_stress="0.2 GPa"']))
    bulk, shear = 8930 * 3940.0**2, 47.7e9
    due = 0.2e9 * 0.04 / (9 * bulk * shear / (3 * bulk + shear) * 15.0)
    while ring.time < 0.85 * due:
        ring.step()
    assert share_failed(ring) == 0.0
    while ring.time < 1.25 * due:
        ring.step()
    assert share_failed(ring) > 0.95
    where = ring.grid.interior(ring.state.dmg[0]) >= 1.0
    assert not ring.grid.interior(ring.state.srr[0])[where].any()


def test_a_ring_breaks_by_its_hoop_stress_and_not_by_its_pressure():
    """A ring that has failed keeps its velocity; an intact one is braked by its yield stress."""
    by_stress, by_pressure = (to_the_end(Simulation(deck.loads(RING, [f'materials.ring.fracture_{kind}="0.2 GPa"'])))
                              for kind in ("stress", "pressure"))
    for simulation in (by_stress, by_pressure):
        assert simulation.faults() == []
        assert abs(simulation.conservation()["total_energy"]) < 1e-12
    assert share_failed(by_pressure) == 0.0
    assert share_failed(by_stress) > 0.999  # it is carried, although there is no damage model
    kept = [simulation.conservation()["kinetic_energy_J"] / (2 * np.pi * simulation.audit.start.kinetic)
            for simulation in (by_stress, by_pressure)]
    assert kept[0] > 0.99
    assert kept[1] < 0.75


@pytest.mark.parametrize("share", [0.0, 0.4])
def test_a_bar_of_two_bodies_breaks_where_the_tension_is(share):
    """Wherever their common face lies in its cell."""
    middle = f"{0.5 * share} mm"
    text = (
        mesh(("2 mm", 4), ("-20 mm", "20 mm", 80))
        + table("materials.weak", based_on="W_alloy", fracture_stress="0.8 GPa", fracture_pressure="3.5 GPa")
        + box("low", "weak", r=[0.0, "1.5 mm"], z=["-15 mm", middle], velocity="-20 m/s")
        + box("high", "weak", r=[0.0, "1.5 mm"], z=[middle, "15 mm"], velocity="20 m/s")
        + stop("6 us")
    )
    simulation = to_the_end(Simulation(deck.loads(text)))
    places = simulation.grid.zc[np.nonzero(failed(simulation).any(axis=(0, 2)))[0]]
    assert places.size > 0
    assert np.abs(places).max() < 3e-3
    intact = to_the_end(Simulation(deck.loads(text, ['materials.weak.fracture_stress="2.5 GPa"'])))
    assert not failed(intact).any()


@pytest.mark.parametrize("overrides", [
    (["failure.damage='material'", "materials.ring.damage={ model = 'cochran-banner', opening = '25 um' }"], "opens cracks"),
    (["body.ring.material='alumina_995'", "materials.alumina_995.based_on='alumina_995'",
      "materials.alumina_995.fracture_stress='1 GPa'"], "a damage of its own"),
    (["materials.ring.fracture_stress='-1 GPa'"], "must be positive"),
], ids=["cracks", "jh-2", "negative"])
def test_settings_that_exclude_a_fracture_stress(overrides):
    with pytest.raises(DeckError, match=overrides[1]):
        Simulation(deck.loads(RING, ["materials.ring.fracture_pressure='1 GPa'", "materials.ring.fracture_stress='1 GPa'",
                                     *overrides[0]]))


def test_tensile_none_switches_a_fracture_stress_off_and_a_resolved_deck_keeps_it():
    loaded = deck.loads(RING, ['materials.ring.fracture_stress="0.2 GPa"'])
    again = deck.loads(loaded.to_toml())
    assert again.materials["ring"].fracture_stress.value == 0.2e9
    assert np.isinf(Simulation(deck.loads(loaded.to_toml(), ['failure.tensile="none"'])).table.fracture_stress).all()


# ------------------------------------------------------------------------------------------------ the size of the cell

#: the ring fails by strain
BY_STRAIN = ["failure.tensile='none'", "failure.damage='material'", "materials.ring.damage.model='johnson-cook'"]


def strain_of_a_broken_ring(cell: str, exponent: float, reference: str = "0.5 mm") -> float:
    """Plastic strain of the ring, mean by mass, when half of it has failed; its fracture strain is 0.04 in a reference cell."""
    given = ["D1=0.04", f"reference_cell='{reference}'", f"cell_exponent={exponent}"]
    ring = Simulation(deck.loads(RING.replace('"0.5 mm"', f'"{cell}"'), [*BY_STRAIN, *(f"materials.ring.damage.{each}"
                                                                                      for each in given)]))
    while share_failed(ring) < 0.5:
        assert ring.time < ring.deck.stop.time
        ring.step()
    s, grid = ring.state, ring.grid
    mass = grid.interior(s.vof[0] * s.rho[0] * grid.volume)
    return float((mass * grid.interior(s.ep[0])).sum() / mass.sum())


@pytest.mark.parametrize(("cell", "exponent"), [("0.5 mm", 0.0), ("0.25 mm", 0.0), ("0.25 mm", 0.5), ("1 mm", 0.5)])
def test_the_strain_at_fracture_is_that_of_the_cell(cell, exponent):
    """Of a ring in which the strain does not localise: ef (h/h0)^-m."""
    expected = 0.04 * (float(cell.split()[0]) / 0.5) ** -exponent
    assert strain_of_a_broken_ring(cell, exponent) == pytest.approx(expected, rel=0.03)


def test_without_an_exponent_a_reference_cell_changes_no_bit():
    rings = [Simulation(deck.loads(RING, [*BY_STRAIN, "materials.ring.damage.D1=0.005", *more])) for more in
             ([], ["materials.ring.damage.reference_cell='1 mm'", "materials.ring.damage.cell_exponent=0.0"])]
    for ring in rings:
        for _ in range(120):
            ring.step()
    assert share_failed(rings[0]) > 0.1
    np.testing.assert_array_equal(rings[0].state.q, rings[1].state.q)


# ------------------------------------------------------------------------------------------------ what a cell has failed by

RECORD = "failure.record=true"


@pytest.mark.parametrize(("overrides", "cause"), [
    (['materials.ring.fracture_stress="0.2 GPa"'], 1),
    ([*BY_STRAIN, "materials.ring.damage.D1=0.02"], 2),
    ([*BY_STRAIN, "materials.ring.damage.D1=0.01", "materials.ring.damage.D2=0.02", "materials.ring.damage.D3=-1.0"], 3),
], ids=["stress", "strain", "johnson-cook"])
def test_each_failed_cell_knows_its_criterion(overrides, cause):
    """And is otherwise the same, to the last bit, as without the record."""
    ring, plain = (Simulation(deck.loads(RING, [*overrides, *more])) for more in ([RECORD], []))
    for simulation in (ring, plain):
        while simulation.time < 18e-6:
            simulation.step()
    assert share_failed(ring) > 0.9
    broken = ring.grid.interior(ring.state.dmg[0]) >= 1.0
    causes = ring.field("body_failed_by", "ring")
    assert (causes[broken & (ring.grid.interior(ring.state.vof[0]) > 0.0)] == cause).all()
    assert (causes[~broken] == 0).all()
    assert set(np.unique(ring.field("failed_by"))) == {0, cause}
    rows = plain.state.q.shape[0]
    assert ring.state.q.shape[0] == rows + 1
    np.testing.assert_array_equal(ring.state.q[:rows], plain.state.q)


def test_only_a_deck_that_asks_keeps_what_cells_have_failed_by():
    ring = Simulation(deck.loads(RING, ['materials.ring.fracture_stress="0.2 GPa"']))
    with pytest.raises(FieldError, match="failed_by: the simulation has none"):
        ring.field("failed_by")
    never = Simulation(deck.loads(RING, [RECORD]))  # nothing there can fail
    assert never.state.q.shape == ring.state.q.shape
    assert not never.field("failed_by").any()


def test_a_layer_opened_by_tension_is_marked_where_it_parts():
    """The fracture pressure ends no strength for good, but what it has opened is marked."""
    simulation = Simulation(deck.loads(BAR, ["failure.damage='none'", RECORD, "materials.rod_fails.fracture_pressure='1 GPa'",
                                             "materials.rod_fails.damage.model='none'"]))
    to_the_end(simulation)
    assert not failed(simulation).any()
    rows = np.flatnonzero((simulation.field("body_failed_by", "low") == 1).any(axis=1))
    assert rows.size > 0
    middle = 0.5 * (simulation.grid.z_edges[1:] + simulation.grid.z_edges[:-1])[rows]
    assert np.abs(middle).max() < 5e-3


@pytest.mark.parametrize("cells", [4, 8])
def test_what_cells_have_failed_by_moves_with_them(cells):
    """Two layers of a rod, broken by tension and by damage, across 24 cells: no third cause arises where they mix."""
    simulation = Simulation(deck.loads(FLIGHT, ["stop.time=12 us", RECORD, "materials.rod_fails.fracture_stress='50 GPa'"]))
    grid, s = simulation.grid, simulation.state
    rod = list(simulation.table.names).index("rod")
    record = grid.interior(s.q[simulation.table.record[rod], rod])
    middle = int(np.median(np.nonzero(grid.interior(s.vof)[rod].sum(axis=1))[0]))
    below, above = slice(middle - cells, middle), slice(middle, middle + cells)
    grid.interior(s.dmg)[rod, middle - cells:middle + cells] = FAILED
    record[below], record[above] = BY_TENSION, BY_DAMAGE

    def shares():
        mass, causes = grid.interior(s.vof * s.rho * grid.volume)[rod], simulation.field("body_failed_by", "rod")
        assert set(np.unique(causes)) <= {0, 1, 2}
        return np.array([mass[causes == cause].sum() for cause in (1, 2)])

    before = shares()
    to_the_end(simulation)
    np.testing.assert_allclose(shares(), before, rtol=0.25)
    causes = simulation.field("body_failed_by", "rod")
    of = [np.nonzero((causes == cause).any(axis=1))[0] for cause in (1, 2)]
    assert of[0].max() <= of[1].min() + 1


# ------------------------------------------------------------------------------------------------ a plug


@pytest.mark.slow
def test_the_exponent_makes_a_plug_take_the_same_on_two_meshes():
    """Residual velocities of explanation/fracture: 142, 171 and 143 m/s."""
    def residual(cells: int, exponent: float) -> float:
        own = [f"mesh.cells_across={cells}", f"materials.plate_steel.damage.cell_exponent={exponent}"]
        shot = to_the_end(Simulation(deck.load("problems/perforation/plug.toml", own)))
        return shot.diagnostics()["rod_residual_velocity_m_s"]

    coarse = residual(20, 0.75)
    assert residual(40, 0.75) == pytest.approx(coarse, rel=0.05)
    assert residual(40, 0.0) > 1.1 * coarse
