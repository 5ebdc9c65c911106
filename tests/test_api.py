"""The public interface: decks, simulations in memory, runs, their fields, and sweeps, as a program uses them."""

import os
import shutil
import signal
import subprocess
import sys
import tomllib

import numpy as np
import pandas
import pytest

import hydro2d
from hydro2d import api
from hydro2d.materials.quantities import FieldError
from hydro2d.output import datasets
from hydro2d.output.vtk import read_grid
from tests.results import made_run
from tests.solver.test_simulation import TEXT
from tests.study import tubes

FOLLOWING = {"mesh.follow": "rod", "stop.time": "4 us", "output.vtk_interval": "1 us"}


@pytest.fixture(scope="module")
def deck():
    return hydro2d.Deck.from_toml(TEXT, {"stop.time": "4 us", "output.vtk_interval": "1 us"}, name="shot")


@pytest.fixture(scope="module")
def shot(deck, tmp_path_factory):
    """A run in a directory, with a column of the user's."""
    place = tmp_path_factory.mktemp("api") / "shot"
    return hydro2d.run(deck, place, quiet=True, columns={"highest_Pa": lambda sim: sim.array("pressure").max()})


# ---------------------------------------------------------------------------------------------------- names


def test_importing_hydro2d_is_cheap_and_the_names_are_there():
    text = ("import sys, hydro2d; print(sorted({'numba', 'pandas', 'vtk', 'pydantic'} & set(sys.modules)));"
            "print([name for name in hydro2d.__all__ if getattr(hydro2d, name).__doc__ is None])")
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == ["[]", "[]"]


@pytest.mark.parametrize("first", ["", "import eos; "])
def test_another_package_called_eos_is_reported(tmp_path, first):
    (tmp_path / "eos.py").write_text("ROTATION = 1\n")
    done = subprocess.run([sys.executable, "-c", f"{first}import hydro2d"], cwd=tmp_path, capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), str(tubes.ROOT)])})
    assert done.returncode == 1
    assert f"hydro2d has its own package eos, but Python finds another one at {tmp_path / 'eos.py'}" in done.stderr


TYPED = """
import hydro2d
import hydro2d.problems

deck: hydro2d.Deck = hydro2d.Deck.from_file("shot.toml", {"stop.time": "1 us"})
reason: str = hydro2d.Simulation(deck).run(until=1e-6)
wrong: int = hydro2d.Simulation(deck).run(until=1e-6)
"""


@pytest.mark.thorough
def test_a_type_checker_finds_hydro2d_from_any_folder(tmp_path):
    """In an editable install as well: the mistake is found, and no name is missing."""
    (tmp_path / "program.py").write_text(TYPED)
    (tmp_path / "mypy.ini").write_text("[mypy]\nfollow_imports = skip\n[mypy-hydro2d.*]\nfollow_imports = silent\n")
    done = subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", "cache", "program.py"], cwd=tmp_path, text=True,
                          capture_output=True, timeout=300, env=os.environ | {"PYTHONPATH": "", "MYPYPATH": ""}, check=False)
    assert "program.py:7: error: Incompatible types" in done.stdout
    assert "Found 1 error in 1 file" in done.stdout


def test_the_names_load_no_kernels():
    """Until the first simulation is made a deck can still bring a model of its own."""
    text = ("import sys, hydro2d; [getattr(hydro2d, name) for name in hydro2d.__all__];"
            "print({'eos.dispatch', 'strength.dispatch'} & set(sys.modules))")
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_an_unknown_name_is_refused():
    with pytest.raises(AttributeError, match="no attribute 'simulate'"):
        hydro2d.simulate  # noqa: B018


def test_all_is_what_is_there():
    assert set(hydro2d.__all__) <= set(dir(hydro2d))
    assert sorted(hydro2d.__all__) == sorted(hydro2d._PLACES)


# ---------------------------------------------------------------------------------------------------- decks


def test_the_three_ways_to_a_deck_give_the_same(tmp_path, deck):
    file = tmp_path / "shot.toml"
    file.write_text(TEXT)
    changes = {"stop.time": "4 us", "output.vtk_interval": "1 us"}
    by_file = hydro2d.Deck.from_file(file, changes)
    by_dict = hydro2d.Deck.from_dict(tomllib.loads(TEXT), changes, name="shot")
    by_list = hydro2d.Deck.from_file(file, ["stop.time=4 us", "output.vtk_interval=1 us"])
    assert by_file.to_toml() == by_dict.to_toml() == by_list.to_toml() == deck.to_toml()
    assert hydro2d.Deck.from_toml(deck.to_toml()).to_toml() == deck.to_toml()


def test_numbers_of_numpy_and_tuples_are_values():
    mesh = {"r": [{"to": np.float64(9e-3), "cells": np.int64(18)}], "z_start": -12e-3, "z": ({"to": 12e-3, "cells": 48},)}
    loaded = hydro2d.Deck.from_dict({**tomllib.loads(TEXT), "mesh": mesh}, {"body.rod.velocity": np.array([0.0, 80.0])})
    assert loaded.body[0].velocity == (0.0, 80.0)
    assert loaded.mesh.r[0].cells == 18


def test_a_dict_is_not_changed():
    tables = tomllib.loads(TEXT)
    hydro2d.Deck.from_dict(tables, {"body.rod.velocity": "80 m/s"})
    assert tables == tomllib.loads(TEXT)


def test_the_class_alone_makes_no_deck():
    with pytest.raises(hydro2d.DeckError, match="use Deck.from_file, Deck.from_toml or Deck.from_dict"):
        hydro2d.Deck(**tomllib.loads(TEXT))


@pytest.mark.parametrize(("changes", "said"), [
    ({"body.rod.velocity": "80 kg"}, r'override body.rod.velocity = .80 kg.: body\[0\].velocity: "80 kg" is a mass'),
    ({"body.bar.velocity": 80.0}, "override body.bar.velocity = 80.0: there is no entry bar; there are rod, plate"),
    ({"numerics.advection": "kinetic"}, "override numerics.advection"),
    ({"": 1}, "the key is empty"),
    ("stop.time=1", 'not the text "stop.time=1"'),
])
def test_a_wrong_override_is_named(changes, said):
    with pytest.raises(hydro2d.DeckError, match=said):
        hydro2d.Deck.from_toml(TEXT, changes)


def test_a_mistake_in_a_dict_names_its_key():
    tables = tomllib.loads(TEXT)
    tables["body"][0]["nose"] = "spherical"
    with pytest.raises(hydro2d.DeckError, match=r"^shot: body\[0\].nose"):
        hydro2d.Deck.from_dict(tables, name="shot")


def test_edges_and_bodies_of_a_deck(deck):
    sim = hydro2d.Simulation(deck)
    for edges, own in zip(deck.edges(), (sim.grid.r_edges, sim.grid.z_edges), strict=True):
        np.testing.assert_array_equal(edges, own)
    assert deck.body_named("plate") is deck.body[1]
    with pytest.raises(KeyError):
        deck.body_named("sabot")


# ---------------------------------------------------------------------------------------------------- models and kept rows

SHOT = "problems/cth_nose_shape/hemi_5083_1296.toml"


def test_an_analytic_model_for_a_deck():
    deck = hydro2d.Deck.from_file(SHOT)
    depths = [hydro2d.penetration_model("tate", deck, inputs).rows([1296.0])[0]["depth"]
              for inputs in (None, {"target.resistance": 2e9}, {"target.resistance": 4e9})]
    assert 0.0 < depths[2] < depths[1] != depths[0] > 0.0
    assert {"tate", "forrestal"} <= set(hydro2d.penetration_models())
    with pytest.raises(ValueError, match="tate"):
        hydro2d.penetration_model("tat", deck)
    with pytest.raises(hydro2d.DeckError, match="needs a rod on the axis and a target"):
        hydro2d.penetration_model("tate", hydro2d.Deck.from_file("problems/verification/sod_z.toml"))


def test_a_fit_needs_as_many_shots_as_constants():
    speeds, left = [220.0, 250.0, 300.0], [40.0, 120.0, 190.0]
    assert 200.0 < hydro2d.fit_residual_velocity(speeds, left, p=2.0).limit_velocity < 220.0
    with pytest.raises(ValueError, match="3 constants"):
        hydro2d.fit_residual_velocity(speeds[:2], left[:2])


def test_runs_of_nothing_are_refused(tmp_path):
    with pytest.raises(hydro2d.StudyError, match="there is no such directory"):
        hydro2d.runs(tmp_path / "rows.csv")


# ---------------------------------------------------------------------------------------------------- simulations


def test_totals_at_the_start_are_those_of_the_audit(deck):
    sim = hydro2d.Simulation(deck)
    np.testing.assert_array_equal(sim.totals().mass, sim.audit.start.mass)
    assert sim.totals().energy == sim.audit.start.energy > 0.0


def test_run_to_a_time_and_on(deck):
    sim = hydro2d.Simulation(deck)
    assert sim.run(until="1 us") == "end time"
    assert 1e-6 <= sim.time < 1e-6 + sim.dt
    middle = sim.cycle
    assert sim.run(until=lambda each: each.cycle == middle + 3) == "as asked"
    assert sim.cycle == middle + 3
    assert sim.run() == "end time"
    assert 4e-6 <= sim.time < 4e-6 + sim.dt


def test_a_run_in_memory_computes_what_a_run_on_disk_does(deck, shot):
    sim = hydro2d.Simulation(deck)
    sim.columns["highest_Pa"] = lambda each: each.array("pressure").max()
    assert sim.run() == shot.summary["stop_reason"]
    ours, theirs = sim.to_pandas(), shot.to_pandas()
    pandas.testing.assert_frame_equal(ours, theirs, check_exact=True)
    assert ours.attrs == theirs.attrs
    assert ours.attrs["units"]["highest_Pa"] == "Pa"
    assert ours["highest_Pa"].max() > 1e7
    assert list(sim.history) == list(shot.history)


def test_callbacks_are_called_when_they_are_due(deck):
    sim, cycles, times, all_of_them = hydro2d.Simulation(deck), [], [], []
    sim.run(until="2 us", callbacks=[
        hydro2d.every(7, lambda each: cycles.append(each.cycle)),
        hydro2d.every("0.5 us", lambda each: times.append((each.time, each.dt))),
        lambda each: all_of_them.append(each.cycle),
    ])
    assert cycles == list(range(7, sim.cycle + 1, 7))
    assert all_of_them == list(range(1, sim.cycle + 1))
    assert len(times) == 4
    for number, (time, dt) in enumerate(times, start=1):
        assert number * 0.5e-6 <= time < number * 0.5e-6 + dt


def test_a_callback_begun_in_the_middle_does_not_make_up_for_the_past(deck):
    sim, times = hydro2d.Simulation(deck), []
    sim.run(until=1.2e-6)
    sim.run(until=2.1e-6, callbacks=[hydro2d.every(0.5e-6, lambda each: times.append(each.time))])
    assert [round(time / 0.5e-6) for time in times] == [3, 4]


@pytest.mark.parametrize("interval", [0, -3, 0.0, "-1 us"])
def test_an_interval_is_positive(interval):
    with pytest.raises(ValueError, match="must be positive"):
        hydro2d.every(interval, print)


def test_a_callback_serves_several_simulations(deck):
    times = []
    callback = hydro2d.every("0.5 us", lambda each: times.append(each.time))
    for _ in range(2):
        hydro2d.Simulation(deck).run(until="1 us", callbacks=[callback])
    assert len(times) == 4
    assert times[:2] == times[2:]


def test_the_history_begins_with_the_first_run(deck):
    sim = hydro2d.Simulation(deck)
    assert sim.history == {}
    assert sim.to_pandas().empty
    sim.step()
    assert sim.to_pandas().empty


def test_an_interrupt_waits_for_the_end_of_the_cycle(deck):
    sim, whole = hydro2d.Simulation(deck), hydro2d.Simulation(deck)
    with pytest.raises(KeyboardInterrupt, match="Simulation shot"):
        sim.run(callbacks=[lambda each: os.kill(os.getpid(), signal.SIGINT) if each.cycle == 10 else None])
    assert sim.cycle == 10
    sim.run()
    whole.run()
    pandas.testing.assert_frame_equal(sim.to_pandas(), whole.to_pandas(), check_exact=True)


@pytest.mark.parametrize(("name", "column", "said"), [
    ("penetration_depth_m", lambda sim: 1.0, "the history has a column penetration_depth_m of its own"),
    ("crater_radius", lambda sim: 1.0, "a column cannot be called 'crater_radius'"),
    ("a/b", lambda sim: 1.0, "a column cannot be called 'a/b'"),
    (1, lambda sim: 1.0, "a column cannot be called 1"),
    ("mine", 1.0, "the column mine is a function of the simulation, not 1.0"),
    ("mine", lambda sim: 1 / 0, "the column mine fails: ZeroDivisionError: division by zero"),
    ("mine", lambda sim: None, "the column mine fails: TypeError"),
])
def test_a_wrong_column_is_named(deck, name, column, said):
    sim = hydro2d.Simulation(deck)
    sim.columns[name] = column
    with pytest.raises(hydro2d.Error, match=said):
        sim.run(until="1 us")


def test_a_run_with_a_wrong_name_of_a_column_removes_nothing(tmp_path, deck):
    (tmp_path / "deck.toml").write_text("kept")
    with pytest.raises(hydro2d.Error, match="a column cannot be called"):
        hydro2d.run(deck, tmp_path, overwrite=True, quiet=True, columns={"a b": lambda sim: 1.0})
    assert (tmp_path / "deck.toml").read_text() == "kept"


def test_a_column_that_fails_leaves_a_run_that_can_go_on(tmp_path, deck, shot):
    fails = {"highest_Pa": lambda sim: sim.array("pressure").max() if sim.time < 2e-6 else 1 / 0}
    with pytest.raises(hydro2d.Error, match="the column highest_Pa fails"):
        hydro2d.run(deck, tmp_path / "run", quiet=True, columns=fails)
    assert not (tmp_path / "run" / "progress.json").exists()
    rights = {"highest_Pa": lambda sim: sim.array("pressure").max()}
    results = hydro2d.run(deck, tmp_path / "run", restart=True, quiet=True, columns=rights)
    assert results.summary["cycles"] == shot.summary["cycles"]


def test_arrays_are_views(deck):
    sim = hydro2d.Simulation(deck)
    assert np.shares_memory(sim.array("density"), sim.state.rho)
    assert sim.array("rho").shape == (2, 48, 18)
    assert sim.array("axial_velocity").shape == (1, 49, 19)
    assert sim.array("pressure").shape == (48, 18)
    with pytest.raises(ValueError, match="read-only"):
        sim.array("e")[1] = 123.0
    sim.state.e[1] = 123.0
    assert sim.array("e")[1].min() == 123.0
    with pytest.raises(FieldError, match='unknown field "presure"; did you mean "pressure"'):
        sim.array("presure")


def test_velocities_at_points_take_lists(deck):
    sim = hydro2d.Simulation(deck)
    np.testing.assert_allclose(sim.velocity_at([[0.5e-3, -3e-3], [0.5e-3, 4e-3]]), [[0.0, 60.0], [0.0, 0.0]], rtol=1e-14)
    with pytest.raises(ValueError, match=r"shape \[n, 2\]"):
        sim.velocity_at([0.5e-3, -3e-3])


def test_fields_are_computed_from_the_state(deck):
    sim = hydro2d.Simulation(deck)
    sim.run(until="1 us")
    fields = sim.fields
    np.testing.assert_array_equal(fields.pressure, sim.field("pressure"))
    np.testing.assert_array_equal(fields.body_density.sel(body="rod"), sim.field("body_density", "rod"))
    np.testing.assert_array_equal(fields.velocity.sel(component="z"), sim.field("velocity")[..., 1])
    assert fields.pressure.dims == ("z", "r")
    assert fields.pressure.attrs["units"] == "Pa"
    np.testing.assert_allclose(fields.z, 0.5 * (sim.grid.z_edges[1:] + sim.grid.z_edges[:-1]))
    grid = sim.to_pyvista()
    np.testing.assert_allclose(grid.cell_data["Pressure [Pa]"].reshape(48, 18), sim.field("pressure"), rtol=1e-6)
    assert grid.bounds[:4] == pytest.approx((0.0, 9e-3, -12e-3, 12e-3))


@pytest.mark.parametrize(("key", "body", "said"), [
    ("presure", None, 'unknown field "presure"'),
    ("body_density", None, "body_density is one of every body"),
    ("body_density", "bar", 'unknown body "bar"'),
    ("contact_pressure", None, "contact_pressure: the simulation has none"),
])
def test_a_field_that_is_not_there_is_refused(deck, key, body, said):
    with pytest.raises(FieldError, match=said):
        hydro2d.Simulation(deck).field(key, body)


def test_the_message_on_an_old_name_of_a_deviator_has_the_new_one(deck):
    sim = hydro2d.Simulation(deck)
    with pytest.raises(FieldError, match="stress_zz is now called deviator_zz"):
        sim.array("stress_zz")
    assert sim.array("deviator_zz").shape[0] == len(sim.table.names)


# ---------------------------------------------------------------------------------------------------- runs


def test_fields_of_all_dumps(shot):
    fields = shot.fields
    assert fields.sizes["time"] == len(shot.dumps) == 5
    np.testing.assert_allclose(fields.time, [time for time, _ in shot.dumps])
    dump = read_grid(shot.dumps[2][1])
    np.testing.assert_array_equal(fields.pressure[2], dump.fields["Pressure [Pa]"])
    np.testing.assert_array_equal(fields.volume_fraction.sel(body="plate")[2], dump.fields["Volume Fraction for plate"])
    assert fields.mesh_position.values.tolist() == [0.0] * 5
    assert float(fields.pressure.max("time").max()) > 1e7


def test_fields_are_read_late(shot, monkeypatch):
    opened = []
    monkeypatch.setattr(datasets, "read_grid", lambda path: opened.append(path) or read_grid(path))
    fields = shot.fields
    assert len(opened) == 2, "the first and the last"
    fields.pressure[1].values  # noqa: B018
    assert opened[2:] == [shot.dumps[1][1]]
    fields.compute()
    assert sorted(opened[3:]) == sorted(file for _, file in shot.dumps), "all variables of a dump share one reading"


def test_fields_of_a_run_that_was_begun_anew_are_refused(tmp_path, deck):
    place = tmp_path / "run"
    fields = hydro2d.run(deck, place, quiet=True).fields
    finer = hydro2d.Deck.from_toml(TEXT, {"stop.time": "4 us", "output.vtk_interval": "1 us", "mesh.r.0.cells": 20})
    hydro2d.run(finer, place, overwrite=True, quiet=True)
    with pytest.raises(hydro2d.Error, match="another mesh"):
        fields.pressure[1].compute()


def test_the_history_of_a_run_under_way_is_read_again(tmp_path, shot):
    (tmp_path / "deck.toml").write_text((shot.directory / "deck.toml").read_text())
    run = hydro2d.open_run(tmp_path)
    with pytest.raises(hydro2d.Error, match="none was written yet"):
        run.history  # noqa: B018
    shutil.copy(shot.directory / "history.h5", tmp_path)
    assert len(run.history["time"]) == len(shot.history["time"])


def test_a_mesh_that_travels_says_where_it_is(tmp_path):
    deck = hydro2d.Deck.from_toml(TEXT, FOLLOWING)
    results = hydro2d.run(deck, tmp_path / "following", quiet=True)
    fields = results.fields
    travelled = fields.mesh_position.values
    assert travelled[0] == 0.0
    assert (np.diff(travelled) > 0).all()
    assert fields.pressure.dims == ("time", "mesh_z", "r")
    assert fields.volume_fraction.dims == ("time", "body", "mesh_z", "r")
    assert fields.z.dims == ("time", "mesh_z")
    np.testing.assert_allclose(fields.mesh_z + fields.mesh_position, fields.z.T, atol=1e-12)
    for number, (_, file) in enumerate(results.dumps):
        np.testing.assert_array_equal(fields.z[number], read_grid(file).z_centres)
    last = fields.isel(time=-1).swap_dims(mesh_z="z")
    place = float(last.z[7]) + 1e-6
    np.testing.assert_array_equal(last.pressure.sel(z=place, method="nearest"), fields.pressure[-1, 7])


def test_a_mesh_that_will_travel_has_its_dimensions_from_the_first_dump_on(tmp_path):
    """A script must not depend on how far a run has come."""
    directory = made_run.write(tmp_path / "run", dumps=1)
    assert hydro2d.open_run(directory).fields.pressure.dims == ("time", "z", "r")
    (directory / "deck.toml").write_text(made_run.DECK_TEXT.format(geometry="cylindrical").replace(
        "[boundaries]", 'follow = "rod"\n[boundaries]'))
    fields = hydro2d.open_run(directory).fields
    assert fields.pressure.dims == ("time", "mesh_z", "r")
    np.testing.assert_array_equal(fields.z[0], fields.mesh_z)


def test_a_run_without_dumps_has_no_fields(tmp_path, shot):
    (tmp_path / "deck.toml").write_text((shot.directory / "deck.toml").read_text())
    with pytest.raises(hydro2d.ResultsError, match="no dump was written yet"):
        hydro2d.open_run(tmp_path).fields  # noqa: B018


def test_a_directory_is_not_used_twice(deck, shot):
    with pytest.raises(hydro2d.RunError, match="already holds a run"):
        hydro2d.run(deck, shot.directory, quiet=True)


def test_a_run_is_not_written_into_a_study(deck, tmp_path):
    (tmp_path / "study.json").write_text("{}")
    for overwrite in (False, True):
        with pytest.raises(hydro2d.RunError, match="holds a study; give the run a directory of its own"):
            hydro2d.run(deck, tmp_path, quiet=True, overwrite=overwrite)


def test_a_run_that_fails_raises(tmp_path, deck, monkeypatch):
    def broken(sim, until=np.inf, cycles=None):
        raise hydro2d.UnphysicalState("cycle 1: negative density")

    monkeypatch.setattr(hydro2d.Simulation, "advance", broken)
    with pytest.raises(hydro2d.UnphysicalState, match="negative density"):
        hydro2d.run(deck, tmp_path / "fails", quiet=True)


def test_an_interrupted_run_raises_and_goes_on(tmp_path, deck, shot, monkeypatch):
    advance, place = hydro2d.Simulation.advance, tmp_path / "stopped"

    def stopped(sim, until=np.inf, cycles=None):
        done = advance(sim, until, cycles or 20 - sim.cycle)
        if sim.cycle == 20:
            os.kill(os.getpid(), signal.SIGINT)
        return done

    columns = {"highest_Pa": lambda sim: sim.array("pressure").max()}
    monkeypatch.setattr(hydro2d.Simulation, "advance", stopped)
    with pytest.raises(KeyboardInterrupt, match="stopped: interrupted"):
        hydro2d.run(deck, place, quiet=True, columns=columns)
    monkeypatch.undo()
    results = hydro2d.run(deck, place, restart=True, quiet=True, columns=columns)
    pandas.testing.assert_frame_equal(results.to_pandas(), shot.to_pandas(), check_exact=True)


# ---------------------------------------------------------------------------------------------------- sweeps


@pytest.mark.thorough
def test_a_sweep_of_a_deck_is_a_table(tmp_path):
    file = tmp_path / "tube.toml"
    file.write_text(tubes.TUBE)
    axes = {"numerics.advection": ["ke", "momentum"], "body.low.pressure": [0.1, np.float64(0.2)]}
    place = tmp_path / "study"
    table = hydro2d.sweep(file, axes, directory=place, overrides={"stop.time": np.float64(0.005)}, workers=1)
    assert table.index.tolist() == ["ke_0.1", "ke_0.2", "momentum_0.1", "momentum_0.2"]
    assert table["status"].tolist() == ["done"] * 4
    assert table["advection"].tolist() == ["ke", "ke", "momentum", "momentum"]
    assert (table["time_s"] >= 0.005).all()
    assert hydro2d.open_study(place).table().equals(table)
    with pytest.raises(hydro2d.StudyError, match="already holds a study"):
        hydro2d.sweep(file, axes, directory=place, workers=1)
    again = hydro2d.sweep(file, axes, directory=place, overrides=["stop.time=0.005"], workers=1, resume=True)
    assert again.equals(table)


@pytest.mark.thorough
def test_a_sweep_of_a_deck_object_and_of_a_study_file(tmp_path):
    tube = hydro2d.Deck.from_toml(tubes.TUBE, {"stop.time": 0.005})
    table = hydro2d.sweep(tube, {"body.low.pressure": [0.1]}, directory=tmp_path / "one", workers=1)
    study = tubes.write(tmp_path, 'deck = "tube.toml"\n[[axis]]\nname = "p"\nkey = "body.low.pressure"\nvalues = [0.1]\n')
    other = hydro2d.sweep(study, directory=tmp_path / "two", overrides={"stop.time": 0.005}, workers=1)
    assert table["status"].tolist() == other["status"].tolist() == ["done"]
    assert table["cycles"].tolist() == other["cycles"].tolist()


def test_a_sweep_of_a_deck_object_resolves_its_defaults_anew(tmp_path):
    """The surface from which the depth counts and the intervals of output follow the case, not the original deck."""
    deck = hydro2d.Deck.from_toml(TEXT)
    plan = api._plan(deck, {"body.plate.z_front": ["0 mm", "1 mm"], "stop.time": ["10 us", "20 us"]}, (), tmp_path / "study")
    cases = [hydro2d.Deck.from_toml(case.text) for case in plan.cases]
    assert [case.penetration.surface for case in cases] == [0.0, 0.0, 1e-3, 1e-3]
    assert [case.output.history_interval for case in cases] == [1e-8, 2e-8, 1e-8, 2e-8]


def test_a_sweep_with_wrong_arguments_is_refused(tmp_path):
    with pytest.raises(hydro2d.StudyError, match="give `axes`, the keys to vary"):
        hydro2d.sweep(hydro2d.Deck.from_toml(tubes.TUBE))
    for axes, error in (({"body.low.pressure": "0.1"}, "expected a list of values, is '0.1'"), ({"": [1]}, "a key is empty"),
                        ({"body.low.pressure": ["low"]}, "no case has a valid deck")):
        with pytest.raises(hydro2d.StudyError, match=error):
            hydro2d.sweep(tubes.write(tmp_path).with_name("tube.toml"), axes, directory=tmp_path / "out")
    for options, error in (({"workers": 0}, "workers = 0"), ({"threads": -1}, "threads = -1"),
                           ({"overrides": "a=1"}, "not the text")):
        with pytest.raises(hydro2d.StudyError, match=error):
            hydro2d.sweep(tubes.write(tmp_path), directory=tmp_path / "out", **options)
    with pytest.raises(hydro2d.StudyError, match="no deck has the key body.low.colour"):
        hydro2d.sweep(tubes.write(tmp_path).with_name("tube.toml"), {"body.low.colour": [1]}, directory=tmp_path / "out")


# ---------------------------------------------------------------------------------------------------- plain numbers, threads


#: the deck of the shot, without the line that lets numbers be in SI units
WITH_UNITS = TEXT.replace('numbers = "SI"\n', "")


@pytest.mark.parametrize(("changes", "said"), [
    ({"body.rod.radius": 2.5}, r'2.5: body\[0\].radius: 2.5 has no unit; write "2.5 mm" \(or numbers = "SI"'),
    ({"stop.time": 60}, 'stop.time: 60 has no unit; write "60 us"'),
    ({"body.rod.velocity": 1086.0}, 'write "1086 m/s"'),
    ({"mesh.z": [{"to": 40, "cells": 20}]}, r"mesh.z\[0\].to: 40 has no unit"),
    ({"gauge": [{"name": "a", "r": np.float64(3.0), "z": 0.0}]}, r"gauge\[0\].r: 3 has no unit"),
])
def test_a_number_that_lacks_its_unit_is_refused(changes, said):
    with pytest.raises(hydro2d.DeckError, match=said):
        hydro2d.Deck.from_toml(WITH_UNITS, changes)


def test_a_ball_of_radius_two_and_a_half_is_refused_in_a_dict_and_an_axis(tmp_path):
    deck = hydro2d.Deck.from_toml(WITH_UNITS)
    tables = tomllib.loads(WITH_UNITS)
    tables["body"][0]["radius"] = 2.5
    with pytest.raises(hydro2d.DeckError, match=r"^shot: body\[0\].radius: 2.5 has no unit"):
        hydro2d.Deck.from_dict(tables, name="shot")
    with pytest.raises(hydro2d.StudyError, match=r"no case has a valid deck; .*body\[0\].radius: 0.002 has no unit"):
        hydro2d.sweep(deck, {"body.rod.radius": [2e-3, 2.5]}, directory=tmp_path)


def test_numbers_of_programs_are_in_si_where_they_say_so():
    changes = {"body.rod.radius": 2e-3, "stop.speed_below": 5, "body.rod.velocity": np.float64(5.0), "stop.time": 1e-5}
    for loaded in (hydro2d.Deck.from_toml(WITH_UNITS, {"numbers": "SI", **changes}),
                   hydro2d.Deck.from_toml('numbers = "SI"\n' + WITH_UNITS, changes),
                   hydro2d.Deck.from_dict({"numbers": "SI", **tomllib.loads(WITH_UNITS)}, changes)):
        assert (loaded.body[0].radius, loaded.stop.speed_below, loaded.body[0].velocity) == (2e-3, 5.0, (0.0, 5.0))


def test_zero_and_what_has_no_unit_need_none():
    loaded = hydro2d.Deck.from_toml(WITH_UNITS, {"body.plate.velocity": 0.0, "numerics.courant": 0.3, "mesh.r.0.cells": 20})
    assert (loaded.body[1].velocity, loaded.numerics.courant) == ((0.0, 0.0), 0.3)


def test_the_deck_of_a_run_is_a_deck(deck, shot):
    assert isinstance(shot.deck, hydro2d.Deck)
    assert shot.deck.body[0].velocity == deck.body[0].velocity
    assert shot.deck.to_toml() == deck.to_toml().replace('name = "shot"', f'name = "{shot.label}"', 1)
    assert shot.tables["stop"]["time"] == 4e-6


def test_threads_are_those_of_the_run_alone(deck, tmp_path, monkeypatch):
    from hydro2d import jit

    before, seen = jit.threads(), []
    columns = {"threads": lambda sim: seen.append(jit.threads()) or 1.0}
    hydro2d.run(deck, tmp_path / "one", threads=1, quiet=True, columns=columns)
    assert set(seen) == {1}
    assert jit.threads() == before
    with pytest.raises(hydro2d.Error, match=r"threads = 99: this process can use from 1 to"):
        hydro2d.run(deck, tmp_path / "many", threads=99)
    assert not (tmp_path / "many").exists()


def test_reprs_are_short(deck, shot):
    from hydro2d.study.records import study_directory

    assert repr(deck) == str(deck)
    assert len(repr(deck)) < 120
    assert repr(deck.stop) == str(deck.stop) == "Stop(time=4e-06, body='rod', speed_below=55.0)"
    assert len(repr(deck.body[0])) < 250
    assert repr(study_directory.gather([shot.directory])).endswith(": 1 case, 1 ended>")
    study = hydro2d.open_study(shot.directory)
    assert isinstance(study, hydro2d.Study)
    assert len(repr(study.cases[0])) < 250
    assert len(repr(shot)) < 120
    assert repr(shot.view()).startswith("<View: a page of ")


# ---------------------------------------------------------------------------------------------------- extras


def test_without_xarray_the_extra_is_named(shot, monkeypatch):
    """Results are read without it; functions that need it name the extra that brings it."""
    monkeypatch.setitem(sys.modules, "xarray", None)
    assert shot.history["time"].size > 1
    assert shot.to_pandas().size > 1
    for wanted in (lambda: shot.to_xarray(), lambda: shot.fields):
        with pytest.raises(ImportError, match=r"needs xarray, which is not installed: pip install 'hydro2d\[data\]'"):
            wanted()
