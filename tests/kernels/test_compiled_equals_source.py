"""Every compiled kernel does what its Python source says: numba can silently lose writes."""

import importlib
import itertools
import pkgutil
from types import SimpleNamespace

import numpy as np
import pytest

import hydro2d.kernels
from hydro2d import jit
from hydro2d.deck import deck
from hydro2d.jit import by_name
from hydro2d.jit.handle import TABLE
from hydro2d.jit.options import ONLY_CALLS
from hydro2d.solver.simulation import Simulation
from tests.decks import material, mesh, plate, rod, stop, table
from tests.kernels.cells import handles, source


def _kernels():
    """Every function that Python calls, except the phases, which call the rest."""
    for entry in pkgutil.walk_packages(hydro2d.kernels.__path__, "hydro2d.kernels."):
        module = importlib.import_module(entry.name)
        for name, value in vars(module).items():
            if hasattr(value, "compiled") and value.__module__ == module.__name__ and value.compiled.py_func not in ONLY_CALLS:
                yield module, name, value


@pytest.fixture
def phases_as_python():
    """Phases call kernels as attributes of modules."""
    jit.profiling(True, each_kernel=True)
    yield
    jit.profiling(False)


LAYER = {"method": "slip-layer", "yield_factor": "radius", "shear": "shear", "friction": 0.1}
CONTACT = {"method": "contact", "friction": 0.1}
CASES = {"ke, slip-layer": ("ke", LAYER), "both, slip-layer": ("both", LAYER), "ke, contact": ("ke", CONTACT)}


def text_of(advection: str, sliding: dict, tip: str = "0.2 mm", follows: bool | None = None) -> str:
    """A rod that strikes a plate, small; with contact the mesh follows the rod by default."""
    if follows is None:
        follows = sliding["method"] == "contact"
    struck = "hardening" if advection == "both" else "Al7039"  # both models of the one have variables
    strikes = "cracking" if advection == "both" else "W_alloy"
    return (
        mesh([{"to": "6 mm", "cells": 12}, {"cells": 3, "ratio": 1.1}], ("-6 mm", "6 mm", 20),
             **({"follow": "rod"} if follows else {}))
        + rod("2.7 mm", "5 mm", tip=tip, velocity="1200 m/s", material=strikes)
        + plate("8 mm", material=struck, z_front="0.2 mm")
        + table("boundaries", z_max="transmit" if follows else "outflow")
        + table("sliding", hard=["rod"], **sliding)
        + material("cracking", "W_alloy", damage={"model": "cochran-banner", "opening": "20 um"})
        + material("hardening", "Al_porous")
        + table("materials.hardening.strength", model="kinematic-hardening", shear_modulus="27.6 GPa", yield_stress="0.3 GPa",
                hardening_modulus="2 GPa", isotropic_share=0.5)
        + table("failure", damage="material", melting="material")
        + table("numerics", initial_dt_factor=1.0, advection=advection)
        + stop("1 us")
    )


def steers_as_its_source(function, handle) -> None:
    """Runs a function that sets numbers of the handle, and its source on copies: arrays and numbers are the same afterwards."""
    copies = SimpleNamespace(**{name: value.copy() if isinstance(value, np.ndarray) else value
                                for name, value in handle.values.items() if name not in TABLE.values()})
    function(handle)
    source(function)(copies)
    for name, value in vars(copies).items():
        if name in by_name.takes(function) or not isinstance(value, np.ndarray):
            said = f"{function.__name__}, {name}"
            np.testing.assert_allclose(getattr(handle, name), value, rtol=1e-11, atol=1e-300, err_msg=said)


@pytest.mark.thorough
@pytest.mark.parametrize(("advection", "sliding"), CASES.values(), ids=CASES)
def test_kernels_do_what_their_source_says(monkeypatch, phases_as_python, advection, sliding):
    seen, kernels = set(), list(_kernels())

    def held_against_source(module, name, function):
        names, own = by_name.takes(function), len(by_name.own_parameters(function))

        def call(*arguments):
            if by_name.steers(function):
                seen.add(name)
                return steers_as_its_source(function, arguments[-1])
            given = dict(zip(names, by_name.values(function, arguments), strict=True))
            copies = {of: a.copy() if isinstance(a, np.ndarray) else a for of, a in given.items()}
            arrays = [a for a in given.values() if isinstance(a, np.ndarray) and a.size]
            for one, other in itertools.combinations(arrays, 2):  # hydro2d.jit promises it to the compiler
                assert not np.shares_memory(one, other), f"arguments of {name} overlap"
            function(*arguments)
            with np.errstate(all="ignore"):
                source(function)(*list(copies.values())[:own], *handles(function, copies))
            for of, mine in given.items():
                if isinstance(mine, np.ndarray):
                    np.testing.assert_allclose(mine, copies[of], rtol=1e-11, atol=1e-300, err_msg=f"{name}, {of}")
            seen.add(name)
            return None

        monkeypatch.setattr(module, name, call)

    for module, name, function in kernels:
        held_against_source(module, name, function)
    follows = sliding["method"] == "contact"
    simulation = Simulation(deck.loads(text_of(advection, sliding)))
    for _ in range(4):
        simulation.step()
    simulation.refuse_nonsense()
    others = ("sliding",) if follows else ("contact",)  # the treatment that the deck does not have
    prefixes = tuple(f"hydro2d.kernels.{other}" for other in others)
    unused = {name for module, name, _ in kernels if module.__name__.startswith(prefixes)} | {"triad"}
    if advection != "both" and "contact" in others:
        unused.add("deposit")
    if advection != "both":
        unused |= {"remember", "update_memory", "open_cracks", "damage_by_cracks"}
    unused |= {"cut", "is_time_for_zones" if follows else "count_slots"}  # `cut` is part of `cut_parts`
    unused |= {"light_points", "bend_around"}  # before the first step of an explosive: tests/kernels/test_light_times.py
    if follows:
        unused |= {"moving_columns", "moving_box"}  # a mesh that travels skips no cells
        unused |= {"bear", "find_held", "hold_vertices", "heat_held_vertices"}  # with one velocity only
    else:
        unused |= {"transmit"} | {name for module, name, _ in kernels
                                  if module.__name__.endswith((".mesh_motion", ".mesh_travel"))}
    assert seen == {name for _, name, _ in kernels} - unused
