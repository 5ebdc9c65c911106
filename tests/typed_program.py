"""A program that uses all of the public interface, for the type checker: its results have the types that it states."""

from __future__ import annotations

import numpy as np
import pandas
import pyvista
import xarray

import hydro2d


def calibrated(path: str) -> float:
    """Uses every public name; it is checked and never run."""
    deck: hydro2d.Deck = hydro2d.Deck.from_file(path, {"body.rod.velocity": "1200 m/s"})
    other: hydro2d.Deck = hydro2d.Deck.from_dict({"title": "a bar"}, ["stop.time=1 us"])
    text: str = hydro2d.Deck.from_toml(other.to_toml()).title

    sim = hydro2d.Simulation(deck)
    sim.columns["peak_Pa"] = lambda each: float(each.field("pressure").max())
    reason: str = sim.run(until="50 us", callbacks=[hydro2d.every(10, print), lambda each: each.time])
    rows: pandas.DataFrame = sim.to_pandas()
    columns: dict[str, np.ndarray] = sim.history
    density: np.ndarray = sim.array("density")
    now: xarray.Dataset = sim.fields
    grid: pyvista.RectilinearGrid = sim.to_pyvista()
    print(text, reason, rows, columns, density, now, grid)

    shot: hydro2d.Results = hydro2d.run(deck, "runs/shot", threads=1, columns={"time_again_s": lambda each: each.time})
    resolved: hydro2d.Deck = shot.deck
    same: hydro2d.Results = hydro2d.open_run("runs/shot")
    everything: xarray.Dataset = same.fields
    table: pandas.DataFrame = hydro2d.sweep(deck, {"body.rod.velocity": [900.0, 1000.0]}, directory="runs/study")
    cases: tuple[hydro2d.Case, ...] = hydro2d.open_study("runs/study").cases
    print(resolved, everything, table, [case.status for case in cases], studied(deck))
    drawn(shot.history)
    summary: hydro2d.Summary = shot.summary
    print(summary.penetration_dept_m)  # type: ignore[attr-defined]  # a misspelt result is an error
    return summary.penetration_depth_m or summary["nose_depth_m"]


def studied(deck: hydro2d.Deck) -> list[float]:
    """Models, fits and a table of runs."""
    runs: pandas.DataFrame = hydro2d.runs("runs/study", results=["crater.mean_diameter_m"])
    print(hydro2d.method_note(runs["method"]), hydro2d.wilson(3, len(runs)).words)
    speeds: list[float] = [hydro2d.to_si(velocity, "m/s") for velocity in runs["velocity"]]
    fit = hydro2d.fit_transition(speeds, list(runs["regime"] == "eroding"))
    limit: float = hydro2d.fit_residual_velocity([900.0, 800.0, 700.0], [500.0, 350.0, 100.0]).limit_velocity
    model = hydro2d.penetration_model("tate", deck, {"target.strength": 0.4e9})
    print(model.rows(speeds)[0]["depth"], deck.body_named("rod").name)
    r, z = deck.edges()
    return [limit, float(r[-1]), float(z[-1]), fit.v50 if fit else 0.0]


def drawn(history: dict[str, np.ndarray]) -> None:
    """A figure."""
    figure, ((left, right),) = hydro2d.new_figure(6.0, 4.0, 1, 2, sharey=True)
    left.plot(history["time"])
    right.plot(history["time"])
    hydro2d.save_figure(figure, "time.png")
