"""The materials of a run as rows of numbers, one for each slot m: a body, with all bodies that join it."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType

import numpy as np

from hydro2d.base.errors import DeckError
from hydro2d.materials.cracking import cracking_pressure, opens_cracks, over, require_that_it_fails
from hydro2d.materials.material import Material, Model, solid_model
from hydro2d.mesh.fields import FAILURE_RECORD, INTERNAL, Field

#: a body is a gas compared with the stiffest one if its bulk modulus at rest is below this share of that one's
GAS_MODULUS = 0.01


@dataclass(frozen=True)
class MaterialTable:
    """The numbers of the materials for kernels, one row per slot m (a body, with all bodies that join it).

    ``eos_par`` is float64[m, k] as long as the longest row of the run, at least eos.ROW, ``strength_par`` float64[m,
    strength.ROW], ``damage_par`` float64[m, strength.DAMAGE_ROW]; the model ids are int64[m]; ``internal`` has the internal
    variables of every strength model, a failure record if the deck asks for one and the body can fail, and then those of its
    equation of state, ``initial`` their values in virgin material, ``memory`` the row of State.q in which those of the equation
    of state begin, ``record`` that of the failure record, 0 for none, and ``criterion`` what its damage model breaks it by
    (strength/layout.py), int64[m]; ``records`` says whether the deck asks for it; ``fracture_pressure`` is a positive
    tension, inf for none, ``fracture_stress`` a largest principal stress, inf for none, and ``cracking`` the tension at which
    cracks open, if the damage model opens them, else 0; ``melting`` contains the melting lines that the deck uses,
    float64[m, strength.melting.ROW], NONE for none.
    """

    names: tuple[str, ...]
    materials: tuple[Material, ...]
    rho0: np.ndarray
    e0: np.ndarray
    eos_model: np.ndarray
    eos_par: np.ndarray
    strength_model: np.ndarray
    strength_par: np.ndarray
    internal: tuple[tuple[Field, ...], ...]
    initial: tuple[np.ndarray, ...]
    memory: np.ndarray
    record: np.ndarray
    records: bool
    criterion: np.ndarray
    damage_model: np.ndarray
    damage_par: np.ndarray
    fracture_pressure: np.ndarray
    fracture_stress: np.ndarray
    cracking: np.ndarray
    melting: np.ndarray

    def __len__(self) -> int:
        return len(self.names)

    @property
    def remembers(self) -> bool:
        """Whether an equation of state has internal variables."""
        return any(INTERNAL + len(own) > first for own, first in zip(self.internal, self.memory, strict=True))

    def virgin(self, m: int) -> np.ndarray:
        """The internal variables of the equation of state of body m in virgin material, float64[n]."""
        return self.initial[m][self.memory[m] - INTERNAL:]

    def spent(self, m: int) -> np.ndarray:
        """`virgin` for fully reacted material: the products of an explosive (the model's SPENT), else virgin material."""
        products = getattr(self.materials[m].eos.module("eos"), "SPENT", None)
        return self.virgin(m) if products is None else np.array(products)

    def evaluate(self, m: int, rho: float, e: float) -> tuple[float, float, float, float]:
        """(p, dp/drho, dp/de, T) of virgin material of body m, see `eos.dispatch.evaluate`."""
        from eos.dispatch import evaluate

        return evaluate(self.eos_model[m], rho, e, self.virgin(m), self.eos_par[m])

    def sound_speed_squared(self, m: int, rho: float, e: float, floor: float = 0.0) -> float:
        """Square of the bulk sound speed of virgin material of body m, (m/s)^2, at least `floor`."""
        from eos.dispatch import sound_speed_squared

        p, dpdrho, dpde, _ = self.evaluate(m, rho, e)
        return sound_speed_squared(rho, p, dpdrho, dpde, floor)

    @property
    def shear(self) -> np.ndarray:
        """Shear modulus of every body at rest, Pa, float64[m]; 0 without strength."""
        from strength import SHEAR

        return self.strength_par[:, SHEAR]

    def flow_stress(self, m: int, strain: float, rate: float, temperature: float, pressure: float) -> float:
        """Flow stress of body m at its density at rest, Pa; 0 without strength. rate : 1/s;  temperature : K;  pressure : Pa"""
        from strength.dispatch import flow_stress

        return flow_stress(self.strength_model[m], strain, rate, temperature, pressure, self.rho0[m], self.strength_par[m])

    def limits(self, m: int, rho: float, internal: np.ndarray) -> str:
        """The range of the table of body m and its energies at a density, in words; empty if it has no table.

        internal : internal variables of its equation of state, float64[n]. If that builds on the model of its solid, the
        table is the solid's, and the density of the solid is given as well.
        """
        from eos import cracked, layout

        model = self.materials[m].eos
        if not model.table:
            return ""
        module, par, said = model.module("eos"), self.eos_par[m], ""
        over = cracked if self.eos_model[m] == cracked.ID else module if model.solid else None
        if over:
            rho, par = over.density_of_solid(rho, internal, par), par[layout.SOLID_AT:]
            said = f"its solid has {rho:.6g} kg/m^3; "
        if model.solid:
            module = solid_model(model.solid)[0]
        said += f"{model.table_from} has {module.span(par)}"
        energies = module.energies(rho, par)
        return said + (f"; at {rho:.6g} kg/m^3 energies of {energies[0]:.6g} to {energies[1]:.6g} J/kg" if energies else "")

    def sound_speeds(self, floor: float = 0.0) -> np.ndarray:
        """Bulk sound speed of every material at rest, m/s, float64[m]; floor : least square of it, (m/s)^2."""
        return np.sqrt([self.sound_speed_squared(m, self.rho0[m], self.e0[m], floor) for m in range(len(self))])

    def gases(self) -> np.ndarray:
        """Which bodies are gases, compared with the others, bool[m]: bulk modulus at rest below GAS_MODULUS of the largest."""
        moduli = self.rho0 * self.sound_speeds() ** 2
        return moduli < GAS_MODULUS * moduli.max()


def _row(part: str, module: ModuleType, model: Model, material: Material) -> np.ndarray:
    try:
        return (model.outside(part) or module).row(model.values, *model.base())
    except ValueError as problem:
        raise DeckError(f"material {material.name}: {problem}") from None


def _own(module: ModuleType) -> tuple[Field, ...]:
    return getattr(module, "INTERNAL", ())


def _variables(eos_modules, eos_par, strength_modules, strength_par, recorded) -> dict:
    """Entries of a table on internal variables: of every body's strength model, its failure record, its equation of state.

    recorded : bool for every body
    """
    internal, initial, memory, record = [], [], [], []
    for eos, eos_row, strength, strength_row, noted in zip(
            eos_modules, eos_par, strength_modules, strength_par, recorded, strict=True):
        before = [(field, strength_row) for field in _own(strength)] + [(FAILURE_RECORD, strength_row)] * noted
        own = [*before, *((field, eos_row) for field in _own(eos))]
        internal.append(tuple(field for field, _ in own))
        initial.append(np.array([field.at_rest(row) for field, row in own]))
        memory.append(INTERNAL + len(before))
        record.append(INTERNAL + len(before) - 1 if noted else 0)
    return {"internal": tuple(internal), "initial": tuple(initial), "memory": np.array(memory, dtype=np.int64),
            "record": np.array(record, dtype=np.int64)}


def resolve(deck) -> MaterialTable:
    """Model ids and parameter rows of the deck's slots.

    Raises DeckError for values that a model refuses, and for a model from outside that the kernels were loaded without.
    """
    import eos
    from strength.layout import OTHER

    slots = [body for body in deck.body if body.join is None]
    chosen = [deck.materials[body.material] for body in slots]
    for material in chosen:
        for model in material.from_outside():
            model.require(f"material {material.name}: ")
    eos_modules = [material.eos.module("eos") for material in chosen]
    strength_modules = [material.strength.module("strength") for material in chosen]
    damages = [material.damage if deck.failure.damage == "material" else Model("none") for material in chosen]
    damage_modules = [damage.module("damage") for damage in damages]
    eos_rows = [_row("eos", module, material.eos, material) for module, material in zip(eos_modules, chosen, strict=True)]
    used = deck.failure.tensile == "material"
    tensile = [c.fracture_pressure.value if used and c.fracture_pressure else np.inf for c in chosen]
    most_stress = [c.fracture_stress.value if used and c.fracture_stress else np.inf for c in chosen]
    cracking = np.zeros(len(chosen))
    for m, material in enumerate(chosen):
        if np.isfinite(most_stress[m]):
            require_that_it_fails(material, damage_modules[m], strength_modules[m])
        if opens_cracks(damage_modules[m]):
            cracking[m], tensile[m] = cracking_pressure(material, tensile[m]), np.inf
            eos_modules[m], eos_rows[m] = over(material, eos_rows[m])
    eos_par = np.zeros((len(chosen), max(row.size for row in eos_rows)))
    for row, own in zip(eos_par, eos_rows, strict=True):
        row[: own.size] = own
    strength_par = np.stack([_row("strength", m, c.strength, c) for m, c in zip(strength_modules, chosen, strict=True)])
    damage_par = np.stack([_row("damage", m, d, c) for m, d, c in zip(damage_modules, damages, chosen, strict=True)])
    fails = [bool(tension < np.inf or stress < np.inf or module.ID) for tension, stress, module in
             zip(tensile, most_stress, damage_modules, strict=True)]
    table = MaterialTable(
        names=tuple(body.name for body in slots),
        materials=tuple(chosen),
        rho0=eos_par[:, eos.RHO0].copy(),
        e0=eos_par[:, eos.E0].copy(),
        eos_model=np.array([m.ID for m in eos_modules], dtype=np.int64),
        eos_par=eos_par,
        strength_model=np.array([m.ID for m in strength_modules], dtype=np.int64),
        strength_par=strength_par,
        **_variables(eos_modules, eos_par, strength_modules, strength_par, [deck.failure.record and each for each in fails]),
        records=deck.failure.record,
        criterion=np.array([module.criterion(row) if hasattr(module, "criterion") else OTHER for module, row in
                            zip(damage_modules, damage_par, strict=True)], dtype=np.int64),
        damage_model=np.array([m.ID for m in damage_modules], dtype=np.int64),
        damage_par=damage_par,
        fracture_pressure=np.array(tensile),
        fracture_stress=np.array(most_stress),
        cracking=cracking,
        melting=np.stack([_line_of(material, deck.failure.melting == "material") for material in chosen]),
    )
    for m, module in enumerate(strength_modules):
        if hasattr(module, "check_with"):
            _require_agreement(table, m, module)
    return table


def _line_of(material: Material, used: bool) -> np.ndarray:
    """The melting line of a material as kernels read it; NONE if it has none or the deck does not use it."""
    from strength import melting

    if not (used and material.melting):
        return np.array(melting.NONE)
    try:
        return melting.row({name: number.value for name, number in material.melting.items()})
    except ValueError as problem:
        raise DeckError(f"material {material.name}: {problem}") from None


def _require_agreement(table: MaterialTable, m: int, strength: ModuleType) -> None:
    """Raises DeckError if the strength model of body m and its equation of state contradict each other."""
    material, rest = table.materials[m], table.rho0[m]
    try:
        strength.check_with(material.strength.values, lambda mu: table.evaluate(m, rest * (1.0 + mu), 0.0)[0])
    except ValueError as problem:
        raise DeckError(f"material {material.name}: {problem}") from None
