"""The gallery in short form, and the pictures of pages: each is small, and made by a command of its page."""

import importlib
import json
import re
import subprocess
import sys
import tomllib

import pytest
from PIL import Image

from hydro2d.base.units import to_si
from problems.whipple import read
from tests.rules import source

DOCS = source.ROOT / "docs"
#: bytes of a picture of a page
MOST = 100_000
#: pictures that no command of their page makes, and why
OTHERWISE = {
    "view.png": "a browser's picture of the page that `hydro2d view` writes",
}
#: pages without a picture, and why
BARE = {
    "docs/how-to/easyvvuq.md": "numbers that another program makes",
    "docs/how-to/index.md": "a list of pages",
    "docs/tutorials/index.md": "a list of pages",
}


@pytest.fixture(scope="module")
def docs():
    """The modules of the pages by name, as `python docs/gallery.py` imports them."""
    sys.path.insert(0, str(DOCS))
    try:
        yield {name: importlib.import_module(name) for name in ("figures", "gallery", "_pages.kinds", "_pages.studies")}
    finally:
        sys.path.remove(str(DOCS))


def kinds():
    return sorted(file.stem for file in (source.PROBLEMS / "templates").glob("*.toml"))


@pytest.mark.thorough
@pytest.mark.parametrize("name", kinds())
def test_a_kind_runs_is_drawn_and_has_its_numbers(name, docs, tmp_path):
    """Thirty cycles of it, by the commands of the page."""
    (kind,) = (kind for kind in docs["_pages.kinds"].KINDS if kind.name == name)
    numbers = docs["gallery"].run_kind(kind, tmp_path, ("--set", "stop.cycles=30", "--quiet"))
    assert numbers["seconds"] > 0.1
    assert set(numbers["results"]) == {what for what, *_ in kind.numbers}
    small = tmp_path / "small.png"
    docs["figures"].shrink(tmp_path / f"{name}.png", small)
    assert 5000 < small.stat().st_size < MOST
    assert f"hydro2d new {name}\n" in kind.section(numbers)


@pytest.mark.thorough
def test_the_page_is_that_of_its_numbers_and_has_every_kind_and_study(docs):
    numbers = json.loads((DOCS / "gallery.json").read_text(encoding="utf-8"))
    text = (DOCS / "gallery.md").read_text(encoding="utf-8")
    assert set(numbers) == set(kinds())
    assert text == docs["gallery"].page(numbers)
    _, studies = source.problems()
    assert len(studies) > 20
    assert [file.name for file in studies if f"problems/{file.relative_to(source.PROBLEMS)}\n" not in text] == []


def test_the_ballistic_limit_of_the_whipple_shield_is_that_of_the_page(docs):
    """By the equation of problems/whipple, with the density of this ball."""
    deck = tomllib.loads((source.PROBLEMS / "templates/whipple.toml").read_text(encoding="utf-8"))
    ball, bumper, wall = deck["body"]
    thick, tw = (to_si(body["thickness"], "m") * 100 for body in (bumper, wall))
    gap = to_si(wall["z_front"], "m") * 100 - thick
    limit = read.limit(to_si(ball["velocity"], "m/s") / 1e3, thick, gap, tw, density=2.7)
    (kind,) = (kind for kind in docs["_pages.kinds"].KINDS if kind.name == "whipple")
    assert f"stops balls of up to {limit * 10:.1f} mm" in kind.numbers[1][1]
    assert limit < 200 * to_si(ball["radius"], "m")  # so the wall is perforated


@pytest.mark.thorough
def test_the_charts_of_studies_are_those_of_the_kept_results(docs, tmp_path):
    """One of each kind of table: measured depths with the runs, and numbers relative to their median."""
    drawn = {study.name: study for study in docs["_pages.studies"].studies() if study.results}
    axes = docs["_pages.studies"].chart(drawn["eroding_rods"]).axes[0]
    lines = {line.get_label(): line.get_xydata().tolist() for line in axes.lines}
    assert sorted(lines) == ["contact", "measured", "slip-layer"]
    assert sorted(y for _, y in lines["measured"]) == pytest.approx([5.62, 7.05, 9.37, 13.49])
    assert [y for _, y in lines["contact"]] == pytest.approx([7.90584, 14.5692, 5.14698, 7.9649])
    assert docs["_pages.studies"].chart(drawn["methods"]).axes[0].get_ylabel() == "number of the shot / its median"


PAGES = [file for file in source.tracked_files() if file.suffix == ".md" and DOCS in file.parents
         and file.parent in (DOCS, DOCS / "how-to", DOCS / "tutorials")]


@pytest.mark.parametrize("file", PAGES, ids=lambda file: file.stem)
def test_the_pictures_of_a_page_are_small_and_made_by_its_commands(file, docs):
    text, name = file.read_text(encoding="utf-8"), str(file.relative_to(source.ROOT))
    names = docs["figures"].pictures(text)
    if file.parent.name != "docs":
        assert bool(names) != (name in BARE), "a page has a picture, or a reason in BARE"
    steps = " ".join(step for _, step in docs["figures"].steps(text))
    for picture in names:
        place = DOCS / "_static" / picture
        assert place.stat().st_size <= MOST
        with Image.open(place) as image:
            assert image.width <= docs["figures"].WIDTH
        if file.name != "gallery.md":  # it shows pictures of kinds and studies
            of_report = picture.startswith(f"{file.stem}_") and "hydro2d report " in steps
            assert picture in OTHERWISE or of_report or re.search(rf"(?<![\w-]){re.escape(picture)}", steps), picture


def test_steps_are_those_down_to_the_last_picture(docs):
    text = ("![a](../_static/a.png)\n```sh\nhydro2d new rod   # a deck\npip install x\nhydro2d plot r -o a.png\n```\n"
            "```python\nprint(1)\n```\n```sh\nhydro2d plot r -o a.png.svg\nhydro2d bench\n```\n")
    page = DOCS / "page.md"
    assert docs["figures"].needed(text, page) == [("sh", "hydro2d new rod"), ("sh", "hydro2d plot r -o a.png"),
                                            ("python", "print(1)\n"), ("sh", "hydro2d plot r -o a.png.svg")]
    assert docs["figures"].needed("![a](../_static/a.png)\n```sh\nhydro2d bench\n```\n", page) == []
    report = "![a](../_static/page_rods_1.png)\n```sh\nhydro2d report r\nhydro2d bench\n```\n"
    assert docs["figures"].needed(report, page) == [("sh", "hydro2d report r")]


def test_a_picture_that_is_too_large_is_refused(docs, tmp_path, monkeypatch):
    monkeypatch.setattr(docs["figures"], "MOST", 100)
    Image.effect_noise((300, 300), 60).save(tmp_path / "noise.png")
    with pytest.raises(ValueError, match="at most 100"):
        docs["figures"].shrink(tmp_path / "noise.png", tmp_path / "small.png")


def test_the_command_says_what_it_takes():
    done = subprocess.run([sys.executable, str(DOCS / "gallery.py"), "--help"], capture_output=True, text=True, check=True)
    assert "--studies" in done.stdout


def test_pages_that_are_made_together_share_only_the_runs_that_are_the_same(docs, monkeypatch, tmp_path):
    """`runs/crater` is one run of two pages and another run of two others; no command finds its directory in use."""
    figures, ran = docs["figures"], []
    monkeypatch.setattr(figures, "shrink", lambda source, target: None)
    monkeypatch.setattr(figures, "run", lambda step, folder, names: ran.append((folder, step[1])))
    names = ("run-a-shot", "restart", "paraview", "make-a-film", "perforate-a-plate")
    assert figures.main(["--together", *(str(DOCS / "how-to" / f"{name}.md") for name in names)]) == 0
    written = [(folder, step) for folder, step in ran if step.startswith("hydro2d run ") and "--restart" not in step]
    places = [(folder, step.split("--out ")[1].split()[0]) for folder, step in written]
    assert len(set(places)) == len(places)
    assert {place for _, place in places} == {"runs/crater", "runs/two"}
    folders = list(dict.fromkeys(folder for folder, _ in ran))
    assert len(folders) == 3  # of the plain crater, of the one that is restarted, of the one with more dumps
    assert len([step for folder, step in ran if folder == folders[0] and step == "hydro2d new crater"]) == 1
    again = next(folder for folder, step in ran if "--restart" in step)
    assert [step for folder, step in ran if folder == again and " run " in step][0].endswith('stop.time="10 us"')
    assert any(step.startswith("hydro2d plot runs/crater -o cutaway.png") for folder, step in ran if folder == folders[0])
