"""Counts of the repository, for a change that should make it smaller: `python -m tests.rules.counts`.

Lines of Python by folder, the forms that a row of a table has, the places in the program that one more result, number of the
method or coefficient of a model takes, and the largest files.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator

from tests.rules import source
from tests.rules.test_costs import NAMED

#: an addition of each kind that exists, as the program names it
EXAMPLES = {"result": NAMED["radius_at_z_max_m"], "number of the method": NAMED["hourglass"],
            "coefficient of a model": r"\bhugoniot_slope_2\b"}
LARGEST = 10


def forms_of_a_row() -> Iterator[str]:
    """Classes and types that are called a row, as MODULE.NAME."""
    for name, file in source.modules().items():
        for node in source.tree(file).body:
            targets = [ast.unparse(each) for each in node.targets] if isinstance(node, ast.Assign) else []
            names = [node.name] if isinstance(node, ast.ClassDef) else targets
            yield from (f"{name}.{each}" for each in names if re.fullmatch(r"([A-Z][a-z]+)?Row", each))


def places(pattern: str) -> list[str]:
    """Lines of the program with a match, as FILE:LINE."""
    return [f"{file.relative_to(source.ROOT)}:{number}" for file in source.modules().values()
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1) if re.search(pattern, line)]


def lines() -> Iterator[str]:
    """What is printed."""
    files = {file.relative_to(source.ROOT): file.read_text(encoding="utf-8").count("\n")
             for file in source.tracked_files() if file.suffix == ".py"}
    rooms: Counter[str] = Counter()
    for file, count in files.items():
        for depth in (1, 2):
            rooms["/".join((file.parts[:-1] or (".",))[:depth]) + "/" * (depth == 1)] += count
    yield "lines of Python by folder"
    yield from (f"  {rooms[room]:6} {room}" for room in sorted(rooms))
    found = {"forms of a row": list(forms_of_a_row())} | {f"places of a {what}": places(EXAMPLES[what]) for what in EXAMPLES}
    yield from (f"{title}: {len(each)}: {', '.join(each)}" for title, each in found.items())
    yield f"the {LARGEST} largest files"
    yield from (f"  {count:6} {file}" for file, count in Counter(files).most_common(LARGEST))


if __name__ == "__main__":
    print("\n".join(lines()))
