"""The page shows the contents of the runs, and names those that could not be read; it is one well-formed file."""

import csv
import json
import shutil
import sys
from types import SimpleNamespace

import pytest

from hydro2d.analytic import experience
from hydro2d.base.version import __version__
from hydro2d.cli.main import call
from hydro2d.results import movies
from hydro2d.results.scales import FigureError
from hydro2d.study.ensemble.contents import collect
from hydro2d.study.records import study_directory
from hydro2d.study.report import page as report_page
from hydro2d.study.report import pictures
from hydro2d.study.report.report import report
from tests.study import fake
from tests.study.html import Page

AXES = {
    "velocity": fake.velocities(1086, 1200, 1290),
    "advection": {"ke": ("numerics.advection=ke",), "momentum": ("numerics.advection=momentum",)},
}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A study of six cases and the folder of its report."""
    study = fake.write_study(tmp_path_factory.mktemp("made") / "study", AXES, "Depth <against> velocity")
    said = []
    report([study], say=said.append)
    return study, said


@pytest.fixture
def study(made, tmp_path):
    """A copy of the study, to be spoiled."""
    shutil.copytree(made[0], tmp_path / "study", ignore=shutil.ignore_patterns("report"))
    return tmp_path / "study"


def page_of(directory, **options):
    said = []
    file = report([directory], say=said.append, **options)
    return Page(file.read_text(encoding="utf-8")), said


def charts(page):
    """The ids of the figures that respond to a pointer."""
    return [attributes["id"] for attributes in page.all("div") if attributes.get("class") == "plotly-graph-div"]


def table(folder):
    with open(folder / "cases.csv", newline="", encoding="utf-8") as file:
        return {row["case"]: row for row in csv.DictReader(file)}


def test_one_well_formed_file(made):
    text = (made[0] / "report" / "report.html").read_text(encoding="utf-8")
    page = Page(text)
    assert page.faults == []
    assert page.all("html") == [{"lang": "en"}]
    assert {"name": "viewport", "content": "width=device-width, initial-scale=1"} in page.all("meta")
    assert f"Depth <against> velocity hydro2d {__version__}" in page.text
    assert "6 cases: 6 done." in page.text
    assert len(page.all("img")) == len(list((made[0] / "report").glob("*.png"))) == 1
    assert charts(page) == ["penetration_depth_m-W_alloy-into-Al5083-hemispherical-nose",
                            "histories-W_alloy-into-Al5083-hemispherical-nose"]
    assert len(page.all("table")) == len(page.all("caption")) == 4


@pytest.mark.parametrize("spoilt", ["<p>", "</td>", '<a href="https://somewhere">x</a>', '<p id="results"></p>', "<img>"])
def test_faults_are_found(made, spoilt):
    text = (made[0] / "report" / "report.html").read_text(encoding="utf-8")
    assert Page(text.replace("</main>", f"{spoilt}</main>")).faults != []


def test_the_experience_with_such_runs(made):
    """Four of the made-up rods end rigid, two deformed, and the line of each kind says so."""
    text = Page((made[0] / "report" / "report.html").read_text(encoding="utf-8")).text
    rows = {row["case"]: row["regime"] for row in table(made[0] / "report").values()}
    for regime in set(rows.values()):
        number = list(rows.values()).count(regime)
        (known,) = [row for row in experience.table() if (row.of, row.kind, row.chosen) == (
            "hydro2d", f"depth of {regime} tungsten rods in aluminium", False)]
        many = "" if number == len(rows) else f": {number} of {len(rows)} runs"
        assert f"experience: {known.words}{many}" in text


def test_experience_of_all_runs_has_no_number_of_runs():
    def contents(*lines):
        return SimpleNamespace(records=[SimpleNamespace(experience=list(each)) for each in lines])

    assert report_page._experience(contents(["a"], ["a"], [])) == ["a"]
    assert report_page._experience(contents(["a", "b"], ["a"])) == ["a", "b: 1 of 2 runs"]
    assert report_page._experience(contents([], [])) == []


def test_unfinished_runs_have_no_experience(study):
    fake.edit_json(study / "cases" / "1086m-s_ke" / "summary.json", status="unphysical")
    record = next(each for each in collect(study_directory.load(study)).records if each.case.name == "1086m-s_ke")
    assert (record.experience, bool(record.unfinished)) == ([], True)


def test_the_table(made):
    rows = table(made[0] / "report")
    assert list(rows) == ["1086m-s_ke", "1086m-s_momentum", "1200m-s_ke", "1200m-s_momentum", "1290m-s_ke", "1290m-s_momentum"]
    row = rows["1200m-s_ke"]
    assert (row["velocity"], row["advection"], row["status"]) == ("1200 m/s", "ke", "done")
    assert float(row["depth_m"]) == pytest.approx(0.348)
    assert float(row["rod_length_ratio"]) == pytest.approx(1 - 0.012)
    assert float(row["rod_radius_ratio"]) == pytest.approx(1 + 0.012)
    assert float(row["mass_change_worst"]) == 1e-14
    assert float(row["sink_advection_share"]) == pytest.approx(300 / 37000)
    assert (row["cycles"], row["wall_s"], row["ns_per_cell_cycle"]) == ("1000", "321.3", "120.0")
    page = Page((made[0] / "report" / "report.html").read_text(encoding="utf-8"))
    assert "1200m-s_ke 1200 m/s ke 34.8 20.0 +14.8 +74 0.988 1.01 rigid done" in page.text
    assert "advection 0.81 %; outflow 0.032 % 600" in page.text  # the cutoff's is below the smallest share named


def test_a_run_is_compared_with_the_experiment_of_its_velocity(made):
    """All cases come from the deck of the shot at 1086 m/s; there is a shot at 1200, and one at 1296 within 0.5 % of 1290."""
    rows = table(made[0] / "report")
    assert [float(rows[name]["experiment_depth_m"]) for name in ("1086m-s_ke", "1200m-s_ke", "1290m-s_ke")] == pytest.approx(
        [0.448, 0.2, 0.216])
    assert "shot 4345" in rows["1200m-s_ke"]["experiment_source"]
    assert float(rows["1086m-s_ke"]["depth_error_m"]) == pytest.approx(0.35 - 0.448)
    assert float(rows["1086m-s_ke"]["depth_error_percent"]) == pytest.approx(100 * (0.35 / 0.448 - 1))
    assert made[1][0].startswith("wrote ")


def test_provenance_and_decks(made):
    text = Page((made[0] / "report" / "report.html").read_text(encoding="utf-8")).text
    assert "c0ffee, with local changes" in text
    assert "hydro2d run <deck> & more" in text
    assert "numerics.advection ke advection = ke (3) momentum advection = momentum (3)" in text
    assert "body.rod.velocity [0, 1086] velocity = 1086 m/s (2)" in text
    assert "numerics.courant 0.7" in text.split("What all 6 decks share")[1]


def test_cases_that_are_not_done_are_shown(study):
    case = study / "cases" / "1086m-s_ke"
    fake.edit_json(case / "summary.json", status="unphysical", stop_reason="density -1 kg/m3")
    shutil.rmtree(study / "cases" / "1200m-s_ke")
    (study / "cases" / "1290m-s_ke" / "summary.json").unlink()
    (study / "cases" / "1290m-s_ke" / "restart.h5").touch()
    page, _ = page_of(study)
    assert page.faults == []
    assert "6 cases: 1 unphysical, 3 done, 1 waiting, 1 interrupted." in page.text
    assert "unphysical unfinished density -1 kg/m3" in page.text
    rows = table(study / "report")
    assert (rows["1086m-s_ke"]["depth_m"], rows["1086m-s_ke"]["depth_error_m"]) == ("0.35", "")
    assert rows["1200m-s_ke"]["depth_m"] == ""
    assert float(rows["1290m-s_ke"]["depth_m"]) == pytest.approx(0.346)  # of the history
    assert "3 of 5 runs have ended; open marks: 2 unfinished" in page.text
    assert [rows[name]["unfinished"] for name in ("1086m-s_ke", "1290m-s_ke", "1290m-s_momentum")] == [
        "unphysical", "interrupted", ""]


def test_a_study_that_has_not_begun(study):
    shutil.rmtree(study / "cases")
    page, _ = page_of(study)
    assert page.faults == []
    assert "6 cases: 6 waiting." in page.text
    assert "There is no figure" in page.text
    assert [row["velocity"] for row in table(study / "report").values()][::2] == ["1086 m/s", "1200 m/s", "1290 m/s"]


@pytest.mark.parametrize(
    ("file", "said"),
    [
        ("history.h5", "is damaged, or not a history file"), ("deck.toml", "deck.toml cannot be read"),
        ("interfaces.pvd", "is not a series of VTK files"), ("vtk/interfaces_000001.vtp", "is not a VTK file of a run"),
    ],
)
@pytest.mark.filterwarnings("ignore")
def test_unreadable_runs_are_reported_and_the_rest_is_made(study, file, said):
    (study / "cases" / "1086m-s_ke" / file).write_bytes(b"\x89HDF half a file")
    page, lines = page_of(study)
    assert page.faults == []
    assert any(line.startswith("warning: 1086m-s_ke: ") and said in line for line in lines)
    assert "Not everything could be used" in page.text
    assert said in page.text
    assert (len(page.all("img")), len(charts(page))) == (1, 2)
    assert len(table(study / "report")) == 6


def test_a_perforated_plate_is_a_bound(tmp_path):
    """A rod that perforated and left the mesh: its depth is at least the thickness, whatever was measured last."""
    ogive = ("body.rod.nose=ogival", "body.rod.crh=2.5", "body.rod.length=101.346 mm")
    run = fake.write_run(tmp_path / "runs" / "through", 1227.0, 0.54, overrides=ogive)
    fake.edit_json(run / "summary.json", penetration_depth_m=0.0)
    fake.write_run(tmp_path / "runs" / "stopped", 1227.0, 0.40, overrides=ogive)
    fake.write_run(tmp_path / "runs" / "slow", 923.0, 0.54, overrides=ogive)
    page, _ = page_of(tmp_path / "runs")
    rows = table(tmp_path / "runs" / "report")
    depths = {name: (row["depth_m"], row["depth_is"], row["depth_error_is"]) for name, row in rows.items()}
    assert depths == {"through": ("0.5334", "at least", "none"), "stopped": ("0.4", "computed", "at most"),
                      "slow": ("0.5334", "at least", "at least")}
    assert "1227 40.0 ≥ 53.3 ≤ −13.3 ≤ −25" in page.text
    assert "923 ≥ 53.3 41.7 ≥ +11.6 ≥ +28" in page.text
    assert "≥ 53.3 ≥ 53.3 reached reached" in page.text


def test_a_rod_that_left_the_mesh_has_gone_at_least_so_deep(tmp_path):
    fake.write_run(tmp_path / "runs" / "out", 1086.0, 0.30, regime="left the mesh")
    page, _ = page_of(tmp_path / "runs")
    row = table(tmp_path / "runs" / "report")["out"]
    assert (row["depth_m"], row["regime"]) == ("0.3", "left the mesh")
    assert (row["depth_is"], row["depth_error_is"]) == ("at least", "at least")
    assert "≥ 30.0" in page.text


def test_an_experiment_at_an_unknown_velocity_is_compared_with_nothing(tmp_path):
    """Another rod than the catalogue's: its experiment was measured at one velocity, and two are run."""
    short = ("body.rod.length=60 mm", "tracer=[]")
    for speed in (1000, 1200):
        deck = fake.write_run(tmp_path / "runs" / f"v{speed}", speed, overrides=short) / "deck.toml"
        deck.write_text(deck.read_text() + '\n[experiment]\npenetration = 0.448\nsource = "a laboratory"\n')
    page, lines = page_of(tmp_path / "runs")
    assert "experiment.velocity in a deck says" in lines[0]
    assert "experiment.velocity in a deck says" in page.text
    assert {row["depth_error_m"] for row in table(tmp_path / "runs" / "report").values()} == {""}
    shutil.rmtree(tmp_path / "runs")
    for speed in (1000, 1200):
        fake.write_run(tmp_path / "runs" / f"v{speed}", speed, 0.4, overrides=(*short, "experiment.velocity=1200 m/s"))
    _, lines = page_of(tmp_path / "runs")
    rows = table(tmp_path / "runs" / "report")
    assert lines[0].startswith("wrote")
    assert rows["v1000"]["depth_error_m"] == ""
    assert float(rows["v1200"]["depth_error_m"]) == pytest.approx(0.4 - 0.448)


def test_a_run_of_a_version_with_other_names_is_read(tmp_path):
    """Its deck has the old keys, its summary the old names of the audited quantities."""
    old = fake.write_run(tmp_path / "runs" / "v1086")
    text, audit = (old / "deck.toml").read_text(), json.loads((old / "summary.json").read_text())["conservation"]
    text = text.replace("\ncutoff = ", "\ntrace = ").replace("\nstrength_cutoff = ", "\nloose = ")
    fake.write_run(tmp_path / "old" / "v1086", text=text, conservation={
        **audit, "sinks": {"traces": audit["sinks"].pop("cutoff"), **audit["sinks"]},
        "exchanges": {"light vertices": {"momentum_N_s": 0.0, "energy_J": 1.0}},
    })
    (_, lines), (page, of_old) = page_of(tmp_path / "runs"), page_of(tmp_path / "old")
    assert page.faults == []
    assert len(of_old) == len(lines)
    rows, before = table(tmp_path / "runs" / "report")["v1086"], table(tmp_path / "old" / "report")["v1086"]
    assert before.pop("sink_traces_share") == rows.pop("sink_cutoff_share")
    assert {**before, "directory": ""} == {**rows, "directory": ""}


def test_a_wrong_deck_is_said_and_what_the_summary_has_is_drawn(tmp_path):
    run = fake.write_run(tmp_path / "runs" / "sod")
    (run / "deck.toml").write_text('name = "x"\n[mesh]\nwrong = 1\n')
    page, lines = page_of(tmp_path / "runs")
    assert "deck.toml is not a deck of this version" in lines[0]
    assert charts(page) == ["penetration_depth_m-runs"]
    assert "Depth against case: runs." in page.text
    assert page.faults == []


def test_spheres_and_runs_without_a_projectile_have_a_page(tmp_path):
    for velocity, left in ((600, 500.0), (900, 820.0), (1200, 1130.0)):
        text = fake.resolved("problems/shapes/sphere.toml", f"body.sphere.velocity={velocity} m/s", "body.plate.thickness=4 mm")
        fake.write_run(tmp_path / "spheres" / f"{velocity}", velocity, 0.003, text=text, exit_time_s=1e-5,
                       rod_residual_velocity_m_s=left, stop_reason="perforation of plate")
    page, lines = page_of(tmp_path / "spheres")
    assert page.faults == []
    assert [name.split("-")[0] for name in charts(page)] == ["penetration_depth_m", "rod_residual_velocity_m_s", "histories"]
    assert "600 600 ≥ 0.4 0.980 1.02 500 deforming done" in page.text
    assert "Lambert-Jonas, fitted to these runs" in page.text
    assert lines[0].startswith("wrote")
    assert [row["projectile"] for row in table(tmp_path / "spheres" / "report").values()] == ["sphere"] * 3
    fake.write_run(tmp_path / "sod" / "a", text=fake.resolved("problems/verification/sod_z.toml"),
                   bodies={"gas": {"velocity_m_s": 12.0, "z_max_m": 0.4}})
    page, _ = page_of(tmp_path / "sod")
    assert page.faults == []
    assert "Bodies gas velocity [m/s]" in page.text
    assert "Depth [cm]" not in page.text


def test_responses_are_chosen(study):
    page, lines = page_of(study, x="advection", y=["rod_mass_kg", "crater.volume_m3"], by=["velocity"])
    assert charts(page)[0].startswith("rod_mass_kg")
    assert "Projectile mass against advection" in page.text
    assert "Projectile mass [g]" in page.text  # a column of the table
    assert "crater.volume_m3" in table(study / "report")["1086m-s_ke"]
    assert [name for name in charts(page) if "volume" in name] == []
    assert lines[0] == "warning: no run has crater.volume_m3, so it is not drawn"


def test_a_run_that_was_cut_has_no_error(study):
    fake.edit_json(study / "cases" / "1086m-s_ke" / "summary.json", stop_reason="end time", rod_core_velocity_m_s=300.0)
    page, _ = page_of(study)
    row = table(study / "report")["1086m-s_ke"]
    reason = "reached its end time, still moving at 300 m/s"
    assert (row["status"], row["unfinished"], row["depth_error_m"], row["depth_m"]) == ("done", reason, "", "0.35")
    assert reason in page.text
    assert "done unfinished" not in page.text
    assert f"unfinished {reason}" not in page.text


@pytest.mark.parametrize(("reason", "speed", "said"), [
    ("end time", 1250.4, "reached its end time, still moving at 1250 m/s"),
    ("number of cycles", -90.6, "reached its number of cycles, still moving at 91 m/s"),
    ("speed of rod below 5 m/s", 1250.4, ""),
    ("end time", 0.9, ""),  # less than a hundredth of the impact velocity
])
def test_why_a_run_is_not_at_its_end(study, reason, speed, said):
    case = study / "cases" / "1086m-s_ke"
    fake.edit_json(case / "summary.json", stop_reason=reason, rod_core_velocity_m_s=speed)
    records = collect(study_directory.load(study)).records
    assert next(each for each in records if each.case.name == "1086m-s_ke").unfinished == said


@pytest.mark.parametrize("ending", ["gif", "mp4"])
def test_films_are_in_the_page(finished, tmp_path, monkeypatch, ending):
    if ending == "gif":
        monkeypatch.setattr("hydro2d.results.movies.has_ffmpeg", lambda: False)
    elif not movies.has_ffmpeg():
        pytest.skip("no ffmpeg is installed")
    shutil.copytree(finished, tmp_path / "runs" / "a")
    fake.write_run(tmp_path / "runs" / "b")
    page, lines = page_of(tmp_path / "runs", movie="pressure")
    assert page.faults == []
    assert "warning: b has no film: no dump was written" in lines
    film = tmp_path / "runs" / "report" / f"film_001.{ending}"
    assert film.stat().st_size < 1e6
    sources = [each["src"][:14] for each in page.all("video" if ending == "mp4" else "img")]
    assert ("data:video/mp4" if ending == "mp4" else "data:image/gif") in sources
    page_of(tmp_path / "runs")
    assert not film.exists()


def test_cases_that_have_not_begun_are_no_films_that_are_missing(tmp_path):
    """For example those that `sweep --only` has left for later."""
    study = fake.write_study(tmp_path / "study", {"velocity": fake.velocities(1086, 1200)})
    shutil.rmtree(study / "cases" / "1200m-s")
    lines = []
    with pytest.raises(FigureError, match="no film could be made"):
        list(pictures.films(collect(study_directory.load(study)), "pressure", tmp_path, lines.append))
    assert lines == ["warning: 1086m-s has no film: no dump was written"]


def test_pages_of_runs_are_linked(finished, tmp_path):
    """All existing ones; with `view` those of all runs with dumps are made, and a run without dumps is reported."""
    shutil.copytree(finished, tmp_path / "runs" / "a b")
    fake.write_run(tmp_path / "runs" / "b")
    page, _ = page_of(tmp_path / "runs")
    assert [each["href"] for each in page.all("a") if "view.html" in each.get("href", "")] == []
    page, lines = page_of(tmp_path / "runs", view=True)
    assert page.faults == []
    links = [each["href"] for each in page.all("a") if "view.html" in each.get("href", "")]
    assert links == ["../a%20b/view.html"] * 2  # in the tables of results and of conservation
    assert (tmp_path / "runs" / "a b" / "view.html").is_file()
    assert any(line.startswith("warning: b has no page of its own") for line in lines)
    page, _ = page_of(tmp_path / "runs")
    assert [each["href"] for each in page.all("a") if "view.html" in each.get("href", "")] == links


def test_derived_quantities_are_columns(tmp_path):
    formulas = '[derived]\n"P/L" = "depth / length0"\nhole_m3 = "crater_volume_m3"\n'
    text = fake.resolved("problems/shapes/sphere.toml").replace("[derived]\n", formulas)
    assert formulas in text
    fake.write_run(tmp_path / "runs" / "a", text=text, derived={"P/L": 1.25, "hole_m3": 2e-6})
    page, _ = page_of(tmp_path / "runs")
    assert page.faults == []
    row = table(tmp_path / "runs" / "report")["a"]
    assert (row["derived.P/L"], row["derived.hole_m3"]) == ("1.25", "2e-06")
    assert "P/L" in page.text
    assert "hole_m3 [m3]" in page.text


def test_pictures_of_an_earlier_report_are_removed(study, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    for name in ("rods_07.png", "depth_other_hemispherical.png", "mine.png"):
        (out / name).write_bytes(b"")
    page_of(study, out=out)
    names = {path.name for path in out.iterdir()}
    assert {"mine.png", "report.html", "cases.csv", "rods_01.png"} <= names
    assert not names & {"rods_07.png", "depth_other_hemispherical.png"}
    assert not [name for name in names if "tmp" in name]


@pytest.mark.thorough
def test_a_hundred_cases_weigh_little(tmp_path):
    axes = {"velocity": fake.velocities(*range(900, 1150, 10)), "courant": {
        str(number): (f"numerics.courant={number}",) for number in (0.3, 0.4, 0.5, 0.6)}}
    study = fake.write_study(tmp_path / "study", axes)
    page, _ = page_of(study)
    assert (study / "report" / "report.html").stat().st_size < 10e6
    assert page.faults == []
    assert len(page.all("details")) == 101
    assert "Page 6 of 6" in page.text


def test_the_command(study, tmp_path, capsys):
    assert call(["report", str(study), "--out", str(tmp_path / "out")]) == 0
    assert "report.html" in capsys.readouterr().out
    assert call(["report", str(tmp_path / "studie")]) == 2
    assert 'did you mean "study"' in capsys.readouterr().err
    assert call(["report"]) == 2
    assert call(["report", str(study), "--out", str(study / "study.json")]) == 2
    assert "is a file" in capsys.readouterr().err
    for option, what in (("--y", "response"), ("--x", "axis"), ("--by", "axis"), ("--movie", "field")):
        assert call(["report", str(study), "--out", str(tmp_path / "none"), option, "nothing"]) == 2
        assert capsys.readouterr().err.startswith(f"hydro2d: {option}: unknown {what}")
    assert not (tmp_path / "none").exists()


def test_without_plotly_the_extra_is_named_and_nothing_is_written(study, tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "plotly", None)
    monkeypatch.setitem(sys.modules, "plotly.offline", None)
    assert call(["report", str(study), "--out", str(tmp_path / "page")]) == 2
    assert "a report needs plotly, which is not installed: pip install 'hydro2d[report]'" in capsys.readouterr().err
    assert not (tmp_path / "page").exists()


def test_reading_leaves_a_study_as_it_is(study):
    before = {path: path.read_bytes() for path in study.rglob("*") if path.is_file()}
    collect(study_directory.load(study))
    assert {path: path.read_bytes() for path in study.rglob("*") if path.is_file()} == before


def test_an_axis_may_be_called_as_a_result(tmp_path):
    """The axis `cells` counts cells across a rod; the column of the summary counts those of the mesh."""
    axes = {"cells": {number: (f"numerics.courant=0.{number}",) for number in ("4", "5")}, "target": {"x": (), "y": ()}}
    study = fake.write_study(tmp_path / "study", axes)
    page, _ = page_of(study)
    row = table(study / "report")["5_y"]
    assert (row["cells (axis)"], row["cells"], row["target (axis)"], row["target"]) == ("5", "60984", "y", "Al5083")
    assert "5_y 5 y 1086" in page.text
