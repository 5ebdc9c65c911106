"""A mesh that does not fit in memory is refused before any is allocated."""

from types import SimpleNamespace

import numpy as np
import psutil
import pytest

from hydro2d.base.errors import DeckError
from hydro2d.deck import deck
from hydro2d.mesh.fields import Field
from hydro2d.mesh.grid import Grid
from hydro2d.mesh.state import State, bytes_needed
from hydro2d.running import check
from hydro2d.solver import memory_needed
from hydro2d.solver.simulation import Simulation
from tests.measure.test_sanity import TEXT


@pytest.mark.parametrize("groups", [1, 2])
@pytest.mark.parametrize("internal", [0, 3])
def test_the_estimated_memory_is_that_used(groups, internal):
    own = tuple(Field(f"x{k}", "", "body", "1", 1, "mass", True, "a number") for k in range(internal))
    grid = Grid(np.linspace(0.0, 1.0, 8), np.linspace(0.0, 1.0, 70))
    state = State(grid, 2, [0, groups - 1], [(), own], remembers=internal > 0)
    arrays = [array for name, array in vars(state).items()
              if isinstance(array, np.ndarray) and name not in ("group", "rules", "initial")]
    used = sum(array.nbytes for array in arrays if array.base is None)
    assert bytes_needed(*grid.shape, 2, groups, internal, internal > 0) == used


LARGE = ['mesh.r=[{to="2 mm", cells=400000}]', 'mesh.z=[{to="20 mm", cells=400000}]']


@pytest.mark.parametrize("begin", [check.check, Simulation])
def test_a_mesh_beyond_the_machine(begin):
    with pytest.raises(DeckError, match=r"mesh: 400000 x 400000 cells need about .* GiB of memory; this machine has"):
        begin(deck.loads(TEXT, LARGE))


def test_a_mesh_that_fills_most_of_the_memory_is_none_of_its_business(monkeypatch):
    small = deck.loads(TEXT)
    there = SimpleNamespace(total=2 * memory_needed.needed(small))
    monkeypatch.setattr(psutil, "virtual_memory", lambda: there)
    memory_needed.refuse_too_large(small)
    there.total //= 2
    with pytest.raises(DeckError):
        memory_needed.refuse_too_large(small)


@pytest.mark.parametrize("segment", ['{to="20 mm", size="1e-15 m"}', '{to="20 mm", first="1e-15 m", ratio=1.0}'])
def test_cells_beyond_counting(segment):
    with pytest.raises(DeckError, match=r"mesh.z\[0\]: would need 2e\+13 cells"):
        deck.loads(TEXT, [f"mesh.z=[{segment}]"])
