"""Configuration of the documentation: python -m sphinx docs docs/_build"""

import sys
from pathlib import Path

from docutils import nodes

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.path.insert(0, str(HERE.parent))

import _generate  # noqa: E402
from _pages import docstrings  # noqa: E402

from hydro2d.base.version import __version__  # noqa: E402

_generate.write(HERE / "reference" / "generated")

project = "hydro2d"
author = "The hydro2d developers"
copyright = f"2026, {author}"
version = release = __version__

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx-mathjax-offline"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
nb_execution_mode = "off"  # the outputs that are stored

autodoc_member_order = "bysource"
default_role = "code"  # docstrings have code between single backticks
smartquotes = False  # an option is --name, and a word of a deck "name", in prose too

exclude_patterns = ["_build", "_static", "jupyter_execute", "**/runs", "**/.ipynb_checkpoints"]
html_theme = "furo"
html_title = f"hydro2d {release}"
html_static_path = ["_static"]
html_css_files = ["pages.css"]


def equations_as_written(app, doctree):
    """Keeps numbered equations out of Sphinx's own environments, which forbid \\tag.

    The numbers stand in the text itself, so that the source, the page and the docstrings have the same ones.
    """
    for node in doctree.findall(nodes.math_block):
        if r"\tag" in node.astext():
            node["no-wrap"] = node["nowrap"] = True
            equation = r"\begin{equation}" + node.astext() + r"\end{equation}"
            node.children = []
            node += nodes.Text(equation)


def style_of_the_reference(app, page, template, context, doctree):
    """Gives the pages with wide tables their style."""
    if page.startswith("reference/"):
        app.add_css_file("reference.css")


def setup(app):
    """Hooks of this project."""
    app.connect("autodoc-process-docstring", docstrings.processed)
    app.connect("html-page-context", style_of_the_reference)
    app.connect("doctree-read", equations_as_written)
