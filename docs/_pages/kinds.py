"""The kinds of shots in the gallery: how each is drawn, and which of its numbers stand beside measured or expected ones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Kind:
    """A kind of `hydro2d new`.

    title, text : heading, and what there is to see
    plot : arguments of `hydro2d plot`
    numbers : what is compared, what is measured or expected, and the function that gives the result of a run in words
    """

    name: str
    title: str
    text: str
    plot: str
    numbers: tuple[tuple[str, str, Callable], ...]

    @property
    def picture(self) -> str:
        """The picture in docs/_static."""
        return f"gallery_{self.name}.png"

    def commands(self) -> list[str]:
        """The command that a reader types."""
        return [f"hydro2d new {self.name}", f"hydro2d run {self.name}.toml --threads 1",
                f"hydro2d plot runs/{self.name} -o {self.name}.png {self.plot}"]

    def section(self, found: dict) -> str:
        """The section of the page; found : seconds and results, as docs/gallery.json has them."""
        rows = [f"| {what} | {expected} | {found['results'][what]} |" for what, expected, _ in self.numbers]
        lines = [
            f"## {self.title}", "", f"![{self.title}](_static/{self.picture})", "", self.text, "",
            "```sh", *self.commands(), "```", "",
            "| | measured or expected | hydro2d |", "|---|---|---|", *rows, "",
            f"The run takes {spoken(found['seconds'])}. The deck, as the first command writes it:", "",
            f"```{{literalinclude}} ../problems/templates/{self.name}.toml", ":language: toml", "```", "",
        ]
        return "\n".join(lines)


def spoken(seconds: float) -> str:
    """A time in round numbers."""
    if seconds < 55.0:
        return f"{max(round(seconds), 1)} s"
    return f"{seconds / 60.0:.1f} min" if seconds < 600.0 else f"{seconds / 60.0:.0f} min"


def depth(results) -> str:
    """Penetration depth."""
    return f"{results.summary.penetration_depth_m * 1e3:.1f} mm"


def in_steel(results) -> str:
    """Depth behind a tile of 20 mm."""
    return f"{max(results.summary.penetration_depth_m * 1e3 - 20.0, 0.0):.1f} mm"


def early_depth(results) -> str:
    """Penetration depth after 50 us."""
    return f"{np.interp(50e-6, results.history['time'], results.history['penetration_depth_m']) * 1e3:.1f} mm"


def hole(results) -> str:
    """Diameter of the hole at the face of the target."""
    found = results.summary.crater.entrance_diameter_m
    return "none" if found is None else f"{found * 1e3:.2f} mm"


def length(results) -> str:
    """Length of the bar along z."""
    bar = results.summary.bodies["bar"]
    return f"{(bar.z_max_m - bar.z_min_m) * 1e3:.2f} mm"


def residual(results) -> str:
    """Residual velocity behind the plate."""
    found = results.summary.rod_residual_velocity_m_s
    return "stopped" if found is None else f"{found:.1f} m/s"


def of_ball(results) -> str:
    """Mean velocity of the ball while its debris crosses the gap."""
    times, speeds = results.history["time"], results.history["body_ball_velocity_m_s"]
    return f"{np.interp(8e-6, times, speeds) / 1e3:.2f} km/s"


def of_wall(results) -> str:
    """Whether the wall still closes the axis."""
    dump = results.dump()
    return "perforated" if dump.fields["Volume Fraction for wall"][:, 0].max() < 0.5 else "holds on the axis"


def wall_velocity(results, travel: float) -> str:
    """Velocity of the wall of the cylinder test when it has moved by travel, m."""
    moved, speed = results.history["wall_travel_m"], results.history["tracer_wall_velocity_r_m_s"]
    return f"{np.interp(travel, moved, speed) / 1e3:.2f} km/s"


def early_wall(results) -> str:
    """Velocity of the wall after 6 mm."""
    return wall_velocity(results, 6e-3)


def late_wall(results) -> str:
    """Velocity of the wall after 19 mm."""
    return wall_velocity(results, 19e-3)


def pull_back(results) -> str:
    """Fall of the velocity of the rear from its plateau to its first minimum."""
    speed = results.history["tracer_rear_velocity_z_m_s"]
    top = int(np.argmax(speed))
    return f"{speed[top] - speed[top:].min():.0f} m/s, from {speed[top]:.0f} m/s"


KINDS = (
    Kind("rod", "A long rod into a thick block",
         "A rod of tungsten alloy erodes in 4340 steel: its head flows off to the side while the tail still flies. Von Mises "
         "stress above the axis, materials below; the dashed line is the depth that was measured.",
         '--field von_mises --mirror material --time "25 us" --time "120 us" --window "-25 mm,65 mm,25 mm"',
         (("depth", "56.2 mm (Luk and Piekutowski 1991, shot 4-1046)", depth),
          ("diameter of the hole at the face", "9.71 mm (the same, of the crater)", hole))),
    Kind("crater", "A crater",
         "A steel ball in copper at 2 km/s. Pressure above the axis, plastic strain below, after 5 and 40 µs.",
         '--field pressure --mirror plastic_strain --time "5 us" --time "40 us" --window "-15 mm,30 mm,25 mm"',
         (("depth", "13 mm or a little more (fit of Charters and Summers to balls that are used up, recalled)", depth),
          ("diameter of the hole at the face", "about 27 mm, if the crater is a hemisphere as deep as that fit says", hole))),
    Kind("taylor", "Taylor's test",
         "A copper bar on a rigid wall, at the left, after 20 and 60 µs. Plastic strain above the axis, temperature below.",
         '--field plastic_strain --mirror temperature --time "20 us" --time "60 us" --window "0 mm,27 mm,10 mm"',
         (("length at the end", "17.38 mm in a Lagrangian solution with the same constants; 16.2 mm in the experiment of "
           "Johnson and Cook", length),)),
    Kind("whipple", "A Whipple shield",
         "A ball of aluminium breaks up on a bumper at 6 km/s, and its debris hits the wall behind. Materials above the axis, "
         "density below, after 9 and 25 µs. Only cells that are half full are drawn, so thin debris is not to be seen.",
         '--field material --mirror density --time "9 us" --time "25 us" --window "-20 mm,80 mm,45 mm"',
         (("velocity of the ball behind the bumper", "at least 4.56 km/s, by momentum", of_ball),
          ("the wall of 4 mm, 58 mm behind the bumper", "perforated: by Christiansen's ballistic-limit equation (Int. J. "
           "Impact Engng 14 (1993) 145) this shield stops balls of up to 5.0 mm", of_wall))),
    Kind("spall", "Spall",
         "A flyer of aluminium hits a disc of twice its thickness. Where the release waves meet, the disc is torn. Pressure "
         "above the axis, density below, after 0.6 and 1.8 µs.",
         '--field pressure --mirror density --time "0.6 us" --time "1.8 us" --window "-2.5 mm,6 mm,8 mm"',
         (("pull-back of the rear", "151 m/s, from 490 m/s, in one dimension on cells of 0.025 mm; 169 m/s by the acoustic "
           "estimate", pull_back),)),
    Kind("perforation", "Perforation",
         "A hardened steel rod through a plate of Weldox 460 E. Plastic strain above the axis, materials below, after 100 µs "
         "and at the end of the run.",
         '--field plastic_strain --mirror material --time "100 us" --time "400 us" --window "-60 mm,130 mm,60 mm"',
         (("residual velocity", "284.3 m/s (Borvik and others 2002, recalled)", residual),)),
    Kind("jacketed", "A jacketed core",
         "A tungsten core in a steel jacket goes into aluminium. Materials above the axis, plastic strain below, after 20 and "
         "70 µs.",
         '--field material --mirror plastic_strain --time "20 us" --time "70 us" --window "-25 mm,60 mm,25 mm"',
         (("depth of the core after 50 µs", "somewhat less than the 40 to 43 mm of Tate's model for the core",
           early_depth),
          ("depth of the core after 70 µs, still in flight", "none published: the shot is made up", depth))),
    Kind("ceramic", "A ceramic tile",
         "A rod of tungsten alloy goes through a tile of alumina, which lies in a ring of steel, into the steel behind. "
         "Materials above the axis, damage below, after 10 and 60 µs: yellow is crushed. Without the tile the rod of hydro2d "
         "goes 34.1 mm deep, so the tile saves 10 mm (`problems/ceramics/README.md`).",
         '--field material --mirror damage --time "10 us" --time "60 us" --window "-30 mm,50 mm,45 mm"',
         (("depth in the steel behind the tile", "none published for this shot; 38.7 mm without the tile (fit of Lanz and "
           "Odermatt), of which alumina of a mass efficiency of 1.5 to 2 (recalled) leaves 19 to 24 mm", in_steel),)),
    Kind("cylinder-test", "The cylinder test",
         "TNT in a tube of copper, lit over its left end. Pressure above the axis, materials below, after 12 and 28 µs: the "
         "detonation runs to the right, and its products drive the wall.",
         '--field pressure --mirror material --time "12 us" --time "28 us" --window "0 mm,165 mm,38 mm"',
         (("velocity of the wall after 6 mm", "1.21 km/s (LLNL Explosives Handbook 1985, recalled)", early_wall),
          ("velocity of the wall after 19 mm", "1.42 km/s (the same)", late_wall))),
)
