"""Every analytic model by its name. A new model needs a file and an entry in ``MODULES``."""

from __future__ import annotations

from types import ModuleType

from hydro2d.penetration import (
    anderson_riegel,
    cavity,
    chen_li,
    christman_gehring,
    forrestal,
    hydrodynamic,
    lambert_jonas,
    luk_piekutowski,
    poncelet,
    ravid_bodner,
    recht_ipson,
    rigid_axial,
    rigid_body,
    secondary_penetration,
    target_resistance,
    tate,
    tate_poncelet,
    walker_anderson,
    walker_anderson_finite,
)
from hydro2d.penetration.model import Model

#: those of the review by Anderson (2017), in its order, then the others
MODULES: tuple[ModuleType, ...] = (
    poncelet,
    hydrodynamic,
    christman_gehring,
    recht_ipson,
    lambert_jonas,
    tate,
    tate_poncelet,
    secondary_penetration,
    target_resistance,
    cavity,
    forrestal,
    chen_li,
    walker_anderson,
    walker_anderson_finite,
    ravid_bodner,
    anderson_riegel,
    luk_piekutowski,
    rigid_axial,
    rigid_body,
)


def of(module: ModuleType) -> tuple[Model, ...]:
    """The models of a module: its ``MODELS``, or its one ``MODEL``."""
    return tuple(getattr(module, "MODELS", ())) or (module.MODEL,)


MODELS: dict[str, Model] = {model.name: model for module in MODULES for model in of(module)}
