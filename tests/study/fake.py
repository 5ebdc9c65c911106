"""Run directories and studies that nobody ran: the input of a report, written in milliseconds."""

from __future__ import annotations

import functools
import json
from pathlib import Path

import numpy as np

from hydro2d.base.errors import DeckError
from hydro2d.base.method_version import METHOD
from hydro2d.deck import deck, targets
from hydro2d.files.whole import write_json
from hydro2d.measure import outcome
from hydro2d.measure.penetrator import Projectile
from hydro2d.output import vtk
from hydro2d.output.directory import deck_hash
from hydro2d.output.history import History
from hydro2d.study.plan import members

BASE = "problems/cth_nose_shape/hemi_5083_1086_quick.toml"
LENGTH, RADIUS, MASS, TIME = 0.09779, 0.0033784, 0.063, 6e-4


@functools.cache
def resolved(file: str, *overrides: str) -> str:
    """A resolved deck with overrides."""
    return deck.load(file, list(overrides)).to_toml()


def deck_text(*overrides: str) -> str:
    """The resolved deck of a shot with overrides."""
    return resolved(BASE, *overrides)


def write_run(directory: Path, velocity: float = 1086.0, depth: float = 0.31, shortened: float = 0.02, rows: int = 200,
              overrides: tuple[str, ...] = (), text: str = "", **summary) -> Path:
    """A finished run into a directory; ``text`` is another deck's, ``summary`` replaces entries of summary.json."""
    directory.mkdir(parents=True)
    text = text or deck_text(f"body.rod.velocity={velocity} m/s", *overrides)
    (directory / "deck.toml").write_text(text)
    _write_history(directory, velocity, depth, shortened, rows)
    _write_outlines(directory, depth, shortened)
    write_json(directory / "summary.json", with_outcome(_summary(depth, shortened, text) | summary, text))
    return directory


def with_outcome(summary: dict, text: str) -> dict:
    """A summary with what its shot came to; a rod that is deeper than its plate is through it."""
    try:
        made = deck.loads(text)
    except DeckError:  # of another version
        return summary
    if made.penetration is None:
        return summary
    thickness = targets.thickness(made)
    if thickness is not None and (summary.get("penetration_depth_m") or 0.0) >= thickness and "exit_time_s" not in summary:
        rested = summary["stop_reason"].startswith(outcome.RESTED)
        summary = summary | {"exit_time_s": summary["time_s"]} | ({"stop_reason": "perforation of plate"} if rested else {})
    sound = Projectile.sound(summary)[0]  # some tests write nonsense
    measured = Projectile(**{name: sound.get(name) for name in Projectile.model_fields})
    came = outcome.of(measured, status=summary["status"], stop_reason=summary["stop_reason"],
                      impact_velocity=deck.impact_velocity(made), thickness=thickness, dropped=None,
                      experiment=made.experiment)
    return summary | {"outcome": came.model_dump()}


def _write_history(directory: Path, velocity: float, depth: float, shortened: float, rows: int) -> None:
    history = History(directory / "history.h5")
    for share in np.linspace(0.0, 1.0, rows):
        history.append({
            "time": share * TIME, "cycle": int(1000 * share), "penetration_depth_m": depth * (2.0 - share) * share,
            "rod_tail_velocity_m_s": velocity * (1.0 - share), "rod_length_m": LENGTH * (1.0 - shortened * share),
            "rod_max_radius_m": RADIUS * (1.0 + shortened), "rod_mass_kg": MASS, "regime": "rigid",
        })
    history.write()


def _write_outlines(directory: Path, depth: float, shortened: float) -> None:
    """The rod as a rectangle that has swollen, before and after."""
    (directory / "vtk").mkdir()
    entries = []
    for number, (tip, length, radius) in enumerate(
        [(0.0, LENGTH, RADIUS), (depth, LENGTH * (1.0 - shortened), RADIUS * (1.0 + shortened))]
    ):
        rod = np.array([[0.0, tip - length], [radius, tip - length], [radius, tip], [0.0, tip]])
        plate = np.array([[0.0, 0.5334], [0.08, 0.5334]])
        file = f"vtk/interfaces_{number:06d}.vtp"
        vtk.write_lines(directory / file, [(1, rod), (2, plate)], number * TIME)
        entries.append((number * TIME, file))
    vtk.write_series(directory / "interfaces.pvd", entries)


def _summary(depth: float, shortened: float, text: str) -> dict:
    energies = {"cutoff": 1e-3, "advection": 300.0, "outflow": 12.0}
    return {
        "status": "done", "stop_reason": "speed of rod below 5 m/s", "time_s": TIME, "cycles": 1000, "cells": 60984,
        "wall_s": 321.3, "ns_per_cell_cycle": 120.0, "version": "0.1.0", "method": METHOD, "deck_sha256": deck_hash(text),
        "penetration_depth_m": depth, "rod_length_m": LENGTH * (1.0 - shortened), "rod_initial_length_m": LENGTH,
        "rod_max_radius_m": RADIUS * (1.0 + shortened), "rod_initial_radius_m": RADIUS, "rod_mass_kg": MASS,
        "rod_tail_velocity_m_s": 3.0, "regime": "rigid" if shortened < 0.02 else "deforming",
        "conservation": {
            "mass": {"rod": -3e-15, "plate": 1e-14}, "axial_momentum": -2e-16, "total_energy": 3e-9, "start_energy_J": 37000.0,
            "sinks": {name: {"mass_kg": 0.0, "momentum_N_s": 0.0, "energy_J": joule} for name, joule in energies.items()},
        },
        "provenance": {
            "version": "0.1.0", "git_commit": "c0ffee", "git_dirty": True, "packages": {"python": "3.11", "numpy": "2.4"},
            "threads": 1, "cpu": "a processor", "host": "a machine", "system": "Linux", "command": "hydro2d run <deck> & more",
            "written": "2026-01-01T00:00:00+00:00",
        },
    }


def write_study(directory: Path, axes: dict[str, dict[str, tuple[str, ...]]], title: str = "A study",
                repeats: int = 1) -> Path:
    """A study as `hydro2d sweep` leaves it, without its cases: axes -> label -> overrides. Every case is done.

    The depth falls and the rod is shortened from case to case, so that no two rows are the same. Members of an ensemble of
    ``repeats`` go 1 cm deeper each, and the last one is eroded.
    """
    cases = [{}]
    for axis, labels in axes.items():
        cases = [{**case, axis: label} for case in cases for label in labels]
    entries = []
    for number, values in enumerate(cases):
        name = "_".join(values.values()).replace("/", "-").replace(" ", "")
        overrides = [text for axis, label in values.items() for text in axes[axis][label]]
        speed = next((float(label.split()[0]) for label in values.values() if label.endswith("m/s")), 1086.0)
        others = tuple(text for text in overrides if "velocity" not in text)
        for member in range(repeats):
            own, last = members.name(name, member) if repeats > 1 else name, repeats > 1 and member == repeats - 1
            factor = (f"numerics.initial_dt_factor={0.1 - 1e-4 * member}",) if member else ()
            depth, shortened = 0.35 - 1e-3 * number + 0.01 * member, 0.01 + 1e-3 * number
            place = write_run(directory / "cases" / own, speed, 0.14 if last else depth, 0.7 if last else shortened,
                              overrides=others + factor, **({"regime": "eroding"} if last else {}))
            entry = {"name": own, "directory": f"cases/{own}", "values": values, "deck": BASE, "overrides": overrides,
                     "deck_sha256": deck_hash((place / "deck.toml").read_text()), "status0": None, "message": ""}
            if repeats > 1:
                entry |= {"of": name or directory.name, "member": member, "changed": {"first step": 1.0 - 1e-3 * member}}
            entries.append(entry)
    keys = {"velocity": "body.rod.velocity"}
    described = [{"name": axis, "key": keys.get(axis), "values": list(labels)} for axis, labels in axes.items()]
    data = {"title": title, "name": directory.name, "version": "0.1.0", "study_sha256": "cd" * 32, "axes": described,
            "cases": entries}
    data |= {"ensemble": {"repeats": repeats, "by": ["first step"], "seed": 0}} if repeats > 1 else {}
    (directory / "study.json").write_text(json.dumps(data))
    return directory


def velocities(*speeds: int) -> dict[str, tuple[str, ...]]:
    """Labels of a velocity axis."""
    return {f"{speed} m/s": (f"body.rod.velocity={speed} m/s",) for speed in speeds}


def edit_json(file: Path, **changes) -> None:
    """Replaces entries of a JSON file; a summary has the outcome that belongs to them."""
    entries = json.loads(file.read_text()) | changes
    if file.name == "summary.json" and "outcome" in entries:
        entries = with_outcome(entries, file.with_name("deck.toml").read_text())
    entries.pop("sha256", None)
    file.write_text(json.dumps(entries))
