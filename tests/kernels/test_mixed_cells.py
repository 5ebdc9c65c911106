"""A mixed cell in a step, function by function, on one cell made by hand.

The cell is (2, 2) of a mesh of one square cell of 1 m, planar; two bodies of 2 and 8 kg/m^3 each fill half of it.
"""

import numpy as np
import pytest

from eos import ideal_gas, stiffened_gas
from eos.layout import ROW
from hydro2d.kernels import cut_cells, mixed, mixed_strength
from hydro2d.kernels.cut_cells import BESIDE_GAS, FREE_SURFACE, INTERFACE, KIND, NORMAL_R, WHOLE
from hydro2d.kernels.mixed_scratch import (
    ACROSS,
    FLOW,
    HEAT,
    HOURGLASS,
    MEAN_RR,
    MEAN_RZ,
    MEAN_TT,
    MEAN_ZZ,
    MODULUS,
    NORMAL,
    RBZ,
    RR,
    SIZE,
    SOFT,
    TRIAL_RR,
    TRIAL_RZ,
    TRIAL_ZZ,
    TT,
    YIELD,
    ZBR,
    ZZ,
)
from hydro2d.kernels.mixed_strength import MATERIAL, MAX, SOLID, VOLUME, ZERO
from hydro2d.materials.rows import DAMAGE_AT, EOS, EOS_AT, FACTOR, STRENGTH, STRENGTH_AT, TENSILE
from hydro2d.mesh.fields import DMG, RHO, SRR, SRZ, E
from strength import STRENGTH_MODELS
from tests.kernels.cells import Cells

AT = (2, 2)
ELASTIC = STRENGTH_MODELS["elastic-plastic"]


class Cell(Cells):
    """Its bodies are ideal gases (gamma = 1.4 and 3, of 1 kg/m^3 at rest); if `strong`, with G = 5 Pa, Y = 3 and 6 Pa."""

    def __init__(self, strong: bool = False, group=(0, 0)):
        super().__init__(nr=1, nz=1, bodies=2, group=list(group))
        models, materials = np.zeros((2, 5), dtype=np.int64), np.zeros((2, EOS_AT + ROW))
        for m, (gamma, flow) in enumerate(((1.4, 3.0), (3.0, 6.0))):
            models[m, EOS] = ideal_gas.ID
            materials[m, EOS_AT:] = ideal_gas.row({"adiabatic_index": gamma, "reference_density": 1.0})
            if strong:
                models[m, STRENGTH] = ELASTIC.ID
                materials[m, STRENGTH_AT:DAMAGE_AT] = ELASTIC.row({"shear_modulus": 5.0, "yield_stress": flow})
        materials[:, FACTOR], materials[:, TENSILE] = 1.0, 7.0
        self.vof[:, *AT], self.q[RHO, :, *AT], self.q[E, :, *AT] = 0.5, (2.0, 8.0), 1.0
        self.km[:, *AT], self.solid[AT], self.skin[KIND] = (100.0, 400.0), 1.0, WHOLE
        self.mixed_count[2], self.mixed[2, 0], self.cell_mass[0, *AT] = 1, 2, 5.0
        nobody = np.array([False, False])
        self.known |= {"j": 2, "i": 2, "dt": 0.1, "h": 1.0, "rate": 0.1, "total": 1.0, "firm": 1.0, "volume": 1.0,
                       "models": models, "materials": materials, "gases": nobody.copy(), "strong": models[:, STRENGTH] != 0,
                       "hard_bodies": nobody, "threshold": 0.5, "strength_mode": VOLUME,
                       "internal": np.zeros((5, 4))}

    def moving(self, **gradient: float) -> None:
        """A velocity gradient, constant over the step, and the filter's part."""
        names = {"rr": (RR, MEAN_RR), "tt": (TT, MEAN_TT), "zz": (ZZ, MEAN_ZZ), "rbz": (RBZ, MEAN_RZ), "zbr": (ZBR,),
                 "filter": (HOURGLASS,)}
        for name, value in gradient.items():
            self.motion[2, :, names[name]] = value

    def run(self, function, **given):
        """A scalar function run as Python."""
        return self.call(function, as_python=True, **given)


# ------------------------------------------------------------------------------------------------ motion and shares


def test_shares_in_a_change_of_volume():
    """By f/K they are 0.005 and 0.00125, so that the softer body takes four fifths; if strained alike, they are by volume. A
    pressure of 300 Pa makes the softer body three times as stiff."""
    cell = Cell()
    cell.pm[:, *AT] = 10.0, 20.0
    inverse, mean = cell.run(mixed.soften, pressure=15.0, tipton=True)
    assert (cell.mix[2, SOFT] * inverse).tolist() == pytest.approx([0.8, 0.2])
    assert mean == pytest.approx(12.0)
    inverse, mean = cell.run(mixed.soften, pressure=15.0, tipton=False)
    assert (cell.mix[2, SOFT] * inverse).tolist() == [0.5, 0.5]
    assert mean == 15.0
    inverse, _ = cell.run(mixed.soften, pressure=300.0, tipton=True)
    assert (cell.mix[2, SOFT] * inverse).tolist() == pytest.approx([4 / 7, 3 / 7])


def test_the_pressure_of_a_cell():
    cell = Cell()
    cell.pm[:, *AT] = 10.0, 20.0
    assert cell.run(mixed.mean_pressure) == 15.0
    cell.vof[1, *AT], cell.pm[1, *AT] = 0.0, np.nan
    assert cell.run(mixed.mean_pressure) == 5.0


def test_motion_lost_to_ties_heats_the_body_next_to_the_gas():
    """Half of 1 kg of the body is tied: 0.125 kg by (4 m/s)^2 for the pair below, at the start and at the end alike."""
    cell = Cell()
    cell.known["gases"][1] = True
    cell.skin[[NORMAL_R, KIND], *AT] = 1.0, BESIDE_GAS
    cell.u0[0, 2, 2:4] = cell.u[0, 2, 2:4] = 0.0, 4.0
    cell.run(mixed.heat_of_ties, g=0)
    assert cell.mix[2, HEAT] == pytest.approx([0.125 * 16.0, 0.0])
    cell.skin[KIND] = WHOLE
    cell.mix[2, HEAT] = 0.0
    cell.run(mixed.heat_of_ties, g=0)
    assert cell.mix[2, HEAT].tolist() == [0.0, 0.0]


def filled(cell: Cell, **given) -> Cell:
    """0.9 m^3 of the cell remain, of which the bodies lose 0.08 and 0.02."""
    cell.run(mixed.fill_cell, **{"change": -0.1, "work": 1.5, "relaxation": 0.0, "tipton": True, **given})
    return cell


def test_pressures_relax_by_changes_of_volume_that_sum_to_zero():
    """Half of -2/100 and 8/400, at 10 + 0.5 and 20 - 2 Pa; what these do not take from each other goes by mass."""
    cell = Cell()
    cell.pm[:, *AT] = 10.0, 20.0
    filled(cell, change=0.0, work=0.0, relaxation=0.5)
    assert cell.vof[:, *AT] == pytest.approx([0.495, 0.505])
    left = 0.5 * 0.01 * (18.0 - 10.5)
    assert cell.q[E, :, *AT] == pytest.approx([1 + 10.5 * 0.005 + 0.2 * left, 1 + (-18.0 * 0.005 + 0.8 * left) / 4])


# ------------------------------------------------------------------------------------------------- after the step


def test_the_whole_step_of_a_cell_of_two_gases():
    """Compressed by a tenth at 10 Pa: 1 J, of which each takes its own and the rest goes by mass; only swept volumes move."""
    cell = Cell()
    cell.fr[2, 2], cell.ph[AT], cell.pm[:, *AT] = 0.1, 10.0, 10.0
    cell.u0[0, 2:4, 2], cell.u[0, 2:4, 2] = 1.0, 1.0  # the left face at 1 m/s for 0.1 s
    cell.call(mixed.deform_mixed, relaxation=0.25, tipton=True, strength_mode=VOLUME)
    assert cell.vof[:, *AT] * 0.9 == pytest.approx([0.42, 0.48])
    left = 1.0 - 1.44 - 0.36
    assert cell.q[E, :, *AT] == pytest.approx([1 + 1.44 + 0.2 * left, 1 + (0.36 + 0.8 * left) / 4])


def pulled(cell: Cell, smallest: bool = False) -> Cell:
    """At a tension of 8 Pa each, of which both bear 7: without it they had 2.5 and 32 kg/m^3. Half may open per cycle."""
    for m, (rest, squared) in enumerate(((2.5, 16.0), (32.0, 1.0 / 3.0))):
        cell.known["models"][m, EOS] = stiffened_gas.ID
        cell.known["materials"][m, EOS_AT:] = stiffened_gas.row(
            {"reference_density": rest, "sound_speed": np.sqrt(squared), "adiabatic_index": 1.4, "specific_heat": 1.0})
    cell.p[AT], cell.pm[:, *AT], cell.q[SRR, :, *AT], cell.q[E, :, *AT] = -8.0, -8.0, 1.0, 0.0
    cell.call(mixed.insert_void_mixed_row, smallest_tension=smallest, max_opening=0.5)
    return cell


def test_void_opens_where_a_mixed_cell_fractures():
    """The first body keeps 2/2.5 of its volume and has no tension left, the second keeps the half that it must."""
    cell = pulled(Cell())
    assert cell.vof[:, *AT] == pytest.approx([0.4, 0.25])
    assert cell.q[RHO, :, *AT] == pytest.approx([2.5, 16.0])
    assert cell.opened[2] == pytest.approx(0.1 + 0.25)
    assert not cell.q[SRR].any()
    assert cell.pm[:, *AT] == pytest.approx([0.0, -16.0 / 3.0], abs=1e-12)
    assert (cell.solid[AT], cell.skin[KIND, *AT]) == (pytest.approx(0.65), FREE_SURFACE)


def test_a_cell_that_bears_the_tension_or_is_in_a_contact_stays_closed():
    cell = Cell()
    cell.known["materials"][1, TENSILE] = 10.0  # weighted by volume they bear 8.5
    assert pulled(cell).opened[2] == 0.0
    assert cell.q[SRR, :, *AT].tolist() == [1.0, 1.0]
    assert not pulled(cell, smallest=True).q[SRR].any()
    cell = Cell()
    cell.skin[KIND, *AT] = INTERFACE
    assert pulled(cell).q[SRR, :, *AT].tolist() == [1.0, 1.0]
    cell = Cell()
    cell.known["materials"][0, TENSILE], cell.q[DMG, 0, *AT] = 1e9, 2.0  # failed material bears none
    assert not pulled(cell).q[SRR].any()


# -------------------------------------------------------------------------------------------------------- strength


def test_deviators_work_by_their_share():
    """s : D of s_rr = 4 Pa, s_rz = 3 Pa at D_rr = 2/s, 2 D_rz = 1/s is 11 W; the part kept across a cut cell adds none."""
    cell = Cell()
    cell.q[[SRR, SRZ], 0, *AT] = 4.0, 3.0
    cell.moving(rr=2.0, rbz=1.0)
    cell.run(mixed_strength.work_of_deviators, dominant=-1)
    assert cell.mix[2, HEAT] == pytest.approx([0.5 * 0.1 * 11.0, 0.0])
    cell.mix[2, NORMAL, 0] = 1.5
    cell.solid[AT] = 0.5
    cell.run(mixed_strength.work_of_deviators, dominant=-1, strength_mode=SOLID)
    assert cell.mix[2, HEAT] == pytest.approx([0.1 * (11.0 - 1.5 * 2.0), 0.0])
    cell.mix[2, NORMAL], cell.solid[AT] = 0.0, 0.9
    cell.run(mixed_strength.work_of_deviators, dominant=0)
    assert cell.mix[2, HEAT] == pytest.approx([0.9 * 0.1 * 11.0, 0.0])
    cell.run(mixed_strength.work_of_deviators, dominant=1)
    assert cell.mix[2, HEAT].tolist() == [0.0, 0.0]


@pytest.mark.parametrize(("mode", "total", "flow"), [(VOLUME, 1.0, 4.5), (SOLID, 0.9, 5.0), (MAX, 1.0, 6.0), (ZERO, 1.0, 0.0),
                                                     (MATERIAL, 1.0, 4.5)])
def test_the_elastic_trial_and_the_yield_stress_of_a_cell(mode, total, flow):
    """2 G times the deviator of a strain of 0.3 along r: (2, -1, -1) Pa, and 2 G times half of 0.4 of shear."""
    cell = Cell(strong=True)
    cell.q[SRR, 0, *AT] = 1.0
    cell.moving(rr=3.0, rbz=4.0, zbr=4.0)
    cell.solid[AT] = total
    assert cell.run(mixed_strength.strain_deviators, strength_mode=mode) == pytest.approx(flow)
    trial = cell.mix[2, [TRIAL_RR, TRIAL_ZZ, TRIAL_RZ, MODULUS, YIELD]]
    assert trial.T == pytest.approx(np.array([[3, -1, 4, 5, 3], [2, -1, 4, 5, 6]]))
    assert cell.mix[2, SIZE] == pytest.approx([2 * (9 + 1 - 3 + 16), 2 * (4 + 1 - 2 + 16)])


def test_gas_has_no_part_in_the_yield_stress_of_a_cell():
    cell = Cell()
    assert cell.run(cut_cells.firm_share) == 1.0
    assert cell.run(cut_cells.firm_density) == 0.5 * 2.0 + 0.5 * 8.0
    cell.known["gases"][1] = True
    assert cell.run(cut_cells.firm_share) == 0.5
    assert cell.run(cut_cells.firm_density) == 0.5 * 2.0
    cell.known["gases"][0] = True
    assert cell.run(cut_cells.firm_share) == 1.0


def test_bodies_are_strained_across_by_what_their_traction_needs():
    """The strain across the surface from `traction_of_change` is added to the trial: 2 G (n n - 1/3) times the strain."""
    cell = Cell(strong=True)
    cell.skin[[NORMAL_R, KIND], *AT], cell.bulk[AT] = (1.0, INTERFACE), 1.6
    cell.mix[2, MODULUS], cell.mix[2, YIELD], cell.q[SRR, 0, *AT] = 5.0, (3.0, 0.0), 4.0
    cell.run(mixed_strength.strain_bodies_across, own=True, cell_yield=9.0, change=-0.01)
    assert cell.mix[2, FLOW] == pytest.approx([np.sqrt(3.0) * 4.0, 0.0])  # it flows at its own deviator
    assert cell.mix[2, ACROSS].any()
    for trial, share in ((TRIAL_RR, 2 / 3), (TRIAL_ZZ, -1 / 3), (TRIAL_RZ, 0.0)):
        assert cell.mix[2, trial] == pytest.approx(10.0 * share * cell.mix[2, ACROSS])
    cell.run(mixed_strength.strain_bodies_across, own=False, cell_yield=9.0, change=-0.01)
    assert cell.mix[2, FLOW] == pytest.approx([9.0, 9.0])


def returned(own: bool, dominant: int = -1) -> Cell:
    """From trials of (4, -2, -2) Pa, whose von Mises stress is 6 Pa; G = 5 Pa, Y = 3 and 6 Pa."""
    cell = Cell(strong=True)
    cell.mix[2, TRIAL_RR], cell.mix[2, TRIAL_ZZ], cell.mix[2, MODULUS], cell.mix[2, YIELD] = 4.0, -2.0, 5.0, (3.0, 6.0)
    cell.run(mixed_strength.return_deviators, own=own, cell_yield=1.5, dominant=dominant)
    return cell


def test_the_plastic_heat_of_the_dominant_body_is_shared_by_fraction_over_yield_stress():
    """0.2 * 3 J, of which a share of (0.5/3) / (0.5/3 + 0.5/6) = 2/3 stays."""
    assert returned(own=True, dominant=0).mix[2, HEAT] == pytest.approx([-0.2, 0.2])
    cell = Cell(strong=True)
    cell.mix[2, YIELD], cell.mix[2, HEAT] = (3.0, 0.0), (1.0, 1.0)
    cell.run(mixed_strength.share_plastic_heat, dominant=0, plastic=0.6)
    assert cell.mix[2, HEAT] == pytest.approx([1.0, 1.0])  # a body without strength gets none
    cell.mix[2, YIELD] = 3.0, 1.0
    cell.run(mixed_strength.share_plastic_heat, dominant=0, plastic=0.6)
    assert cell.mix[2, HEAT] == pytest.approx([1.0 - 0.45, 1.0 + 0.45])
