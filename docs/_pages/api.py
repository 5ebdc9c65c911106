"""The page of the Python interface: what `hydro2d.__all__` names, from its docstrings, by autodoc."""

from __future__ import annotations

import inspect

from _pages.markdown import NOTE


def page() -> str:
    """A directive of autodoc for each public name, in the order in which `hydro2d` lists their places."""
    import hydro2d

    lead = (
        f"{NOTE} These names are what programs can rely on: `import hydro2d` gives all of them. Arrays have their shapes, "
        "quantities their units; everything is in SI."
    )
    directives = (directive(f"hydro2d.{name}", getattr(hydro2d, name)) for name in hydro2d._PLACES)  # the order of use
    return "\n\n".join(["# Python interface", lead, *directives])


def directive(path: str, thing) -> str:
    """A heading and the directive that documents a function, a class with its members, a module, or a value."""
    text, options, kind = "", [], "autofunction" if callable(thing) else "autodata"
    if inspect.isclass(thing) or inspect.ismodule(thing):
        kind, options = "autoclass" if inspect.isclass(thing) else "automodule", ["   :members:"]
    signature = ""
    if hasattr(thing, "model_fields"):  # a deck or a summary: what it holds has a page of its own
        known = ("from_file", "from_toml", "from_dict", "to_toml", "edges", "body_named")
        members = [name for name in known if hasattr(thing, name)]
        page_of_it, what = ("[Deck keys](deck.md)", "a deck") if members else ("[Results](results.md)", "a summary")
        text, signature = f"{page_of_it} lists everything that {what} can hold.\n\n", "()"
        options = [f"   :members: {', '.join(members)}"] if members else []
    return "\n".join([f"## `{path}`", "", f"{text}```{{eval-rst}}", f".. {kind}:: {path}{signature}", *options, "```"])
