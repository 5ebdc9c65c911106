"""What a server of forks has loaded: the commands, with a made-up simulation in place of the solver and its kernels."""

import contextlib
import io
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

import numba

from hydro2d.cli.main import call
from hydro2d.jit import compilation
from hydro2d.running import compile_all
from hydro2d.study.run import case, cluster, sweep
from tests import fake
from tests.jit import test_store
from tests.study.made_up import regime
from tests.trials import forks


class Simulation(fake.Simulation):
    """Its rod deforms from 1100 m/s on and goes deeper the faster it is."""

    def diagnostics(self) -> dict:
        speed = self.deck.body[0].velocity[1]
        depth = speed * self.time
        return super().diagnostics() | {"penetration_depth_m": depth, "regime": regime(speed, 1100.0, 1e9)}


def compile_two(deck, second: bool = False) -> None:
    """In place of the kernels of a deck: two functions, kept in a folder here."""
    for function in (test_store.add, test_store.multiply):
        test_store.made(function, Path("code"))(1.0)


numba.config.THREADING_LAYER = "workqueue"  # one that can be forked
sys.modules["hydro2d.solver.simulation"] = SimpleNamespace(Simulation=Simulation)
compilation.once = lambda key, compile: None
compile_all.run_briefly = compile_two
case.kernels = sweep.kernels = lambda deck: ""
cluster.local = lambda workers, threads: contextlib.nullcontext(forks.Here())

with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()), contextlib.chdir(folder):
    forks.write(Path())
    for name, arguments in forks.COMMANDS.items():
        assert "report" in name or call(arguments) == 0, name
