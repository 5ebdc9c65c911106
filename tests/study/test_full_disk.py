"""No space at any write of a search: it ends with a message, and with --resume gets the result of an undisturbed one."""

import json

import pytest

from tests.disk import Disk
from tests.study import made_up, test_chance, test_transition

#: three velocities
BISECTION = test_transition.ALONE.replace('tolerance = "50 m/s"', 'tolerance = "300 m/s"')
BUDGET = test_chance.STUDY.replace("budget = 16", "budget = 5\nround = 3")


@pytest.mark.parametrize(("text", "becomes", "once"), [
    pytest.param(BISECTION, test_transition.usual, False, id="bisection, full from then on"),
    pytest.param(BISECTION, test_transition.usual, True, id="bisection, full for one file"),
    pytest.param(BUDGET, test_chance.chancy, False, id="budget, full from then on", marks=pytest.mark.slow),
    pytest.param(BUDGET, test_chance.chancy, True, id="budget, full for one file", marks=pytest.mark.slow),
])
def test_no_space_at_any_write_of_a_search(tmp_path, monkeypatch, capsys, text, becomes, once):
    """A search with a budget goes on without the outcome of a shot for which there was no space, and makes it later; only then
    may it choose other velocities."""
    disk = Disk(monkeypatch)

    def search(folder, **options):
        folder.mkdir(exist_ok=True)
        return made_up.search(folder, made_up.Client(becomes), text, **options)

    status, whole = search(tmp_path / "whole")
    assert (status, whole["complete"]) == (0, True)
    number = disk.count
    assert number > 30
    for full in range(1, number + 1):
        place = tmp_path / str(full)
        disk.begin(full, once)
        result, refused = {}, ""
        try:
            status, result = search(place)
        except OSError as error:
            refused = str(error)
        assert bool(result) != refused.startswith("[Errno 28] No space left on device")
        lost = bool(result) and any(run["status"] != "done" for run in result["combinations"][0]["runs"])
        assert not result or status == (3 if lost else 0)
        said = capsys.readouterr().out
        assert "Traceback" not in said
        disk.begin()
        assert not list(place.rglob("*.tmp"))
        status, result = search(place, resume=(place / "out" / "study.json").exists())
        assert status == 0
        if once and lost and text == BUDGET:
            assert result["complete"]
            assert [run["status"] for run in result["combinations"][0]["runs"]] == ["done"] * 5
        else:
            assert json.dumps(result) == json.dumps(whole), f"no space at write {full} of {number}"
