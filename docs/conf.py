"""Configuration of the documentation: python -m sphinx docs docs/_build"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.path.insert(0, str(HERE.parent))

import _generate  # noqa: E402

from hydro2d import __version__  # noqa: E402

_generate.write(HERE / "reference" / "generated")

project = "hydro2d"
author = "The hydro2d developers"
copyright = f"2026, {author}"
version = release = __version__

extensions = ["myst_parser"]
myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence", "deflist"]
myst_heading_anchors = 3
# raw TeX with \tag numbers: the same numbers in the source, on the page and in the docstrings
myst_dmath_allow_labels = False

exclude_patterns = ["_build", "_static"]
html_theme = "furo"
html_title = f"hydro2d {release}"
html_static_path = ["_static"]
