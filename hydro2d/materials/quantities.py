"""THE table of written and drawn quantities: name in files, unit, meaning. `output/derived_quantities.py` computes them.

Names never change. All are cell values without ghosts, in SI units.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from eos.registry import BESIDE, MODULES
from hydro2d.base.errors import Error, unknown
from hydro2d.mesh.fields import Field
from strength.registry import STRENGTH_MODULES


class FieldError(Error):
    """An unknown field; the message is for the user."""


@dataclass(frozen=True)
class Quantity:
    """A row of the table. `title` contains {body} if the quantity is one of every body; one of `contact` is written only
    if there are two body groups, an `internal` one only for bodies whose model has the variable, and a `recorded` one only
    if the deck's `failure.record` asks for it."""

    key: str
    title: str
    unit: str
    meaning: str
    contact: bool = False
    internal: bool = False
    recorded: bool = False

    @property
    def per_body(self) -> bool:
        return "{body}" in self.title

    def name(self, body: str | None = None) -> str:
        """Name in files, with the unit: "Pressure [Pa]"; a number without unit has none."""
        title = self.title.format(body=body) if self.per_body else self.title
        return f"{title} [{self.unit}]" if self.unit else title


def _internal(field: Field) -> Quantity:
    """The row of an internal variable of a model: back_stress_rr is "Back Stress rr of ..."."""
    words = [word if len(word) < 3 else word.capitalize() for word in field.name.split("_")]
    return Quantity(field.name, f"{' '.join(words)} of {{body}}", unit(field), field.meaning, internal=True)


def from_name(name: str, bodies: Iterable[str]) -> Iterator[Quantity]:
    """The internal variable of a body that has this name in a file, if its model is not known here.

    The key is the name of the field, recovered from the title that `_internal` made, if that has no capital letters.
    """
    title, _, unit = name.removesuffix("]").partition(" [")
    for body in sorted(bodies, key=len, reverse=True):
        if title.endswith(f" of {body}"):
            title = title.removesuffix(f" of {body}")
            key = "_".join(word if len(word) < 3 else word.lower() for word in title.split(" "))
            yield Quantity(key, f"{title} of {{body}}", unit, "a variable of the model", internal=True)
            return


def unit(field: Field) -> str:
    """The unit of a field as files show it: none for a number without unit."""
    return "" if field.unit == "1" else field.unit


#: the internal variables that models declare, each name once
INTERNAL = {field.name: _internal(field) for module in (*STRENGTH_MODULES, *MODULES, *BESIDE)
            for field in getattr(module, "INTERNAL", ()) if field.written}

#: the values of `failed_by`
FAILED_BY = ("0 nothing, 1 tension, 2 plastic strain (Johnson-Cook damage with D1 alone), 3 Johnson-Cook damage, 4 cracks "
             "(Cochran-Banner), 5 another damage model")

TABLE: tuple[Quantity, ...] = (
    Quantity("pressure", "Pressure", "Pa", "sum of volume fraction times pressure; positive in compression"),
    Quantity("density", "Density", "kg/m3", "mass of all bodies per volume of the cell"),
    Quantity("velocity", "Velocity", "m/s",
             "mean of the four vertices, as the vector (r, z, 0); mean by mass of both velocities of a contact"),
    Quantity("energy", "Specific Internal Energy", "J/kg", "mean by mass over the bodies"),
    Quantity("temperature", "Temperature", "K", "mean by mass over the bodies"),
    Quantity("von_mises", "Von Mises Stress", "Pa", "sqrt(3/2 s:s) of the stress deviator of the cell"),
    Quantity("deviator_rr", "Deviatoric Stress rr", "Pa", "sum of volume fraction times deviator, radial"),
    Quantity("deviator_zz", "Deviatoric Stress zz", "Pa", "sum of volume fraction times deviator, axial"),
    Quantity("deviator_rz", "Deviatoric Stress rz", "Pa", "sum of volume fraction times deviator, shear"),
    Quantity("deviator_tt", "Deviatoric Stress tt", "Pa", "sum of volume fraction times deviator, hoop: minus rr and zz"),
    Quantity("stress_rr", "Stress rr", "Pa", "total radial stress, tension positive: deviator minus pressure"),
    Quantity("stress_zz", "Stress zz", "Pa", "total axial stress, tension positive: deviator minus pressure"),
    Quantity("stress_tt", "Stress tt", "Pa", "total hoop stress, tension positive: deviator minus pressure"),
    Quantity("stress_rz", "Stress rz", "Pa", "shear stress"),
    Quantity("plastic_strain", "Plastic Strain", "", "equivalent plastic strain, mean by mass over the bodies"),
    Quantity("damage", "Damage", "", "0 intact, 1 failed; mean by mass over the bodies"),
    Quantity("failed_by", "Cause of Failure", "",
             f"what has ended the strength of the body that fills most of the cell; {FAILED_BY}", recorded=True),
    Quantity("material", "Material", "", "number of the body, from 1, that fills most of the cell; 0: void"),
    Quantity("velocity_hard", "Velocity of Hard Bodies", "m/s",
             "that of the hard bodies in a contact, as the vector (r, z, 0)", contact=True),
    Quantity("velocity_soft", "Velocity of Soft Bodies", "m/s",
             "that of the other bodies in a contact, as the vector (r, z, 0)", contact=True),
    Quantity("hard_share", "Share of Hard Bodies", "",
             "share of the cell that the hard bodies of a contact fill", contact=True),
    Quantity("contact_pressure", "Contact Pressure", "Pa",
             "normal pressure at the interface of a contact, in its cells", contact=True),
    Quantity("volume_fraction", "Volume Fraction for {body}", "", "share of the cell that the body fills"),
    Quantity("centroid_r", "Centroid Offset r for {body}", "m",
             "offset of the body's centroid from that of the cell along r, in cells that it fills in part"),
    Quantity("centroid_z", "Centroid Offset z for {body}", "m",
             "offset of the body's centroid from that of the cell along z, in cells that it fills in part"),
    Quantity("body_density", "Density of {body}", "kg/m3", "mass per volume of the body itself"),
    Quantity("body_pressure", "Pressure of {body}", "Pa", "pressure in the body"),
    Quantity("body_energy", "Specific Internal Energy of {body}", "J/kg", "specific internal energy of the body"),
    Quantity("body_temperature", "Temperature of {body}", "K", "temperature of the body"),
    Quantity("body_plastic_strain", "Plastic Strain of {body}", "", "equivalent plastic strain of the body"),
    Quantity("body_damage", "Damage of {body}", "", "0 intact, 1 failed"),
    Quantity("body_failed_by", "Cause of Failure of {body}", "", f"what has ended the strength of the body; {FAILED_BY}",
             recorded=True),
    *INTERNAL.values(),
)

#: keys of older versions, and their present names
RENAMED = {"velocity_rest": "velocity_soft"}

#: names of the deviators up to version 0.3; except for the shear these now stand for total stresses
DEVIATORS = {f"stress_{part}": f"deviator_{part}" for part in ("rr", "zz", "tt", "rz")}

BY_KEY = {quantity.key: quantity for quantity in TABLE}

#: always written: without them a file shows neither bodies nor anything narrower than a cell
ALWAYS = ("volume_fraction", "centroid_r", "centroid_z", "material")

#: the total stress, which follows from the standard fields
WHOLE_STRESS = ("stress_rr", "stress_zz", "stress_tt", "stress_rz")

#: words that stand for several quantities
GROUPS = {
    "all": tuple(BY_KEY),
    "standard": tuple(key for key in BY_KEY
                      if key not in ("body_pressure", "body_energy", "body_damage", "body_failed_by",
                                     *WHOLE_STRESS, *INTERNAL)),
}


def declare(fields: Iterable[Field]) -> None:
    """Adds internal variables of a model from outside to the table; a name that is there already keeps its row."""
    global TABLE
    for field in fields:
        if field.written and field.name not in BY_KEY:
            INTERNAL[field.name] = BY_KEY[field.name] = _internal(field)
    TABLE = tuple(BY_KEY.values())
    GROUPS["all"] = tuple(BY_KEY)


def not_written(*keys: str) -> str:
    """Advice on quantities that a file does not have."""
    said = ["output.fields of the deck sets which fields are written"]
    said += [f"up to version 0.3, {key} was the name of {DEVIATORS[key]}" for key in keys if key in DEVIATORS]
    return "; ".join(said)


def expand(keys) -> tuple[str, ...]:
    """Keys of TABLE for keys and words of GROUPS, with ALWAYS, each once. Raises FieldError for an unknown one."""
    expanded: list[str] = []
    for key in keys:
        if key not in GROUPS and key not in BY_KEY:
            now = RENAMED.get(key)
            raise FieldError(f"{key} is now called {now}" if now else unknown("field", key, (*GROUPS, *BY_KEY)))
        expanded += GROUPS[key] if key in GROUPS else [key]
    return tuple(dict.fromkeys((*expanded, *ALWAYS)))
