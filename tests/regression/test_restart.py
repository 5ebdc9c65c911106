"""An interrupted run of the real solver continues to the same bits, and outputs change none of them."""


import pytest

from hydro2d.deck import deck as decks
from hydro2d.output import history
from hydro2d.running.run import run
from hydro2d.solver.simulation import Simulation
from tests.decks import entry, mesh, plate, rod, stop, table
from tests.restarts import final, restarted

SHOT = (
    mesh(("12 mm", 12), ("-25 mm", "30 mm", "1 mm"))
    + rod("4 mm", "20 mm", tip="-0.5 mm", velocity="1000 m/s")
    + plate("25 mm")
    + entry("tracer", name="nose", r=0.0, z="-0.5 mm")
    + stop("50 us", cycles=160)
    + table("output", history_interval="0.1 us", vtk_interval="0.5 us")
)
SLIP = ['sliding.method="slip-layer"', 'sliding.hard=["rod"]', "sliding.yield_factor=1.0"]


#: a rod that the mesh follows through three plates, spaced so that it is alone in between
PLATES = (
    mesh(("12 mm", 12), ("-25 mm", "4 mm", "1 mm"), follow="rod")
    + rod("4 mm", "16 mm", tip="-0.5 mm", velocity="1500 m/s")
    + stop("1 s")
    + table("output", history_interval="1 us", vtk_interval="1 us")
    + "".join(plate("2 mm", name=f"plate {number}", z_front=f"{9 * number} mm") for number in range(3))
)
CONTACT = ['sliding.method="contact"', 'sliding.hard=["rod"]']


@pytest.mark.thorough
@pytest.mark.parametrize("options", [[], SLIP], ids=["sticking", "slip-layer"])
@pytest.mark.parametrize("cycles", [1, 60, 159])
def test_restart_gives_the_same_bits(tmp_path, options, cycles):
    whole, parts = tmp_path / "whole", tmp_path / "parts"
    deck = decks.loads(SHOT, options)
    run(deck, whole, quiet=True)
    assert run(decks.loads(SHOT, [*options, f"stop.cycles={cycles}"]), parts, quiet=True)["cycles"] == cycles
    run(deck, parts, restart=True, quiet=True)
    assert final(whole) == final(parts)
    one, two = (history.read(directory / "history.h5") for directory in (whole, parts))
    assert {name: column.tobytes() for name, column in one.items()} == {n: c.tobytes() for n, c in two.items()}
    for file in (whole / "vtk").iterdir():
        assert file.read_bytes() == (parts / "vtk" / file.name).read_bytes()


@pytest.mark.thorough
def test_outputs_change_no_bit(tmp_path):
    often = [f"output.{key}" for key in ("history_interval=1e-9", "vtk_interval=1e-7", "restart_interval=1e-9")]
    run(decks.loads(SHOT, ["stop.cycles=60"]), tmp_path / "rarely", quiet=True)
    run(decks.loads(SHOT, ["stop.cycles=60", *often]), tmp_path / "often", quiet=True)
    assert final(tmp_path / "rarely") == final(tmp_path / "often")


@pytest.mark.thorough
@pytest.mark.parametrize("options", [[], SLIP, CONTACT], ids=["sticking", "slip-layer", "contact"])
def test_a_restart_on_a_travelling_mesh_gives_every_bit_of_every_array(options):
    """Ghosts and vertices without mass included, in every cycle, wherever the rod is when the run continues."""
    whole = Simulation(decks.loads(PLATES, options))
    parts, last = [], whole.deck.body[-1].z_front + 9e-3
    while whole.grid.z_edges[-1] < last:
        if whole.cycle % 50 == 1:
            parts = [*parts[-1:], restarted(whole)]
        for each in (whole, *parts):
            each.step()
        for part in parts:
            assert part.restart_scalars() == whole.restart_scalars()
            for name, array in part.restart_arrays().items():
                assert array.tobytes() == whole.restart_arrays()[name].tobytes(), f"{name} in cycle {whole.cycle}"
