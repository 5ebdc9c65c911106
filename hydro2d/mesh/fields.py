"""THE field table: every field's name, centring, unit, parity, bounds, how it is remapped, and whether it is written.

The fields of the bodies that the remap carries are in the block ``State.q[k, m, j, i]`` in the order of the table; their
integer constants are their positions there. From row ``INTERNAL`` on come the internal variables of the body's strength
model and then those of its equation of state, which the models declare as fields of their own. Remap, ghost cells and state
follow from the table.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf

import numpy as np

RHO, E, SRR, SZZ, SRZ, EP, DMG = range(7)

#: the stored damage of failed material: as far above 1 as sound material is below it. A cell in which the remap has mixed both
#: then counts as failed, from 1 on, if about half of its mass has failed
FAILED = 2.0
#: damage of crushed material, which keeps a strength under pressure: just below that of failed material
CRUSHED = 1.0 - 1e-9

#: values of `FAILURE_RECORD` where tension and where its damage model has broken all of a body
BY_TENSION, BY_DAMAGE = 1.0, -1.0

#: number of cells whose return to the yield surface is solved together, and of numbers for each (strength/lanes.py)
LANES, LANE_ROWS = 32, 17


@dataclass(frozen=True)
class Field:
    """One line of the field table.

    ``centring`` is "body" ([m, j, i]), "cell" ([j, i]) or "vertex" ([b, j, i]); ``parity`` the sign in a mirror; ``remap``
    its carrier: "volume", "mass", "momentum" or "" (derived, never remapped); ``least`` and ``most`` are the bounds within
    which the remap keeps it; ``bodies`` the bodies that carry it, "all", those with "strength" or those with "damage" (a field
    that a model declares is carried by the bodies of the model); ``initial`` its value in virgin material, a number or a
    function of the row of the model that declares it: in bodies at the start, and in material ahead of a travelling mesh.
    """

    name: str
    symbol: str
    centring: str
    unit: str
    parity: int
    remap: str
    written: bool
    meaning: str
    least: float = -inf
    most: float = inf
    bodies: str = "all"
    initial: float | Callable[[np.ndarray], float] = 0.0

    def at_rest(self, par: np.ndarray) -> float:
        """Its value in virgin material; par : the row of the material's model."""
        return self.initial(par) if callable(self.initial) else self.initial


FIELDS = (
    Field("volume_fraction", "vof", "body", "1", 1, "volume", True, "share of the cell that the body fills"),
    Field("density", "rho", "body", "kg/m^3", 1, "volume", True, "density of the body's material in the cell"),
    Field("energy", "e", "body", "J/kg", 1, "mass", True, "specific internal energy"),
    Field("deviator_rr", "srr", "body", "Pa", 1, "volume", True, "radial deviatoric stress", bodies="strength"),
    Field("deviator_zz", "szz", "body", "Pa", 1, "volume", True, "axial deviatoric stress", bodies="strength"),
    Field("deviator_rz", "srz", "body", "Pa", -1, "volume", True, "shear stress", bodies="strength"),
    Field("plastic_strain", "ep", "body", "1", 1, "mass", True, "equivalent plastic strain", 0.0, bodies="strength"),
    Field("damage", "dmg", "body", "1", 1, "mass", True, "damage; failed from 1 on", 0.0, FAILED, bodies="damage"),
    Field("centroid_r", "centroid_r", "body", "1", -1, "", False,
          "offset of the body's centroid from the middle of the cell along r^2/2 (planar: r), in cells"),
    Field("centroid_z", "centroid_z", "body", "1", 1, "", False, "offset of the body's centroid along z, in cells"),
    Field("body_pressure", "pm", "body", "Pa", 1, "", True, "pressure of the body's material"),
    Field("bulk_modulus", "km", "body", "Pa", 1, "", False, "adiabatic bulk modulus rho c^2"),
    Field("temperature", "tm", "body", "K", 1, "", True, "temperature"),
    Field("pressure", "p", "cell", "Pa", 1, "", True, "pressure of the cell; that of void is zero"),
    Field("half_step_pressure", "ph", "cell", "Pa", 1, "", False, "pressure at half the step"),
    Field("cell_bulk_modulus", "bulk", "cell", "Pa", 1, "", False, "bulk modulus of the cell, 0 where it has void"),
    Field("cell_density", "rhobar", "cell", "kg/m^3", 1, "", False, "mass of all bodies per volume of the cell"),
    Field("filled_fraction", "solid", "cell", "1", 1, "", False, "share of the cell that is not void"),
    Field("longitudinal_sound_speed", "cl", "cell", "m/s", 1, "", False, "largest of the bodies' longitudinal sound speeds"),
    Field("viscosity_r", "qr", "cell", "Pa", 1, "", False, "artificial viscosity against radial compression"),
    Field("viscosity_z", "qz", "cell", "Pa", 1, "", False, "artificial viscosity against axial compression"),
    Field("viscosity_tt", "qt", "cell", "Pa", 1, "", False, "artificial viscosity against hoop compression"),
    Field("viscosity_rz", "qrz", "cell", "Pa", -1, "", False, "shear component of the artificial viscosity"),
    Field("total_stress_rr", "sig_rr", "cell", "Pa", 1, "", False, "radial stress at half the step, viscosity included"),
    Field("total_stress_zz", "sig_zz", "cell", "Pa", 1, "", False, "axial stress at half the step, viscosity included"),
    Field("total_stress_tt", "sig_tt", "cell", "Pa", 1, "", False, "hoop stress at half the step, viscosity included"),
    Field("total_stress_rz", "sig_rz", "cell", "Pa", -1, "", False, "shear stress at half the step"),
    Field("pre_sweep_volume", "pre_sweep_volume", "cell", "m^3", 1, "", False, "volume before a sweep of the remap"),
    Field("hourglass_coefficient", "hg_coefficient", "cell", "kg/s", 1, "", False, "coefficient of the hourglass filter"),
    Field("hard_fraction", "hard", "cell", "1", 1, "", False, "share of the cell that hard bodies fill"),
    Field("hard_distance", "distance", "cell", "m", 1, "", False, "distance from the hard bodies of a slip layer"),
    Field("contact_pressure", "contact_pressure", "cell", "Pa", 1, "", True, "normal pressure at the interface of a contact"),
    Field("radial_velocity", "u", "vertex", "m/s", -1, "momentum", True, "radial velocity"),
    Field("axial_velocity", "v", "vertex", "m/s", 1, "momentum", True, "axial velocity"),
    Field("radial_velocity_before", "u0", "vertex", "m/s", -1, "", False, "radial velocity at the beginning of the step"),
    Field("axial_velocity_before", "v0", "vertex", "m/s", 1, "", False, "axial velocity at the beginning of the step"),
    Field("vertex_mass", "mass", "vertex", "kg", 1, "mass", False, "mass of the dual cell, per radian"),
)


#: the rows of State.q that every body has
BODY = tuple(field for field in FIELDS if field.centring == "body" and field.remap and field.name != "volume_fraction")

#: the row of State.q in which the internal variables of a body begin: of its strength model, then of its equation of state
INTERNAL = len(BODY)

#: a row of State.q between these, of bodies that can fail, if the deck writes `failed_by`; `hydro2d.materials.rows.RECORD`
FAILURE_RECORD = Field("failure_record", "", "body", "1", 1, "mass", False,
                       "share of the body's mass that tension has broken, minus that which damage has", BY_DAMAGE, BY_TENSION)

#: rows of `far`: radial and axial velocity, m/s, and pressure, Pa, of a body beyond an edge, and 1 if the edge cuts it, else 0
FAR_U, FAR_V, FAR_P, CUT = range(4)

#: columns of `remap_rules`: 1 for fields carried per mass, 0 per volume; the bounds; the sign in a mirror
PER_MASS, LEAST, MOST, PARITY = range(4)


def remap_rules(internal: Sequence[Sequence[Field]]) -> np.ndarray:
    """How every row of State.q of every body is remapped and mirrored, float64[m, k, 4] with the columns PER_MASS to PARITY.

    ``internal`` contains the internal variables of every body; a body that has fewer than another has empty rows at the end.
    """
    rows = INTERNAL + max((len(own) for own in internal), default=0)
    rules = np.zeros((len(internal), rows, 4))
    rules[..., LEAST], rules[..., MOST], rules[..., PARITY] = -inf, inf, 1
    for m, own in enumerate(internal):
        for k, field in enumerate((*BODY, *own)):
            rules[m, k] = field.remap == "mass", field.least, field.most, field.parity
    return rules


def carried(own: Sequence[Field], strength: bool, damage: bool) -> list[int]:
    """The rows of State.q that the remap carries in addition to the density, of a body with internal variables ``own``."""
    kinds = {"all", *(["strength"] if strength else []), *(["damage"] if damage else [])}
    return [*(k for k, field in enumerate(BODY) if field.bodies in kinds and k != RHO), *range(INTERNAL, INTERNAL + len(own))]


def carried_rows(bodies: Sequence[Sequence[int]]) -> np.ndarray:
    """`carried` of every body as kernels read it, int64[m, n]: their number, then the rows; zeros at the end."""
    rows = np.zeros((len(bodies), 1 + max(len(own) for own in bodies)), dtype=np.int64)
    for row, own in zip(rows, bodies, strict=True):
        row[0] = len(own)
        row[1:1 + len(own)] = own
    return rows


@dataclass(frozen=True)
class Work:
    """An array through which the kernels of a cycle pass values to one another.

    ``axes`` are letters for the lengths of its axes: m bodies, b body groups, j and i cells with ghosts, J and I vertices, k
    rows of State.q, n internal variables, B parts of the rows, L vertices along the longer direction, G words of a gate; 6B is
    six for every part.
    """

    symbol: str
    axes: str
    meaning: str
    kind: type = float


WORK = (
    Work("cell_mass", "b j i", "mass of a group in a cell"),
    Work("fr", "J I", "volume that a face along r sweeps; face i is left of cell i"),
    Work("fz", "J I", "volume that a face along z sweeps; face j is below cell j"),
    Work("flux_volume", "m J I", "volume of a body that goes through a face"),
    Work("flux_place", "2 m J I", "place of a body in the strip that a face sweeps, if it does not fill it"),
    Work("flux_mass", "b J I", "mass of a group that goes through a face"),
    Work("flux", "k m 6B I", "quantities that a body carries through the faces of a few rows"),
    Work("dual", "6 2B I", "quantities carried by a group's momentum through the dual faces of a few rows"),
    Work("edge_flux", "2 2 m L", "mass and energy of a body through either edge of a sweep"),
    Work("edge_dual", "b 2 5 L", "mass, momentum and kinetic energy of a group through either edge of a sweep"),
    Work("outflow", "2 2 1+m", "through either edge of a sweep, out and in: energy, and mass of every body"),
    Work("kinetic_outflow", "2 2 2", "through either edge of a sweep, out and in: axial momentum and kinetic energy"),
    Work("deficit", "b J I", "kinetic energy that `both` takes from a vertex"),
    Work("lanes", f"B {LANE_ROWS * LANES}", "cells of a row that may yield, a few at a time, while they return"),
    Work("scratch", "4 B I", "temporary rows of a phase"),
    Work("body_ranges", "3 m j 2", "columns of a body, of the cells that a sweep along z can change, and of the faces", int),
    Work("group_ranges", "b 4 j 2", "active range of columns of a group, within 0, 1, 2 and 3 rows", int),
    Work("occupied", "b j 2", "columns that contain any material of a group", int),
    Work("mixed_count", "j", "number of cells in a row that are not full of one body", int),
    Work("mixed", "j i", "their columns", int),
    Work("skin", "3 j i", "normal of the surface that cuts a cell, its square the weight; kind of cut cell"),
    Work("borne", "j i", "pressure half-way into what of a body lies in a cell with void, borne by the cells inward, Pa"),
    Work("held", "J I", "share of the mass of a vertex that is held"),
    Work("mix", "j 17 m", "data of each body in a mixed cell while it deforms"),
    Work("filter_r", "b j i", "force of the hourglass filter on the radial velocities of a cell, N per radian"),
    Work("filter_z", "b j i", "the same along z"),
    Work("motion", "j b 10", "velocity gradient of a group in a mixed cell"),
    Work("internal", "j n", "internal variables of a body in a cell while it deforms"),
    Work("strips", "j 3 4 m", "each body in the strips that two faces of a mixed cell sweep, and in all of it"),
    Work("contact_columns", "j 2", "columns of the contact-interface cells", int),
    Work("zone", "j i", "zone of a slip layer: 0 none, 1 interior, 2 layer", np.int8),
    Work("normal", "2 j i", "normal of the hard body that a slip layer lies on"),
    Work("opened", "j", "volume of void that opens in a row"),
    Work("bad", "j 4", "cells that are not finite: number, column and body of the first; velocities", int),
    Work("turned", "j 2", "the first cell that a step turned inside out: column, -1 for none, and body", int),
    Work("first_turned", "3", "the first of these cells: row, -1 for none, column, body", int),
    Work("row_step", "j", "time step that a row allows"),
    Work("least_row", "3", "row of the least time step; rows with cells or velocities that are not finite, -1 for none", int),
    Work("cause", "2", "the condition that sets the time step, and its column", int),
    Work("limited", "3 J", "axial momentum and energy that the speed limit takes in a row, number of vertices"),
    Work("limited_sum", "3", "the same in all rows"),
    Work("momentum_sums", "5 J", "in a row: kinetic energy before and after, momentum gained, energy cut, wall's momentum"),
    Work("momentum_sum", "5", "the same in all rows"),
    Work("deposited", "J", "energy that a row of cells receives from its vertices"),
    Work("deposited_sum", "1", "the same in all rows"),
    Work("removed", "4+m J", "removed by tidying a row: energies, momentum, void, mass of every body"),
    Work("removed_sum", "4+m", "the same in all rows"),
    Work("walls", "4 2 J", "axial momentum and energy that each edge with a given velocity takes in a row"),
    Work("walls_sum", "4 2", "the same in all rows"),
    Work("far", "4 4 m L", "beyond each edge that transmits waves: velocities and pressure of every body, 1 if it is cut"),
    Work("drag", "4 b 2 L", "impulses that each edge with a traction takes, along r and along z"),
    Work("taken", "4 2", "axial momentum and energy that each edge with a traction takes"),
    Work("gate", "G", "barrier at which the threads of a phase wait for one another", int),
    Work("row_moving", "J 2", "columns of the moving vertices of a row", int),
    Work("moving", "4", "rows and columns of all moving vertices", int),
)

#: further arrays for the outermost layer of bodies, with one velocity
HOLD_WORK = (
    Work("held_count", "J", "number of vertices in a row that are held by the body inward of them", int),
    Work("held_columns", "J I", "their columns", int),
    Work("anchor_count", "J I", "number of vertices that hold each of them", int),
    Work("anchors", "J I 3 6", "these: rows, columns and weights"),
    Work("hold", "J I 3", "outward normal at a held vertex, distance of its anchors in cells"),
    Work("anchored", "11 J I", "velocity of an anchor before; mass and momentum that it takes over from three sides"),
    Work("sinking", "2 J I", "velocity that a held vertex has to lose, along r and z"),
    Work("held_heat", "J I", "heat of holding a vertex, per mass"),
)

#: further arrays for equations of state with internal variables
MEMORY_WORK = (
    Work("before", "3 m j i", "density, plastic strain and damage before the Lagrangian step"),
)

#: further arrays for the contact of two groups
CONTACT_WORK = (
    Work("contact_node_count", "J", "number of contact nodes in a row, at which both groups have mass", int),
    Work("contact_nodes", "J I", "their columns", int),
    Work("filled", "2 J I", "share of its dual cell that each group fills, at vertices near contact nodes"),
    Work("firmly", "2 J I", "share of its dual cell that each group's bodies other than gases fill, likewise"),
    Work("inward", "J 4 36", "cells around a slave: weight, sum of the squares of each one's shares to its vertices, offset"),
    Work("heated_columns", "J 2", "columns of the vertices that gave heat", int),
    Work("soft", "j i", "share of the cell that the other bodies fill"),
    Work("firm", "2 j i", "share of the cell that the soft and that the hard bodies other than gases fill"),
    Work("rate", "j i", "rate of volume of a contact-interface cell"),
    Work("size", "j i", "volume of a contact-interface cell that is not void"),
    Work("kinds", "j I", "number of bodies in a cell, while mixed cells are listed anew"),
    Work("own_share", "m j i", "share of a body in the volume of its group in a contact-interface cell"),
    Work("line", "10 j i", "lines of both groups in a contact-interface cell"),
    Work("aperture_r", "2 J I", "aperture of a face along r, for the hard group, at either end"),
    Work("aperture_z", "2 J I", "aperture of a face along z, for the hard group, at either end"),
    Work("own_r", "2 J I", "volume that a face along r sweeps with each group's velocity"),
    Work("own_z", "2 J I", "volume that a face along z sweeps with each group's velocity"),
    Work("even_r", "J I", "volume that evens out the pressure along a surface through a face along r"),
    Work("even_z", "J I", "volume that evens out the pressure along a surface through a face along z"),
    Work("inside", "j i", "how far a cell lies inside a hard body"),
    Work("checkerboard", "5 J I", "checkerboards of stress around a vertex, and their weights"),
    Work("room", "j i", "volume that a cell gains to even out its pressure"),
    Work("heat", "2 J I", "heat of the impulses at a vertex, for each group"),
    Work("contact_normal", "3 2 J I", "normal at a contact node"),
    Work("first_slot", "1+J", "slot of the first contact node of a row", int),
    Work("places", "2 J I", "number of a vertex in the list of slaves and masters, 0 between two lists", int),
    Work("touch", "J I", "whether the groups touch at a contact node"),
    Work("transfer", "5 J", "contact transfers in a row: momentum, three heats, wall's momentum"),
    Work("transfer_sum", "5", "the same in all rows"),
)
