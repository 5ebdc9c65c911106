"""HTML put together from Python: text is escaped, elements are balanced."""

from __future__ import annotations

import html
from collections.abc import Iterable

VOID = ("br", "img", "meta")


class Html(str):
    """Text that is HTML already."""


def escaped(content) -> Html:
    """Anything as HTML: text escaped, HTML as it is, None as nothing, iterables one after the other."""
    if content is None:
        return Html("")
    if isinstance(content, Html):
        return content
    if isinstance(content, (str, int, float)):
        return Html(html.escape(str(content)))
    return Html("".join(map(escaped, content)))


def element(name: str, /, *children, **attributes) -> Html:
    """One element. Attributes: class_ is class, _ stands for -, True is a bare attribute, None and False are none."""
    words = [name]
    for key, value in attributes.items():
        key = key.rstrip("_").replace("_", "-")
        if value is True:
            words.append(key)
        elif value is not None and value is not False:
            words.append(f'{key}="{html.escape(str(value))}"')
    start = f"<{' '.join(words)}>"
    return Html(start if name in VOID else f"{start}{escaped(children)}</{name}>")


def table(caption: str, heads: Iterable, rows: Iterable[Html], **attributes) -> Html:
    """A table with a caption and a row of headings, in a box of its own that scrolls; rows are elements tr."""
    head = element("tr", [element("th", text, scope="col") for text in heads])
    inner = element("table", element("caption", caption), element("thead", head), element("tbody", rows), **attributes)
    return element("div", inner, class_="scroll", tabindex="0", role="region", aria_label=caption)
