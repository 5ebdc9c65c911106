"""The shapes of bodies. A new one is a file in this folder and a line in ``KINDS``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from hydro2d.base.keys import one_of
from hydro2d.deck.shapes.body import Body
from hydro2d.deck.shapes.box import Box
from hydro2d.deck.shapes.plate import Plate
from hydro2d.deck.shapes.polygon import Polygon
from hydro2d.deck.shapes.rod import Rod
from hydro2d.deck.shapes.sphere import Sphere

KINDS: dict[str, type[Body]] = {"rod": Rod, "plate": Plate, "box": Box, "sphere": Sphere, "polygon": Polygon}

AnyBody: Any = Body if TYPE_CHECKING else one_of(KINDS, "shape")
