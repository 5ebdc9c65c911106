"""A three-dimensional picture of a run: the bodies rotated about the axis, with a quarter cut out, drawn with pyvista.

It is rendered in a separate process, so that a failing graphics driver does no other harm.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

from hydro2d.base import children
from hydro2d.files.whole import replacing
from hydro2d.output.vtk import Dump
from hydro2d.results.figures import Shown, body_colours, chosen, cropped
from hydro2d.results.scales import LINEAR, FigureError

#: time limit of a rendering process, s
RENDER_SECONDS = 180


def draw(dump_file: Path, path: Path, field: str = "pressure", window=None, size=(1400, 900)) -> None:
    """Renders the bodies rotated about the axis with a quarter cut out and the cut coloured by a field.

    window = (z0, z1, r1) in m, size in pixels.

    A separate process renders the picture, on the display if there is one, else with EGL, else with OSMesa. Raises
    FigureError if none of them works.
    """
    task = json.dumps({"dump": str(dump_file), "path": str(path), "field": field, "window": window, "size": size})
    shows = os.environ.get("DISPLAY") or sys.platform in ("win32", "darwin")
    windows = [None] if shows else ["vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow"]
    said = ""
    for window in windows:
        environment = os.environ | ({"VTK_DEFAULT_OPENGL_WINDOW": window} if window else {})
        try:
            done = subprocess.run(children.python("hydro2d.results.cutaway"), input=task, encoding="utf-8", errors="replace",
                                  env=environment, capture_output=True, timeout=RENDER_SECONDS, check=False)
        except subprocess.TimeoutExpired:
            said = f"no picture after {RENDER_SECONDS} s"
            continue
        if done.returncode == 0:
            return
        said = (done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1]
    raise FigureError(f"the three-dimensional picture could not be rendered on this machine: {said}")


def _render(dump: str, path: str, field: str, window, size) -> None:
    """The work of the rendering process."""
    import pyvista

    from hydro2d.output.vtk import read_grid

    state = cropped(read_grid(Path(dump)), window)
    shown = chosen(state, field)
    plotter = pyvista.Plotter(off_screen=True, window_size=list(size))
    count = len(state.bodies)
    for line in state.filling().outlines(closed=True):
        points = np.column_stack([line[:, 0], np.zeros(len(line)), line[:, 1]]) * 1e3
        curve = pyvista.lines_from_points(points)
        curve["body"] = _nearest_body(state, line)
        turned = curve.extrude_rotate(angle=270, resolution=90, capping=False)
        plotter.add_mesh(turned, scalars="body", cmap=body_colours(count), clim=(0.5, count + 0.5), specular=0.3,
                         show_scalar_bar=False, interpolate_before_map=False)
    for body in state.bodies:
        for line in state.outlines(body):
            points = np.column_stack([line[:, 0], np.zeros(len(line)), line[:, 1]]) * 1e3
            for angle in (0.0, 270.0):
                plotter.add_mesh(pyvista.lines_from_points(points).rotate_z(angle), color="black", line_width=2)
    low, high = LINEAR.limits([shown.values])
    for angle in (0.0, 270.0):
        plotter.add_mesh(_cut_face(pyvista, state, shown, angle), scalars=shown.label, cmap=shown.colours,
                         clim=(low, high), lighting=False, scalar_bar_args={"title": shown.label})
    plotter.add_text(f"t = {state.time * 1e6:.2f} us", font_size=10)
    plotter.view_vector((1.0, -1.0, -0.7), viewup=(0, 0, -1))  # into the cut, +z down
    with replacing(Path(path)) as temporary:
        picture = temporary.with_suffix(".png")  # pyvista chooses the format by the ending
        plotter.screenshot(str(picture))
        os.replace(picture, temporary)


def _nearest_body(state: Dump, line: np.ndarray) -> np.ndarray:
    """Number of the body that fills most of the 3 x 3 cells around each point of an outline, shape (n,)."""
    j = np.clip(np.searchsorted(state.z_edges, line[:, 1], "right") - 1, 0, len(state.z_edges) - 2)
    i = np.clip(np.searchsorted(state.r_edges, line[:, 0], "right") - 1, 0, len(state.r_edges) - 2)
    shares = np.stack([np.pad(state.fields[f"Volume Fraction for {body}"], 1) for body in state.bodies])
    around = sum(shares[:, j + dj, i + di] for dj in range(3) for di in range(3))
    return 1.0 + np.argmax(around, axis=0)


def _cut_face(pyvista, state: Dump, shown: Shown, angle: float):
    """The section as a plane through the axis at an angle in degrees, without void, in mm."""
    plane = pyvista.RectilinearGrid(state.r_edges * 1e3, np.zeros(1), state.z_edges * 1e3)
    plane.cell_data[shown.label] = shown.values.ravel()
    plane.cell_data["solid"] = np.isfinite(shown.values).ravel().astype(float)
    return plane.threshold(0.5, scalars="solid").rotate_z(angle)


if __name__ == "__main__":
    try:
        _render(**json.load(sys.stdin))
    except FigureError as problem:
        sys.exit(str(problem))
