"""Quantities drawn in a report are found by name, and chosen sensibly where no name is given."""

import shutil

import numpy as np
import pytest

from hydro2d.study.ensemble.contents import collect
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.records import responses, study_directory, table
from hydro2d.study.report import charts, panels, residual, run_series, theory
from tests.study import fake

SPHERE = "problems/shapes/sphere.toml"
VELOCITIES = fake.velocities(1086, 1200)
LAWS = {name: (f"numerics.courant={number}",) for name, number in (("soft", 0.4), ("hard", 0.5))}


def study(folder, axes):
    return collect(study_directory.load(fake.write_study(folder / "study", axes)))


def chosen(contents, **options):
    return responses.choose(contents.study, contents.records, **options)


def label(axis):
    """An axis of a study as a variable."""
    cases = tuple(study_directory.Case(value, None, {axis.name: value}) for value in axis.values)
    return responses.of_axis(axis, study_directory.Study(None, "", "", (axis,), cases))


@pytest.mark.parametrize(
    ("values", "title", "numbers"),
    [
        (("0.4 mm", "0.8 mm"), "size [mm]", [0.4, 0.8]),
        (("800 um", "0.4 mm"), "size [m]", [8e-4, 4e-4]),
        (("4", "12"), "size", [4.0, 12.0]),
        (("-1e3 m/s", "2e3 m/s"), "size [m/s]", [-1000.0, 2000.0]),
        (("4", "none"), "size", None),
        (("4 mm", "4"), "size", None),
        (("4 mm", "4 us"), "size", None),
        (("5083-1086", "7039-1038"), "size", None),
    ],
)
def test_labels_are_numbers_where_all_of_them_are_of_one_quantity(values, title, numbers):
    variable = label(study_directory.Axis("size", None, values))
    assert variable.title == title
    assert variable.order == (values if numbers is None else None)
    assert list(variable.values.values()) == (list(values) if numbers is None else pytest.approx(numbers))


@pytest.mark.parametrize(
    ("axes", "x", "labels"),
    [
        ({"velocity": VELOCITIES, "law": LAWS}, "velocity", ["soft", "hard"]),
        (
            {"law": LAWS, "courant": {"0.3": ("numerics.courant=0.3",), "0.6": ("numerics.courant=0.6",)}},
            "courant",
            ["soft", "hard"],
        ),
        ({"law": LAWS}, "law", ["hydro2d"]),
    ],
)
def test_usually_x_is_the_velocity_then_numbers_then_words(tmp_path, axes, x, labels):
    contents = study(tmp_path, axes)
    choice = chosen(contents)
    assert choice.x.name == x
    assert [y.name for y in choice.y] == ["penetration_depth_m"]
    assert [each.label for each in panels.panels(contents, choice)[0].series] == labels


def test_names_choose(tmp_path):
    contents = study(tmp_path, {"velocity": VELOCITIES, "law": LAWS})
    choice = chosen(contents, x="numerics.courant", y=["rod_length_m", "rod_length_ratio", "conservation.mass.rod"], by=["law"])
    assert sorted(set(choice.x.values.values())) == [0.4, 0.5]
    assert [y.title for y in choice.y] == ["projectile length [cm]", "final / initial length", "conservation mass rod"]
    first = contents.records[0]
    assert choice.y[0].value(first) == pytest.approx(fake.LENGTH * 0.99 * 100)
    assert choice.y[1].value(first) == pytest.approx(0.99)
    assert chosen(contents, x="cycles").x.values["1086m-s_soft"] == 1000
    assert [each.label for each in run_series.grouped(contents.records, contents.study.axes, choice)] == ["soft", "hard"]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"y": ["penetration_dept_m"]}, '--y: unknown response "penetration_dept_m"; did you mean "penetration_depth_m"?'),
        ({"y": ["regime"]}, "--y: unknown response"),
        ({"x": "velocty"}, '--x: unknown axis, deck key or number of the runs "velocty"; did you mean "velocity"?'),
        ({"by": ["lav"]}, '--by: unknown axis, deck key or number of the runs "lav"; did you mean "law"?'),
    ],
)
def test_a_wrong_name_is_said_with_the_nearest(tmp_path, options, said):
    contents = study(tmp_path, {"velocity": VELOCITIES, "law": LAWS})
    with pytest.raises(StudyError) as caught:
        chosen(contents, **options)
    assert said in str(caught.value)


def test_runs_at_one_velocity_are_a_strip_with_the_models_at_that_velocity(tmp_path):
    for name, depth in (("a", 0.30), ("b", 0.31), ("c", 0.28)):
        fake.write_run(tmp_path / "runs" / name, 1086.0, depth)
    contents = collect(study_directory.load(tmp_path / "runs"))
    choice = chosen(contents)
    assert (choice.x.name, choice.x.order) == ("case", ("a", "b", "c"))
    (panel,) = panels.panels(contents, choice)
    curves, left, _ = panels._models(choice.x, choice.y[0], panel)
    figure = charts.response(panel.setup, panel.series, choice.x, choice.y[0], contents.belonging, panel.shots, curves, left)
    traces = {trace.name or trace.meta: trace for trace in figure.data}
    runs = next(trace for trace in figure.data if trace.name == panel.series[0].label)
    assert dict(zip(runs.x, runs.y, strict=True)) == pytest.approx({"a": 30.0, "b": 31.0, "c": 28.0})
    assert runs.mode == "markers", "no line joins cases"
    (tate,) = (curve for curve in curves if curve.name == "tate")
    assert tate.velocity.tolist() == [1086.0]
    level = traces[tate.title]
    assert level.x == ("a", "b", "c")
    assert level.y == pytest.approx([100 * tate.depth[0]] * 3, rel=1e-4)
    single = fake.write_run(tmp_path / "alone" / "a", 1086.0, 0.3)
    assert chosen(collect(study_directory.load(single.parent))).x.impact, "one run alone stays at its velocity"


def test_combinations_of_axes_at_one_velocity_have_a_strip_of_depths(tmp_path):
    """A row for each combination, with the depths of all of its runs, next to the figure against an axis."""
    axes = {"law": LAWS, "courant": {"0.3": ("numerics.courant=0.3",), "0.6": ("numerics.courant=0.6",)}}
    contents = study(tmp_path, axes)
    (panel,) = panels.panels(contents, choice := chosen(contents))
    rows = panels._rows(contents, choice, panel)
    order = ("soft, courant 0.3", "soft, courant 0.6", "hard, courant 0.3", "hard, courant 0.6")
    assert rows.order == order
    y = choice.y[0]
    curves, _, _ = panels._models(rows, y, panel)
    figure = charts.strip(panel.series, rows, y, contents.belonging, curves)
    assert figure.layout.yaxis.ticktext == tuple("<br>".join(word.rsplit(" ", 1)) if len(word) > 20 else word for word in order)
    runs = [trace for trace in figure.data if trace.legendgroup and trace.meta is None]
    depths = {order[row]: depth for trace in runs for row, depth in zip(trace.y, trace.x, strict=True)}
    assert depths == pytest.approx({rows.value(each): y.value(each) for each in contents.records})
    (tate,) = (trace for trace in figure.data if str(trace.name).startswith("Tate-Alekseevskii: "))
    depth = next(each.depth[0] for each in curves if each.name == "tate")
    assert tate.x == pytest.approx([100 * depth] * 2, rel=1e-4)
    assert tate.y == (-0.5, 3.5)
    assert figure.layout.xaxis.range[1] > 49.0, "the rigid rod's line is seen"
    (chart,) = (each for each in panels.draw(contents, choice) if each.name.startswith("strip"))
    assert "at 1086 m/s, a row for each combination of law, courant" in chart.caption


def test_a_strip_of_ensembles_has_bars_across(tmp_path):
    fake.write_study(tmp_path / "study", {"law": LAWS, "mesh": {"a": (), "b": ()}}, repeats=3)
    contents = collect(study_directory.load(tmp_path / "study"))
    (panel,) = panels.panels(contents, choice := chosen(contents))
    figure = charts.strip(panel.series, panels._rows(contents, choice, panel), choice.y[0], contents.belonging, ())
    medians = [trace for trace in figure.data if trace.error_x.array is not None]
    assert sum(len(trace.x) for trace in medians) == 4
    assert all(trace.error_y.array is None for trace in figure.data)


@pytest.mark.parametrize("axes", [
    {"law": LAWS},  # a figure against words is a strip already
    {"velocity": VELOCITIES, "law": LAWS},
])
def test_no_second_strip(tmp_path, axes):
    contents = study(tmp_path, axes)
    assert not [each for each in panels.draw(contents, chosen(contents)) if each.name.startswith("strip")]


def test_the_motions_of_models_are_drawn_with_the_histories(tmp_path):
    for name, velocity in (("a", 1086.0), ("b", 1086.0), ("c", 1200.0)):
        fake.write_run(tmp_path / "runs" / name, velocity, 0.3, text=fake.deck_text(f"body.rod.velocity={velocity} m/s"))
    contents = collect(study_directory.load(tmp_path / "runs"))
    (panel,) = panels.panels(contents, chosen(contents))
    motions = panels._motions(panel, panel.members)
    assert list(motions) == [1086.0, 1200.0]
    depths = {curve.title: curve.depth[0] for curve in theory.curves(panel.members[0].shot, 1086.0, 1086.0)}
    touch, by = motions[1086.0]
    assert 0.0 <= touch < 5e-6
    assert list(by) == ["Forrestal's rigid rod", "Tate-Alekseevskii", "Walker-Anderson"]
    assert {name: motion.depth[-1] for name, motion in by.items()} == pytest.approx({name: depths[name] for name in by})
    lines = [trace for trace in charts.histories(panel.series, motions).data if trace.meta == "model"]
    depth = next(trace for trace in lines if trace.name == "Tate-Alekseevskii, 1086 m/s")
    assert depth.y[-1] == pytest.approx(100 * depths["Tate-Alekseevskii"], rel=1e-5)
    assert depth.x[-1] == pytest.approx(1e6 * (touch + by["Tate-Alekseevskii"].time[-1]), rel=1e-5)
    assert len({(trace.name, trace.line.dash, trace.opacity) for trace in lines if trace.showlegend}) == 6
    assert {trace.line.dash for trace in lines if "Tate" in trace.name} == {"dash"}, "a model has its own dashes"
    assert {trace.opacity for trace in lines if "1200" in trace.name} == {1.0}
    assert len([trace for trace in lines if "Forrestal" in trace.name]) == 2 * 2, "its rod has no length"
    caption = list(panels.draw(contents, chosen(contents)))[-1].caption
    assert "Grey: Forrestal's rigid rod, Tate-Alekseevskii, Walker-Anderson, from" in caption


def test_a_motion_is_drawn_only_where_its_model_applies(tmp_path):
    """No rigid rod for one that erodes; no motion beyond the rear of the target."""
    fake.write_run(tmp_path / "runs" / "a", 1086.0, 0.3, regime="eroding")
    (panel,) = panels.panels(contents := collect(study_directory.load(tmp_path / "runs")), chosen(contents))
    _, by = panels._motions(panel, panel.members)[1086.0]
    assert list(by) == ["Tate-Alekseevskii", "Walker-Anderson"]
    assert ": 1 run, " in list(panels.draw(contents, chosen(contents)))[-1].caption
    shot = panel.members[0].shot
    whole, thin = (theory.motions(shot, 1086.0, eroding=False, thickness=each) for each in (None, 0.1))
    for name, motion in thin.items():
        assert motion.depth[-1] == pytest.approx(0.1)
        assert len(motion.time) > 2
        for column in ("time", "velocity"):
            through = np.interp(0.1, whole[name].depth, getattr(whole[name], column))
            assert getattr(motion, column)[-1] == pytest.approx(through)


def test_an_unfinished_run_has_the_last_of_its_history(tmp_path):
    run = fake.write_run(tmp_path / "runs" / "a", 1086.0, 0.3)
    (run / "summary.json").unlink()
    (run / "restart.h5").touch()
    collected = collect(study_directory.load(tmp_path / "runs")).records[0]
    assert collected.unfinished == "interrupted"
    assert responses.raw(collected, "rod_tail_velocity_m_s") == pytest.approx(0.0)
    assert responses.raw(collected, "rod_residual_velocity_m_s") is None
    assert collected._as_in_summary("body_rod_velocity_m_s") == "bodies.rod.velocity_m_s"


def perforations(folder, shots, **summary):
    """Runs of the sphere at velocities in m/s with residual velocities in m/s, None for one that is stopped."""
    for velocity, left in shots:
        text = fake.resolved(SPHERE, f"body.sphere.velocity={velocity} m/s", "body.plate.thickness=4 mm")
        through = {"rod_residual_velocity_m_s": left, "exit_time_s": 1e-5, "stop_reason": "perforation of plate"}
        fake.write_run(folder / f"{velocity:g}", velocity, 0.003, text=text, **(through if left else {}), **summary)
    return collect(study_directory.load(folder))


def lambert_jonas(velocity, a=0.9, p=2.5, limit=500.0):
    return a * (velocity**p - limit**p) ** (1 / p)


def test_spheres_get_all_but_the_models_of_rods(tmp_path):
    contents = perforations(tmp_path / "runs", [(400, None), *((v, lambert_jonas(v)) for v in (600, 800, 1000, 1200))])
    record = contents.records[-1]
    assert record.setup.words == "steel_4340_rod sphere (16 mm) into 0.4 cm of Al5083"
    assert "the models need a rod" in record.without_models
    assert record.problems == []
    choice = chosen(contents)
    assert [y.name for y in choice.y] == ["penetration_depth_m", "rod_residual_velocity_m_s"]
    charts = list(panels.draw(contents, choice))
    assert [each.heading.split(":")[0] for each in charts] == ["Depth", "Residual velocity", "Histories"]
    assert "the models need a rod" in charts[0].notes[0]


def test_models_of_the_residual_velocity_are_fitted_to_the_study(tmp_path):
    contents = perforations(tmp_path / "runs", [(480, None), *((v, lambert_jonas(v)) for v in (520, 600, 800, 1000, 1200))])
    curves, notes = residual.curves(sorted(contents.records, key=lambda each: each.velocity), 400.0, 1200.0)
    assert [curve.title for curve in curves] == ["Lambert-Jonas", "Recht-Ipson, plug", "Recht-Ipson, no plug"]
    assert curves[0].residual[-1] == pytest.approx(lambert_jonas(1200), rel=1e-3)
    assert curves[2].residual[-1] == pytest.approx((1200**2 - 500**2) ** 0.5)
    assert "a = 0.900, p = 2.5, ballistic limit 500 m/s" in notes[0]
    assert "limit of 500 m/s, midway between 480 m/s, stopped, and 520 m/s, through" in notes[1]
    plug = 2660 * 3.14159265 / 4 * 0.016**2 * 0.004 / fake.MASS
    assert f"has {plug:.2g} of its mass" in notes[1]
    assert curves[1].residual[-1] == pytest.approx(curves[2].residual[-1] / (1 + plug), rel=0.02)


def test_measured_residual_velocities_are_drawn_with_those_of_the_runs(tmp_path):
    runs = tmp_path / "runs"
    for velocity, left, measured in ((600, 500.0, 470.0), (900, 820.0, 835.0), (400, 0.0, 0.0), (700, 610.0, None)):
        shot = [f"body.sphere.velocity={velocity} m/s", "body.plate.thickness=4 mm"]
        if measured is not None:
            shot += ["experiment.source=made up", f"experiment.velocity={velocity} m/s",
                     f"experiment.residual_velocity={measured} m/s"]
        through = {"rod_residual_velocity_m_s": left, "exit_time_s": 1e-5, "stop_reason": "perforation of plate"}
        fake.write_run(runs / f"{velocity}", velocity, 0.003, text=fake.resolved(SPHERE, *shot), **(through if left else {}))
    contents = collect(study_directory.load(runs))
    rows = {run.velocity_m_s: (run.experiment_residual_m_s, run.residual_error_m_s) for run in contents.table.itertuples()}
    assert rows == {600: (470.0, 30.0), 900: (835.0, -15.0), 400: (0.0, 0.0), 700: (None, None)}
    choice = chosen(contents)
    columns = table.columns_of_results(contents.study, contents.table, choice)
    heads = [column.head for column in columns]
    assert heads[heads.index("Residual velocity [m/s]") :][1:3] == ["Experiment [m/s]", "Error [m/s]"]
    chart = next(each for each in panels.draw(contents, choice) if each.heading.startswith("Residual"))
    assert "Experiments: 400 m/s 0 m/s; 600 m/s 470 m/s; 900 m/s 835 m/s." in chart.alt
    panel = panels.panels(contents, choice)[0]
    figure = charts.response(panel.setup, panel.series, choice.x, choice.y[1], contents.belonging, panel.shots, (), ())
    marks = next(trace for trace in figure.data if trace.meta == "experiment")
    assert sorted(zip(marks.x, marks.y, strict=True)) == [(400, 0.0), (600, 470.0), (900, 835.0)]


@pytest.mark.parametrize(
    ("shots", "titles", "said"),
    [
        ([(600, 300.0)], [], "a fit of 3 constants needs perforations at 3 or more velocities"),
        ([(500, None), (600, 300.0)], ["Recht-Ipson, plug", "Recht-Ipson, no plug"], "Lambert-Jonas is not drawn"),
        ([(600, 300.0), (800, 600.0)], ["Lambert-Jonas", "Recht-Ipson, plug", "Recht-Ipson, no plug"], "p = 2 taken"),
        ([(500, None)], [], "Recht-Ipson is not drawn: it needs a ballistic limit"),
    ],
)
def test_a_model_is_drawn_where_it_can_be_had(tmp_path, shots, titles, said):
    curves, notes = residual.curves(perforations(tmp_path / "runs", shots).records, 400.0, 900.0)
    assert [curve.title for curve in curves] == titles
    assert said in " ".join(notes)


def test_setups_share_a_figure_where_their_series_distinguish_them(tmp_path):
    axes = {"velocity": fake.velocities(900, 1000), "length": {"60 mm": ("body.rod.length=60 mm", "tracer=[]"),
                                                               "80 mm": ("body.rod.length=80 mm", "tracer=[]")}}
    contents = study(tmp_path, axes)
    drawn = panels.panels(contents, chosen(contents))
    assert [[each.label for each in panel.series] for panel in drawn] == [["length 60 mm", "length 80 mm"]]
    assert drawn[0].setup is None
    assert "several geometries" in list(panels.draw(contents, chosen(contents)))[0].notes[0]
    shutil.rmtree(tmp_path / "study")
    shots = {"short": ("body.rod.velocity=900 m/s", "body.rod.length=60 mm", "tracer=[]"),
             "long": ("body.rod.velocity=1000 m/s",)}
    for name, overrides in shots.items():
        fake.write_run(tmp_path / "runs" / name, 950.0, text=fake.deck_text(*overrides))
    contents = collect(study_directory.load(tmp_path / "runs"))
    drawn = panels.panels(contents, chosen(contents, by=["numerics.courant"]))
    assert [len(panel.members) for panel in drawn] == [1, 1]


def test_runs_without_a_projectile_are_drawn_by_their_first_body(tmp_path):
    bodies = {"bodies": {"gas": {"velocity_m_s": 12.0, "z_max_m": 0.4}}}
    for number in (1, 2):
        text = fake.resolved("problems/verification/sod_z.toml", f"numerics.courant=0.{number}")
        fake.write_run(tmp_path / "runs" / str(number), text=text, stop_reason="end time", **bodies)
    contents = collect(study_directory.load(tmp_path / "runs"))
    assert [each.unfinished for each in contents.records] == ["", ""]
    choice = chosen(contents)
    assert (choice.x.name, [y.name for y in choice.y]) == ("case", ["bodies.gas.velocity_m_s", "bodies.gas.z_max_m"])
    assert [each.heading for each in panels.draw(contents, choice)] == ["Bodies gas velocity: runs", "Bodies gas z max: runs"]
    assert chosen(contents, x="numerics.courant", y=["time_s"]).x.values == {"1": 0.1, "2": 0.2}
