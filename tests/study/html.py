"""A page taken apart, and its faults."""

from __future__ import annotations

from html.parser import HTMLParser

VOID = {"meta", "img", "br", "wbr"}


class Page(HTMLParser):
    """Elements, their attributes and the text of a page; ``faults`` lists markup that is not well-formed or leads outside.

    Words that may break into two lines are one in the text.
    """

    def __init__(self, text: str):
        super().__init__()
        self.open: list[str] = []
        self.elements: list[tuple[str, dict]] = []
        self.faults: list[str] = []
        self.words: list[str] = []
        self.joined = False
        self.feed(text)
        self.close()
        self.faults += [f"<{name}> is not closed" for name in self.open]
        ids = [attributes["id"] for _, attributes in self.elements if "id" in attributes]
        self.faults += [f'id "{name}" is there {ids.count(name)} times' for name in set(ids) if ids.count(name) > 1]
        for name, attributes in self.elements:
            self.faults += self._addresses(name, attributes, ids)
            if name == "img" and not attributes.get("alt"):
                self.faults.append("a picture has no words")
            if name == "th" and "scope" not in attributes:
                self.faults.append("a heading of a table has no scope")

    def _addresses(self, name, attributes, ids):
        for key in ("src", "href"):
            value = attributes.get(key)
            if value is None or (value.startswith("data:") and (key == "src" or attributes.get("download"))):
                continue
            if key == "href" and value.startswith("../") and value.endswith("/view.html"):  # of a run next to the report
                continue
            if not value.startswith("#"):
                yield f"<{name}> leads to {value[:60]}"
            elif value[1:] not in ids:
                yield f"{value} leads nowhere"

    def handle_starttag(self, tag, attrs):
        keys = [key for key, _ in attrs]
        if len(keys) != len(set(keys)):
            self.faults.append(f"<{tag}> has an attribute twice")
        self.joined = self.joined or tag == "wbr"
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> closes nothing")

    def handle_data(self, data):
        if not {"style", "script"} & set(self.open):
            if self.joined and self.words:
                data = self.words.pop() + data
            self.joined = False
            self.words.append(data)

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())

    def all(self, name: str) -> list[dict]:
        return [attributes for each, attributes in self.elements if each == name]
