"""samples.csv: the same file to the byte however the runs were made; kept rows; the commands and the page of a sample."""

import csv
import itertools
import re
import signal
import time

import numpy as np
import pytest

import hydro2d
from hydro2d.cli.main import call
from hydro2d.study.plan import cases
from hydro2d.study.plan.definition import StudyError
from hydro2d.study.records import keeping, sample_table, study_directory
from hydro2d.study.report.report import report
from hydro2d.study.report.uncertain import file_names
from hydro2d.study.run import cluster, sweep
from hydro2d.study.run.case import Outcome
from hydro2d.study.run.choice import Choice
from hydro2d.study.samples import results, sobol
from hydro2d.study.samples import text as text_of
from tests.study import fake, made_up, tubes
from tests.study.html import Page

STUDY = f"""
title = "Uncertain shots"
deck = "{(tubes.ROOT / fake.BASE).as_posix()}"
[sample]
method = "latin-hypercube"
n = 14
results = ["rod_core_mass_kg"]
[sample.input."body.rod.velocity"]
uniform = ["1000 m/s", "1200 m/s"]
[sample.input."body.rod.strength_factor"]
normal = [1, 0.05]
"""


def outcome(velocity, deck):
    """Faster and weaker rods go deeper and erode."""
    factor = deck["body"][0]["strength_factor"]
    return {"regime": made_up.regime(velocity, 1050.0, 1150.0), "depth": 1e-4 * velocity - 0.5 * (factor - 1.0)}


def failing(velocity, deck):
    """As `outcome`, and the fastest ones fail."""
    return Outcome("failed", "the worker died") if velocity > 1180.0 else outcome(velocity, deck)


def swept(folder, function=outcome, text=STUDY, **options):
    """The directory of the study after a sweep by a made-up client, whose options these are."""
    resume = options.pop("resume", False)
    plan = cases.plan(made_up.study_file(folder, text), quiet=True)
    client = made_up.Client(function, **options)
    sweep.sweep(Choice(plan), folder / "out", client.connect(), resume=resume, quiet=True)
    return folder / "out", client


@pytest.fixture
def rough(monkeypatch):
    """Indices from few points, which take a fraction of the time."""
    monkeypatch.setattr(sobol, "POINTS", 128)
    monkeypatch.setattr(sobol, "DRAWS", 20)


def rows(directory):
    with open(directory / sample_table.FILE, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The directory of a study of which all runs were made in one go."""
    return swept(tmp_path_factory.mktemp("whole"))[0]


def test_a_row_for_each_run(whole):
    table, plan = rows(whole), study_directory.read(whole).sample
    assert [row["row"] for row in table] == [str(n) for n in range(1, 15)]
    for row, (velocity, factor) in zip(table, plan.rows, strict=True):
        assert (float(row["body.rod.velocity [m/s]"]), float(row["body.rod.strength_factor"])) == (velocity, factor)
        assert float(row["depth_m"]) == 1e-4 * velocity - 0.5 * (factor - 1.0), "with all of its digits"
        assert row["regime"] == made_up.regime(velocity, 1050.0, 1150.0)
        assert row["status"] == "done"
        assert float(row["rod_core_mass_kg"]) > 0.0
    assert not {"wall_s", "date", "commit", "message"} & set(table[0]), "nothing that another machine would change"


def test_stopped_and_continued_by_one_worker_and_by_several(whole, tmp_path):
    """To the byte."""
    text = (whole / sample_table.FILE).read_bytes()
    for workers in (1, 3):
        folder = tmp_path / str(workers)
        folder.mkdir()
        directory, client = swept(folder, workers=workers, interrupt_at=5)
        part = rows(directory)
        assert {row["status"] for row in part} == {"done", "interrupted", "waiting"}
        assert len(client.submitted) < 14
        swept(folder, workers=workers, resume=True)
        assert (directory / sample_table.FILE).read_bytes() == text


def test_failed_rows_are_counted(tmp_path):
    directory, _ = swept(tmp_path, failing)
    samples = hydro2d.open_study(directory).samples()
    failed = int((samples.table["status"] == "failed").sum())
    assert 0 < failed < 4
    eroding = samples.fractions("regime")["eroding"]
    assert eroding.share.trials == 14 - failed
    assert eroding.low == eroding.share.successes / 14
    assert eroding.high == (eroding.share.successes + failed) / 14
    assert np.isnan(samples.values("depth_m")).sum() == failed
    again, client = swept(tmp_path, resume=True)
    assert len(client.submitted) == failed
    assert hydro2d.open_study(again).samples().ended.all()


def test_results_by_name(whole):
    samples = hydro2d.open_study(whole).samples()
    depths = samples.values("depth_m")
    assert samples.spread("depth_m").median == np.median(depths)
    assert samples.values("penetration_depth_m").tolist() == depths.tolist(), "a number of the summaries"
    assert samples.values("depth_m > 0.11").tolist() == (depths > 0.11).astype(float).tolist()
    assert samples.values("regime = rigid").sum() == samples.fractions("regime")["rigid"].share.successes
    assert samples.fractions("depth_m > 0.11")["yes"].share.fraction == np.mean(depths > 0.11)
    for name, said in {
        "dept_m": 'unknown result "dept_m"; did you mean "depth_m"', "regime": "regime is a word; name an outcome",
        "regime = molten": 'unknown outcome "molten"', "regime > 1": "regime is a word; compare it by =",
        "depth_m = 1": "depth_m is a number", "depth_m > x": "x is not a number",
    }.items():
        with pytest.raises(StudyError, match=said):
            samples.values(name)
    with pytest.raises(StudyError, match="depth_m is a number; give a condition"):
        samples.fractions("depth_m")


def test_axes_and_members(tmp_path):
    text = STUDY.replace("n = 14", "n = 3") + ('[[axis]]\nname = "friction"\nkey = "sliding.friction"\nvalues = [0.0, 0.1]\n'
                                               '[ensemble]\nrepeats = 2\nby = ["first step"]\n')
    directory, _ = swept(tmp_path, text=text)
    assert [(row["friction"], row["row"], row["member"]) for row in rows(directory)][:3] == [
        ("0.0", "1", "0"), ("0.0", "1", "1"), ("0.0", "2", "0")]
    study = hydro2d.open_study(directory)
    with pytest.raises(StudyError, match="name a label on each, such as at="):
        study.samples()
    with pytest.raises(StudyError, match="is no combination of the axes"):
        study.samples({"friction": "0.2"})
    samples = study.samples({"friction": "0.1"})
    assert samples.title == "Uncertain shots, friction 0.1"
    assert len(samples) == 6
    row, depth = samples.by_row("depth_m")
    assert row.tolist() == [1, 2, 3]
    assert depth == pytest.approx(samples.values("depth_m")[::2])
    share = next(iter(samples.fractions("regime").values())).share
    assert share.trials == 6
    low, high = hydro2d.wilson(round(share.fraction * 3), 3)[3:]
    if share.fraction * 3 == round(share.fraction * 3):
        assert (share.low, share.high) == pytest.approx((low, high)), "as many trials as rows"


def test_kept_rows_replace_runs(tmp_path):
    text = STUDY.replace("[sample]", 'keep = "kept.csv"\n[sample]', 1)
    directory, _ = swept(tmp_path, text=text)
    table = rows(directory)
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "kept.csv").write_text((tmp_path / "kept.csv").read_text())
    again, client = swept(tmp_path / "elsewhere", text=text)
    assert client.submitted == []
    for row, kept in zip(table, rows(again), strict=True):
        assert float(kept["depth_m"]) == pytest.approx(float(row["depth_m"]), rel=1e-5)
        assert (kept["row"], kept["regime"], kept["status"]) == (row["row"], row["regime"], "done")
    assert ",-" in (text_of_kept := (again / sample_table.FILE).read_text())
    assert "'-" not in text_of_kept, "a number is no formula"
    assert hydro2d.open_study(again).samples().fractions("regime").keys() == {row["regime"] for row in table}


def test_words_that_begin_with_a_minus_come_back(tmp_path):
    """From the kept rows and from samples.csv, in which they have an apostrophe."""
    text = STUDY.replace("[sample]", 'keep = "kept.csv"\n[sample]', 1)
    text = re.sub(r"(velocity.*\n)uniform = .*", r'\1choice = ["1000 m/s", "+1100 m/s"]', text)
    directory, _ = swept(tmp_path, text=text)
    assert "'+1100" in (tmp_path / "kept.csv").read_text()
    (kept,), whole = hydro2d.kept_samples(next(tmp_path.glob("*.toml"))), hydro2d.open_study(directory).samples()
    for samples in (kept, whole):
        assert set(samples.table["body.rod.velocity"]) == {"1000 m/s", "+1100 m/s"}
        assert samples.cube(np.arange(1, 15)).shape == (14, 2)
    assert set(hydro2d.runs(directory)["body.rod.velocity"]) == {"1000 m/s", "+1100 m/s"}
    assert set(kept.table["method"]) == set(hydro2d.runs(directory)["method"])


def test_rows_without_a_new_column_are_made_again(tmp_path):
    text = STUDY.replace("[sample]", 'keep = "kept.csv"\n[sample]', 1)
    swept(tmp_path, text=text)
    more = text.replace('["rod_core_mass_kg"]', '["rod_core_mass_kg", "time_s", "cycles"]')
    assert "14 runs up to date" in keeping.Keeper(cases.plan(made_up.study_file(tmp_path, text), quiet=True)).in_words(
        [f"row{n}" for n in range(1, 15)])
    keeper = keeping.Keeper(cases.plan(made_up.study_file(tmp_path, more), quiet=True))
    assert len(keeper.fresh(f"row{n}" for n in range(1, 15))) == 14, "the columns are there under other names"
    keeper = keeping.Keeper(cases.plan(made_up.study_file(tmp_path, more.replace('"time_s"', '"wall_s", "x"')), quiet=True))
    assert keeper.fresh(f"row{n}" for n in range(1, 15)) == set()


def test_kept_inputs_are_numbers_even_below_zero(tmp_path):
    """Text that begins with a minus has an apostrophe before it in a table, so that no spreadsheet takes it for a formula."""
    text = STUDY.replace("[sample]", 'keep = "kept.csv"\n[sample]', 1)
    relative = re.sub(r"(velocity.*\n)uniform = .*", r'\1uniform = ["-9 m/s", "-1 m/s"]\nrelative = "difference"', text)
    assert relative != text
    plan = cases.plan(made_up.study_file(tmp_path, relative), quiet=True)
    head = plan.sample.inputs[0].head
    for case, row in zip(plan.cases, plan.sample.rows, strict=True):
        assert float(keeping.Keeper(plan).wanted[case.name].inputs[head]) == row[0] < 0.0


def test_values_of_inputs_for_the_surrogate(whole):
    samples = hydro2d.open_study(whole).samples()
    velocity, factor = (samples.table[name] for name in samples.heads)
    cube = samples.points({"body.rod.strength_factor": factor, samples.heads[0]: velocity})
    assert cube == pytest.approx(samples.cube(samples.table["row"]))
    with pytest.raises(StudyError, match=r'unknown input "velocity"'):
        samples.points({"velocity": [1100.0]})
    with pytest.raises(StudyError, match=r"there are no values of body\.rod\.strength_factor"):
        samples.points({"body.rod.velocity": [1100.0]})


def test_samples_from_kept_rows(tmp_path):
    text = STUDY.replace("[sample]", 'keep = "kept.csv"\n[sample]', 1)
    directory, _ = swept(tmp_path, failing, text=text)
    study = next(tmp_path.glob("*.toml"))
    (samples,) = hydro2d.kept_samples(study)
    whole = hydro2d.open_study(directory).samples()
    assert len(samples) == whole.ended.sum() < len(whole), "failed runs are not kept"
    assert samples.labels == {"cells_across": f"{hydro2d.runs(tmp_path / 'kept.csv')['cells_across'].iloc[0]:g}"}
    there = whole.ended
    for name in ("row", *whole.heads):
        assert samples.table[name].tolist() == whole.table[name][there].tolist()
    assert samples.values("depth_m") == pytest.approx(whole.values("depth_m")[there], rel=1e-5), "kept with six digits"
    assert samples.values("regime = eroding").tolist() == whole.values("regime = eroding")[there].tolist()
    (tmp_path / "kept.csv").write_text((tmp_path / "kept.csv").read_text().replace("strength_factor", "factor"))
    said = r'kept\.csv:1: has no column "body\.rod\.strength_factor" \(perhaps "body\.rod\.factor" is meant\); correct it, or'
    with pytest.raises(hydro2d.StudyError, match=said):
        hydro2d.kept_samples(study)
    study.write_text(STUDY)
    with pytest.raises(hydro2d.StudyError, match="has no keep"):
        hydro2d.kept_samples(study)


def test_joint_inputs_of_runs_and_of_kept_rows(tmp_path):
    """A table as a choice and a joint distribution come back from the directory, from samples.csv and from kept rows."""
    text = STUDY[: STUDY.index("[sample.input")].replace("[sample]", 'keep = "kept.csv"\n[sample]', 1) + """
[sample.input."materials.mine.strength"]
choice = [{model = "elastic-plastic", shear_modulus = "26 GPa", yield_stress = "1 GPa"}, {yield_stress = "2 GPa"}]
[[sample.joint]]
keys = ["body.rod.velocity", "body.rod.strength_factor"]
mean = ["1100 m/s", 1]
covariance = [[2500, -2], [-2, 0.0025]]
[set]
materials.mine.based_on = "W_alloy"
"""
    directory, _ = swept(tmp_path, text=text)
    whole = hydro2d.open_study(directory).samples()
    (kept,) = hydro2d.kept_samples(next(tmp_path.glob("*.toml")))
    assert kept.inputs == whole.inputs
    assert kept.heads == ["materials.mine.strength", "body.rod.velocity [m/s]", "body.rod.strength_factor"]
    assert kept.table[kept.heads].to_numpy().tolist() == whole.table[whole.heads].to_numpy().tolist()
    assert np.corrcoef(*whole.table[whole.heads[1:]].to_numpy(float).T)[0, 1] == pytest.approx(-0.8, abs=0.15)
    assert [len(samples.indices("depth_m").inputs) for samples in (whole, kept)] == [2, 2]


def test_the_terminal(rough, monkeypatch, tmp_path, capsys):
    client = made_up.Client(outcome)
    monkeypatch.setattr(cluster, "local", lambda *_, **__: client.connect())
    assert call(["sweep", str(made_up.study_file(tmp_path, STUDY)), "--out", str(tmp_path / "out"), "--workers", "1"]) == 0
    said = capsys.readouterr().out
    assert "Uncertain shots: 14 runs, 14 done" in said
    for word in ("result", "median", "10 to 90 %", "outcome", "rigid", "shares of its variance", "Q2 =", "strength_factor"):
        assert word in said, word
    assert call(["sweep", str(tmp_path / "out"), "--status"]) == 0
    assert "Q2 =" in capsys.readouterr().out


def test_the_status_of_a_sample_with_runs_to_come_is_quick(tmp_path, capsys):
    """No surrogate is fitted: spreads and fractions alone."""
    directory, _ = swept(tmp_path, interrupt_at=10)
    capsys.readouterr()
    assert call(["sweep", str(directory), "--status"]) == 0
    said = capsys.readouterr().out
    assert "10 to 90 %" in said
    assert "shares of its variance" not in said
    assert f"`hydro2d report {directory}` has them now" in said.replace("\n", " ")


def test_asked_results_are_shown_or_missed(rough, tmp_path):
    """One that does not vary is shown without shares, one that no run has is said with the nearest name."""
    asked = ["depth_m", "residual_velocity_m_s", "bodies.rod.mass_kg", "cycles", "bodies.rod.mas_kg"]
    text = STUDY.replace('["rod_core_mass_kg"]', str(asked).replace("'", '"'))
    rounded = (1.0 + 1e-12 * n for n in itertools.count())

    def made(velocity, deck):
        return outcome(velocity, deck) | {"exit_time_s": None, "bodies": {"rod": {"mass_kg": next(rounded)}}}

    directory, _ = swept(tmp_path, made, text)
    table, samples = rows(directory), hydro2d.open_study(directory).samples()
    assert {row["residual_velocity_m_s"] for row in table} == {"0.0"}, "a rod that stops, whether or not it is asked for"
    assert samples.usual == ["depth_m", "residual_velocity_m_s", "bodies.rod.mass_kg", "cycles"], "more than three"
    lines = list(text_of.report(samples))
    assert any('no run has such a number: unknown result "bodies.rod.mas_kg"; did you mean "bodies.rod.mass_kg"' in line
               for line in lines)
    assert "bodies.rod.mass_kg: the result is the same in every row: no input decides it" in lines


def test_the_page(rough, whole, tmp_path):
    said = []
    page = Page(report([whole], tmp_path / "report", say=said.append).read_text(encoding="utf-8"))
    assert not [line for line in said if line.startswith("warning")]
    for word in ("Sobol indices of", "uniform from 1000 to 1200 m/s", "Effects on depth", "Depth against each input"):
        assert word in page.text, word
    assert {file.name for file in (tmp_path / "report").glob("sample_*.png")} >= {"sample_01_depth_m_inputs.png",
                                                                                  "sample_01_depth_m_tornado.png"}


def test_the_page_of_a_sample_at_one_velocity_draws_the_runs_against_an_input(rough, tmp_path):
    """Not against the row, whose number means nothing."""
    text = STUDY.replace('"body.rod.velocity"]\nuniform = ["1000 m/s", "1200 m/s"]',
                         '"body.rod.material"]\nchoice = ["W_alloy", "W_sintered"]')
    directory, _ = swept(tmp_path, lambda velocity, deck: outcome(1086.0, deck), text)
    page = Page(report([directory], tmp_path / "report", say=lambda line: None).read_text(encoding="utf-8"))
    assert "Depth against body.rod.strength_factor (SI)" in page.text
    assert "Depth against row" not in page.text


def test_a_study_without_a_sample(tmp_path):
    study = fake.write_study(tmp_path / "plain", {"velocity": fake.velocities(1086, 1200)})
    with pytest.raises(StudyError, match="is not a study with"):
        hydro2d.open_study(study).samples()


def test_a_damaged_table(whole, tmp_path):
    plan = cases.plan(made_up.study_file(tmp_path, STUDY), quiet=True)
    study_directory.make(tmp_path / "out")
    study_directory.write(plan, tmp_path / "out")
    with pytest.raises(StudyError, match="has no samples.csv"):
        results.of_study(study_directory.read(tmp_path / "out"))
    text = (whole / sample_table.FILE).read_text()
    for spoiled, wrong in ((text.rsplit("\n", 2)[0] + "\n", "has 13 rows, and there are 14 runs"),
                           ("row\n1,2\n", r'csv:1: has no column "body\.rod\.velocity \[m/s\]"; remove the file')):
        (tmp_path / "out" / sample_table.FILE).write_text(spoiled)
        with pytest.raises(StudyError, match=wrong):
            results.of_study(study_directory.read(tmp_path / "out"))


TUBES = """
title = "Uncertain tubes"
deck = "tube.toml"
[set]
stop.time = 0.01
[sample]
method = "sobol"
n = 4
[sample.input."body.low.pressure"]
uniform = [0.1, 0.2]
"""


@pytest.mark.slow
def test_real_runs_by_one_worker_by_two_and_after_a_kill(tmp_path):
    study, tables = tubes.write(tmp_path, TUBES), []
    for name, workers in (("one", 1), ("two", 2)):
        status, said = tubes.sweep(study, "--workers", workers, "--out", tmp_path / name)
        assert status == 0, said
        tables.append((tmp_path / name / sample_table.FILE).read_bytes())
    process = tubes.start(study, "--workers", 1, "--out", tmp_path / "killed")
    tubes.wait_for(lambda: list((tmp_path / "killed").glob("cases/*/summary.json")))
    process.send_signal(signal.SIGKILL)
    process.communicate()
    time.sleep(1.0)
    status, said = tubes.sweep(study, "--workers", 2, "--out", tmp_path / "killed", "--resume")
    assert status == 0, said
    tables.append((tmp_path / "killed" / sample_table.FILE).read_bytes())
    assert tables[0] == tables[1] == tables[2]
    assert b"bodies." in tables[0]


def test_names_of_results_make_names_of_files():
    """With every printable character, and none twice."""
    every = "".join(map(chr, range(32, 127)))
    names = file_names(["depth_m", "derived.P/L", "derived.P_L", f"derived.{every}"])
    assert names[:3] == ["depth_m", "derived_P-L", "derived_P_L"]
    assert re.fullmatch(r"[\w+-]+", names[3])
