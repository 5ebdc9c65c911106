"""Problems with exact solutions in the gallery: a picture of each, drawn from the curves that `problems/verification` keeps."""

from __future__ import annotations

import tempfile
from pathlib import Path

import figures as pictures

from hydro2d.results import figures
from problems import kept
from problems.verification.accuracy import PROBLEMS
from problems.verification.figures import draw as drawn
from problems.verification.figures import picture
from problems.verification.table import CURVE_COLUMNS, CURVES

HEADING = """## Exact solutions

Each problem has an exact solution, the dashed line, and was run on three meshes. The errors are in
`problems/verification/README.md`; the page says where the exact values come from.

```text
python -m problems.verification.table runs/verification --keep
python -m problems.verification.figures .
```
"""


def draw(folder: Path) -> None:
    """Draws all problems of which curves are kept."""
    rows = kept.rows(CURVES, CURVE_COLUMNS)
    for problem in PROBLEMS:
        with tempfile.TemporaryDirectory() as place:
            file = Path(place) / picture(problem)
            figures.save_figure(drawn(problem, rows), file)
            pictures.shrink(file, folder / file.name)
        print(f"{problem.name}: {picture(problem)}", flush=True)


def sections() -> list[str]:
    """The part of the page on exact solutions."""
    return [HEADING, *(f"![{problem.title}](_static/{picture(problem)})\n" for problem in PROBLEMS)]
