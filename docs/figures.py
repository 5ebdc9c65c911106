"""Makes the pictures of pages by the commands that the pages show.

    python docs/figures.py docs/how-to/spall.md

runs, in a folder of its own, the `hydro2d` commands and the Python of the page down to the last one that writes one of its
pictures, and puts the pictures into docs/_static: `![...](../_static/spall.png)` is what a command of the page wrote as
spall.png, and `../_static/report_rods_01.png` of the page report.md is rods_01.png of the report that it makes. They are made
smaller, so that none has more than 100 kB. With --together, pages share a folder and the runs in it, and no command runs twice
there; a page whose commands write another run under the same name gets another folder.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import re
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib
from PIL import Image, ImageSequence

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
matplotlib.use("agg")
STATIC = HERE / "_static"
#: largest picture of a page, bytes; its width, and that of a film, pixels
MOST, WIDTH, FILM_WIDTH = 100_000, 1200, 370
#: colours of a picture and of a film
COLOURS, FILM_COLOURS = 255, 48

#: a name that a reader replaces, such as DECK
TO_FILL_IN = re.compile(r"(?<![\w.-])[A-Z]{3,}\b")
FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.M | re.S)
#: what the text before a block says if the reader is to save the block as a file
FILE = re.compile(r"(?:Save this as|into a file|where) `(\w+\.(?:toml|py))`")
#: commands that write a run or a study, and how Python names the directory of one
WRITES, RUN = ("run", "sweep", "transition"), re.compile(r"[\"'](runs/[\w-]+)[\"']")
PICTURE = re.compile(r"!\[[^\]]*\]\((?:\.\./)?_static/([\w-]+\.(?:png|gif))\)")


def pictures(text: str) -> list[str]:
    """The pictures of a page that lie in docs/_static, by their file names."""
    return list(dict.fromkeys(PICTURE.findall(text)))


def blocks(text: str) -> list[tuple[str | None, str, str]]:
    """The blocks of a page in its order: name of the file that a reader makes of it, or None; language; text."""
    found, before = [], 0
    for match in FENCE.finditer(text):
        name = FILE.findall(text[before : match.start()])
        found.append((name[-1] if name and match[1] in ("toml", "python") else None, match[1], match[2]))
        before = match.end()
    return found


def steps(text: str) -> list[tuple[str, str]]:
    """The commands and the Python of a page, in its order: kind ("sh" or "python") and text.

    Of a shell `hydro2d` alone, and no command in which a reader is to fill in a name.
    """
    found = []
    for name, language, block in blocks(text):
        if language == "python" and name is None:
            found.append(("python", block))
        lines = [re.sub(r"\s+#.*", "", line).strip() for line in block.splitlines() if language == "sh"]
        found += [("sh", line) for line in lines if line.startswith("hydro2d ") and not TO_FILL_IN.search(line)]
    return found


def needed(text: str, page: Path) -> list[tuple[str, str]]:
    """The steps of a page down to the last one that writes one of its pictures; those of a report are of its first report."""
    found, names = steps(text), pictures(text)
    written = re.compile("|".join(rf"(?<![\w-]){re.escape(name)}" for name in names) or "(?!)")
    last = [number for number, (_, step) in enumerate(found) if written.search(step)]
    if any(written_as(name, page) != name for name in names):
        last += [number for number, (_, step) in enumerate(found) if step.startswith("hydro2d report ")][:1]
    return found[: max(last, default=-1) + 1]


def runs(steps: Sequence[tuple[str, str]]) -> dict[str, tuple[str, ...]]:
    """The directories of runs and studies that steps write: name -> the commands or the Python that write it."""
    found: dict[str, tuple[str, ...]] = {}
    for kind, text in steps:
        words = shlex.split(text) if kind == "sh" else []
        names = RUN.findall(text) if kind == "python" else []
        if words[1:2] and words[1] in WRITES:
            given = [after for word, after in zip(words, words[1:], strict=False) if word == "--out"]
            names = given or [f"runs/{Path(words[2]).stem}"]
        for name in names:
            found[name] = (*found.get(name, ()), text)
    return found


@dataclass
class Folder:
    """A folder in which pages are made. done : the steps that were run there; made : its runs, as `runs` gives them"""

    path: Path
    done: set[tuple[str, str]] = field(default_factory=set)
    made: dict[str, tuple[str, ...]] = field(default_factory=dict)

    def suits(self, text: str, page: Path) -> bool:
        """Whether the commands and files of a page write nothing here that is already there and differs."""
        same_runs = all(self.made.get(name, steps) == steps for name, steps in runs(needed(text, page)).items())
        files = [(self.path / name, block) for name, _, block in blocks(text) if name is not None]
        return same_runs and all(not file.exists() or file.read_text(encoding="utf-8") == block for file, block in files)


def run(step: tuple[str, str], folder: Path, names: dict[str, object]) -> None:
    """Runs a step in a folder, in which `problems` is that of this checkout; names : of the Python of the page so far."""
    kind, text = step
    if kind == "python":
        with contextlib.chdir(folder):
            exec(text, names)
        return
    environment = os.environ | {"PYTHONPATH": str(HERE.parent), "BROWSER": "true", "MPLBACKEND": "agg"}
    subprocess.run([sys.executable, "-m", "hydro2d", *shlex.split(text)[1:]], cwd=folder, env=environment, check=True)


def shrink(source: Path, target: Path) -> None:
    """A picture of at most WIDTH pixels in COLOURS colours. Raises ValueError if it still has more than MOST bytes."""
    with Image.open(source) as picture:
        if source.suffix == ".gif":
            _film(picture, target)
        else:
            _coloured(_smaller(picture, WIDTH), COLOURS).save(target, optimize=True)
    if target.stat().st_size > MOST:
        raise ValueError(f"{target} has {target.stat().st_size} bytes; a picture of a page has at most {MOST}")


def _smaller(picture: Image.Image, width: int) -> Image.Image:
    smaller = picture.convert("RGB")
    smaller.thumbnail((width, width), Image.Resampling.LANCZOS)
    return smaller


def _coloured(picture: Image.Image, colours: int) -> Image.Image:
    return picture.quantize(colours, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)


def _film(picture: Image.Image, target: Path) -> None:
    """All frames have the same colours, so that a body keeps its own and a cell that does not change takes no bytes."""
    frames = [_smaller(frame, FILM_WIDTH) for frame in ImageSequence.Iterator(picture)]
    width, height = frames[0].size
    strip = Image.new("RGB", (width, height * len(frames)))
    for number, frame in enumerate(frames):
        strip.paste(frame, (0, number * height))
    coloured = _coloured(strip, FILM_COLOURS)
    first, *rest = [coloured.crop((0, top, width, top + height)) for top in range(0, strip.height, height)]
    first.save(target, save_all=True, append_images=rest, duration=picture.info.get("duration", 100), loop=0, optimize=True)


def written_as(picture: str, page: Path) -> str:
    """The name under which the commands of a page write a picture of it: that of a report lacks the name of the page."""
    return picture.removeprefix(f"{page.stem}_")


def make(page: Path, place: Folder) -> None:
    """Makes the pictures of a page in a folder and puts them into docs/_static."""
    text, names, folder = page.read_text(encoding="utf-8"), {"__name__": page.stem}, place.path
    if not (folder / "problems").exists():
        (folder / "problems").symlink_to(HERE.parent / "problems")
    for file, _, block in blocks(text):
        if file is not None:
            (folder / file).write_text(block, encoding="utf-8")
    found = needed(text, page)
    place.made |= runs(found)
    for step in found:
        if step in place.done:
            continue
        place.done.add(step)
        print(f"{page.name}: {step[1].splitlines()[0]}", flush=True)
        run(step, folder, names)
    for name in pictures(text):
        if found := sorted(folder.rglob(written_as(name, page)), key=lambda file: len(file.parts)):
            shrink(found[0], STATIC / name)
            print(f"{page.name}: made {name}, {(STATIC / name).stat().st_size / 1000:.0f} kB", flush=True)


def main(arguments: list[str] | None = None) -> int:
    """Makes the pictures of the pages that are named."""
    parser = argparse.ArgumentParser(description="Makes the pictures of pages by the commands that the pages show.")
    parser.add_argument("pages", nargs="+", type=Path, metavar="PAGE")
    parser.add_argument("--together", action="store_true", help="pages share the runs that are the same")
    given = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as whole:
        folders: list[Folder] = []
        for page in given.pages:
            text = page.read_text(encoding="utf-8")
            place = next((each for each in folders if given.together and each.suits(text, page)), None)
            if place is None:
                place = Folder(Path(whole) / str(len(folders)))
                place.path.mkdir()
                folders.append(place)
            make(page, place)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
