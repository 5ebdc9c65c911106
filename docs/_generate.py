"""Reference pages from the code: deck keys, fields, models, materials, penetration models and their figures, commands.

``write(folder)`` is called by conf.py; ``pages()`` gives the same pages as text.
"""

from __future__ import annotations

import contextlib
import io
import math
from pathlib import Path

from _pages import api, commands, deck, materials
from _pages.markdown import NOTE, code, prose, table

#: velocities of a penetration model's figure
POINTS = 81


def bounds(field) -> str:
    """The bounds of a field in words."""
    ends = [f"from {field.least:g}"] if math.isfinite(field.least) else []
    ends += [f"to {field.most:g}"] if math.isfinite(field.most) else []
    return " ".join(ends) or "none"


def fields_page() -> str:
    """The field table and the quantities of output files."""
    from eos.registry import MODULES
    from hydro2d.materials import quantities
    from hydro2d.mesh import fields
    from strength.registry import STRENGTH_MODULES

    state = table(
        ("field", "symbol", "centring", "unit", "sign in a mirror", "remapped by", "bounds", "meaning"),
        (
            (f"`{f.name}`", f"`{f.symbol}`", f.centring, f.unit, f"{f.parity:+d}", f.remap or "not remapped", bounds(f),
             f.meaning)
            for f in fields.FIELDS
        ),
    )
    internal = table(
        ("variable", "model", "unit", "sign in a mirror", "remapped by", "bounds", "meaning"),
        (
            (f"`{f.name}`", f"`{module.NAME}`", f.unit, f"{f.parity:+d}", f.remap, bounds(f), f.meaning)
            for module in (*STRENGTH_MODULES, *MODULES) for f in getattr(module, "INTERNAL", ())
        ),
    )
    work = table(
        ("array", "axes", "meaning"),
        ((f"`{w.symbol}`", w.axes, w.meaning) for w in (*fields.WORK, *fields.MEMORY_WORK, *fields.CONTACT_WORK)),
    )
    written = table(
        ("key", "name in files", "meaning"),
        ((f"`{q.key}`", q.name("*body*"), q.meaning) for q in quantities.TABLE),
    )
    groups = "\n".join(f"* `{word}`: {', '.join(keys)}" for word, keys in quantities.GROUPS.items())
    return (
        f"# Fields\n\n{NOTE}\n\n## Fields of the state\n\n{state}\n\n"
        f"## Internal variables of models\n\n{internal}\n\n"
        f"## What kernels leave for one another\n\nThe letters of the axes are lengths: m bodies, b body groups, j and i cells "
        f"with ghosts, J and I vertices, k rows of `State.q`, n internal variables, B blocks of rows, L vertices along the "
        f"longer direction. From `{fields.CONTACT_WORK[0].symbol}` on, only contact has them.\n\n{work}\n\n"
        f"## Quantities in output files\n\n{written}\n\n"
        f"Words for several of them:\n\n{groups}"
    )


def _model(description) -> str:
    parameters = "No parameters."
    if description.parameters:
        rows = ((f"`{name}`", *rest) for name, *rest in description.table())
        parameters = table(("parameter", "symbol", "unit", "default", "meaning"), rows)
    return (
        f"### `{description.name}`\n\n{code(description.equation)}\n\nValidity: {prose(description.validity)}.\n\n"
        f"Source: {prose(description.source)}.\n\n{parameters}"
    )


def models_page() -> str:
    """Every equation of state, strength model and failure model, and the melting line."""
    import eos
    import strength
    from hydro2d.base.parameters import described
    from strength import melting, tensile_pressure

    failure = [*strength.DAMAGE_MODELS, tensile_pressure.NAME]
    parts = [f"# Models\n\n{NOTE}", "## Equations of state", *(_model(eos.describe(name)) for name in eos.MODELS)]
    parts += ["## Strength", *(_model(strength.describe(name)) for name in strength.STRENGTH_MODELS)]
    parts += ["## Melting", _model(described(melting, "melting line of a material"))]
    parts += ["## Failure", *(_model(strength.describe_damage(name)) for name in failure)]
    return "\n\n".join(parts)


def _penetration_model(model) -> str:
    from hydro2d.analytic import model_text

    inputs = (
        (f"`{entry.name}`", entry.symbol, entry.unit or "word", model_text.default(entry), model_text.meaning(entry))
        for entry in model.inputs
    )
    outputs = ((f"`{entry.name}`", entry.symbol, entry.unit or "word", entry.description) for entry in model.outputs)
    parts = [
        f"## `{model.name}`", f"{model.title}.", f"Source: {model.source}.", f"Validity: {model.validity}.",
        table(("input", "symbol", "unit", "default", "meaning"), inputs),
        table(("output", "symbol", "unit", "meaning"), outputs),
        f"```sh\n{model_text.example_command(model)}\n```",
        f"![{model.title}](models/{model.name}.png)",
    ]
    return "\n\n".join(parts)


def penetration_page() -> str:
    """Every analytic penetration model: inputs, outputs, example, figure."""
    from hydro2d.penetration import catalogue

    lead = (
        f"{NOTE} `hydro2d model NAME` prints the same. Where the default is *material*, the material library gives the value "
        "of the rod or the target that is named. The figures show the models' own examples."
    )
    return "\n\n".join([f"# Penetration models\n\n{lead}", *map(_penetration_model, catalogue.MODELS.values())])


def draw_models(folder: Path) -> None:
    """A figure of every penetration model at its example, ``folder/NAME.png``; those that are newer than the code stay."""
    from hydro2d.analytic import model_figures, models
    from hydro2d.penetration import catalogue
    from hydro2d.results import figures

    folder.mkdir(parents=True, exist_ok=True)
    sources = [*Path(catalogue.__file__).parent.glob("*.py"), Path(models.__file__), Path(model_figures.__file__)]
    changed = max(file.stat().st_mtime for file in sources)
    for entry in catalogue.MODELS.values():
        file = folder / f"{entry.name}.png"
        if not file.is_file() or file.stat().st_mtime < changed:
            low, high = entry.example.velocities
            case = models.example(entry)
            velocities = [low + (high - low) * n / (POINTS - 1) for n in range(POINTS)]
            figures.save_figure(model_figures.draw(case, case.rows(velocities)), file)


def results_page() -> str:
    """Columns of the history and keys of the summary."""
    from hydro2d.measure import audit
    from hydro2d.mesh.sinks import SINKS
    from hydro2d.output.history import unit
    from hydro2d.running import columns

    def rows(names: dict[str, str]):
        return ((f"`{name}`", "" if unit(name) == "1" else unit(name), meaning) for name, meaning in names.items())

    return "\n\n".join([
        "# Results", NOTE,
        "In a name, `BODY` stands for the name of a body, `TARGET` for that of a target, "
        "`STATION` for `tracer_NAME` or `gauge_NAME`, `SINK` and `TRANSFER` "
        "for one of the [names below](#sinks-and-contact-transfers). All numbers are in SI units, of the whole "
        "circumference, and in planar geometry per metre of depth. A number that is not known is NaN in the history and "
        "`null` in the summary: that of a rod in a deck without rod and target, of a station outside of the mesh.",
        "## Columns of `history.h5`", "Those of stations are kept [together](../files.md#numbers-of-a-run) in the file.",
        table(("column", "unit", "meaning"), rows(columns.HISTORY)),
        "## Keys of `summary.json`", "A dot leads into a table.",
        table(("key", "unit", "meaning"), rows(columns.SUMMARY)),
        "## Sinks and contact transfers",
        table(("sink", "what it is"), ((f"`{name}`", meaning) for name, meaning in SINKS.items())),
        table(("contact transfer", "what it is"),
              ((f"`{name}`", meaning) for name, meaning in audit.CONTACT_TRANSFERS.items())),
    ])


#: decks of problems/shapes in the order of the gallery
SHAPES = ("flat", "flat_rounded", "hemispherical", "ogive", "cone", "sphere", "polygon")


def shapes_page() -> str:
    """A gallery of projectiles: the body as its deck has it, and its picture."""
    from hydro2d.files.shipped import problems_folder

    parts = ["# Shapes", NOTE,
             "The decks are in `problems/shapes`; each picture is what `hydro2d check DECK --picture FILE.png` draws. Any of "
             "these bodies can be a projectile or a target, and bodies can be joined. [Deck keys](deck.md) has all their keys."]
    for name in SHAPES:
        text = (problems_folder() / "shapes" / f"{name}.toml").read_text(encoding="utf-8")
        title = text.split('title = "', 1)[1].split('"', 1)[0]
        body = "[[body]]" + text.split("[[body]]", 2)[1]
        parts += [f"## {title}", f"![{title}](shapes/{name}.png)", f"```toml\n{body.strip()}\n```"]
    return "\n\n".join(parts)


def draw_shapes(folder: Path) -> None:
    """The pictures of the gallery, by the command that a reader has."""
    from hydro2d.cli.main import call
    from hydro2d.files.shipped import problems_folder

    folder.mkdir(parents=True, exist_ok=True)
    for name in SHAPES:
        file, deck = folder / f"{name}.png", problems_folder() / "shapes" / f"{name}.toml"
        if not file.is_file() or file.stat().st_mtime < deck.stat().st_mtime:
            with contextlib.redirect_stdout(io.StringIO()):
                if call(["check", str(deck), "--picture", str(file)]) != 0:
                    raise RuntimeError(f"the picture of problems/shapes/{name}.toml could not be drawn")


def pages() -> dict[str, str]:
    """Every generated page by file name."""
    return {
        "api.md": api.page(),
        "deck.md": deck.page(),
        "fields.md": fields_page(),
        "results.md": results_page(),
        "shapes.md": shapes_page(),
        "models.md": models_page(),
        "materials.md": materials.page(),
        "penetration-models.md": penetration_page(),
        "commands.md": commands.page(),
    }


def write(folder: Path) -> None:
    """Writes the pages and the figures that changed."""
    folder.mkdir(parents=True, exist_ok=True)
    draw_models(folder / "models")
    draw_shapes(folder / "shapes")
    for name, text in pages().items():
        file = folder / name
        if not file.is_file() or file.read_text(encoding="utf-8") != text + "\n":
            file.write_text(text + "\n", encoding="utf-8")
