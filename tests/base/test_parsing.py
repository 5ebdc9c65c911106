"""Python text is parsed by one thread at a time, and only there."""

import ast
import re
import threading
import time
from pathlib import Path
from types import SimpleNamespace

from hydro2d.base import parsing

ROOT = Path(__file__).parents[2]


def test_no_two_threads_parse_at_once(monkeypatch):
    """The parsing here is slow, and would notice another one that has begun."""
    inside, most = [0], [0]

    def slow(text, mode):
        inside[0] += 1
        most[0] = max(most[0], inside[0])
        time.sleep(0.02)
        inside[0] -= 1
        return ast.parse(text, mode=mode)

    monkeypatch.setattr(parsing, "ast", SimpleNamespace(parse=slow))
    threads = [threading.Thread(target=parsing.parsed, args=("1 + 1", "eval")) for _ in range(5)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most[0] == 1


def test_nothing_else_parses():
    calls = re.compile(r"\bast\.(parse|literal_eval)\(|(?<![.\w])(?:eval|exec)\(")
    files = [str(file.relative_to(ROOT)) for wing in ("hydro2d", "eos", "strength") for file in (ROOT / wing).rglob("*.py")
             if calls.search(file.read_text(encoding="utf-8"))]
    assert files == ["hydro2d/base/parsing.py"]
