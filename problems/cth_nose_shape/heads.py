"""How an eroding head fails: depths over the measured ones, for every way to fail, as a table and a figure.

    python -m problems.cth_nose_shape.heads [--figure PATH]

Reads what is kept of `rigid_rod_failure.toml` and of the members of `twelve_shots.toml`, beside this file, and of
`problems/validation/eroded_heads.toml`.
"""

from __future__ import annotations

import argparse
import functools
import sys
from pathlib import Path
from statistics import median

import hydro2d
from problems.cth_nose_shape import rigid_rod
from problems.cth_nose_shape.rigid_rod import COLOURS, Result

HERE = Path(__file__).parent
OTHERS = HERE.parent / "validation"
#: cells across the rod of the twelve shots' runs that are compared
CELLS = 5.5
#: ways to fail, by what the studies call them
WAYS = {"none": "none", "fracture pressure": "fracture pressure", "1.8 GPa": "1.8 GPa", "damage of 4340": "damage",
        "damage of 90W-7Ni-3Fe": "damage", "Johnson-Cook damage": "damage", "strain 150 %": "strain 150 %"}
#: shots by the label that studies give them: what the table calls them, and the deck that has the measured depth
SHOTS = {
    "5083-1296": ("tungsten into 5083, 1296 m/s", HERE / "hemi_5083_1296.toml"),
    "7039-1248": ("tungsten into 7039, 1248 m/s", HERE / "hemi_7039_1248.toml"),
    "steel-2120": ("4340 into 6061, 2120 m/s", OTHERS / "eroding_steel_6061_2120.toml"),
    "steel-3090": ("4340 into 6061, 3090 m/s", OTHERS / "eroding_steel_6061_3090.toml"),
    "tungsten-2070": ("tungsten into 4340, 2070 m/s", OTHERS / "eroding_w_4340_2070.toml"),
    "tungsten-3010": ("tungsten into 4340, 3010 m/s", OTHERS / "eroding_w_4340_3010.toml"),
}


@functools.cache
def measured(shot: str) -> float:
    """The measured depth of a shot, cm."""
    return 1e2 * hydro2d.Deck.from_file(SHOTS[shot][1]).experiment.penetration


def kept() -> list[Result]:
    """All runs of the three studies."""
    files = (HERE / "results/rigid_rod_failure.csv", OTHERS / "results/eroded_heads.csv")
    members = rigid_rod.read(HERE / "results/twelve_shots.csv", CELLS)
    return [*rigid_rod.read(files[0]), *members, *rigid_rod.read(files[1])]


def cases(results: list[Result]) -> dict[tuple[str, str], dict[str, list[float]]]:
    """Depths (cm) by (shot, law) and way to fail; the members of the twelve shots fail at a fracture pressure."""
    found: dict[tuple[str, str], dict[str, list[float]]] = {}
    for result in results:
        shot = result.labels["shot"]
        if shot in SHOTS and result.depth is not None:
            way = WAYS[result.labels.get("failure", "fracture pressure")]
            found.setdefault((shot, result.labels.get("law", "")), {}).setdefault(way, []).append(result.depth)
    order = list(SHOTS)
    return {key: ways for key, ways in sorted(found.items(), key=lambda item: order.index(item[0][0])) if len(ways) > 1}


def cell(depths: list[float]) -> str:
    """Depth in cm, of several runs the median and both ends."""
    middle = f"{median(depths):.1f}"
    return middle if len(depths) == 1 else f"{middle} ({min(depths):.1f} to {max(depths):.1f})"


def table(found: dict[tuple[str, str], dict[str, list[float]]]) -> list[str]:
    """Lines of Markdown."""
    ways = list(dict.fromkeys(WAYS.values()))
    lines = ["| shot | law | measured | " + " | ".join(ways) + " |", "|---" * (len(ways) + 3) + "|"]
    for (shot, law), depths in found.items():
        cells = [cell(depths[way]) if way in depths else "" for way in ways]
        lines.append(f"| {SHOTS[shot][0]} | {law} | {measured(shot):.1f} | " + " | ".join(cells) + " |")
    return lines


def draw(found: dict[tuple[str, str], dict[str, list[float]]]):
    """A matplotlib Figure: depth over measured depth, a dot for every run, a column for every shot and law."""
    figure, ((axes,),) = hydro2d.new_figure(9.6, 4.8)
    ways = list(dict.fromkeys(WAYS.values()))
    for number, way in enumerate(ways):
        dots = [(column + 0.12 * (number - 0.5 * (len(ways) - 1)), depth / measured(shot))
                for column, ((shot, _), depths) in enumerate(found.items()) for depth in depths.get(way, [])]
        axes.plot(*zip(*dots, strict=True) if dots else ([], []), "o", color=COLOURS[number % len(COLOURS)], label=way,
                  alpha=0.8)
    axes.axhline(1.0, color="black", linewidth=0.8)
    short = {"": "", "Steinberg-Guinan": "Steinberg-Guinan", "Johnson-Cook, sintered": "Johnson-Cook"}
    names = ["\n".join(filter(None, (*SHOTS[shot][0].split(", "), short.get(law, law)))) for shot, law in found]
    axes.set_xticks(range(len(found)), names, fontsize=7)
    axes.set_ylabel("depth over measured depth")
    axes.set_ylim(0.5, 2.1)
    axes.grid(alpha=0.3, axis="y")
    axes.legend(title="the rod fails by", fontsize="small", ncols=3)
    return figure


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--figure", type=Path)
    given = parser.parse_args(arguments)
    found = cases(kept())
    print("\n".join(table(found)))
    if given.figure:
        hydro2d.save_figure(draw(found), given.figure)
    return 0


if __name__ == "__main__":
    sys.exit(main())
