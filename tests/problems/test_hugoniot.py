"""Hugoniot temperatures: the kept tables are those of the command, and the page shows them."""

import pytest

from problems import kept
from problems.verification import hugoniot
from tests.rules import source

FOLDER = source.PROBLEMS / "verification" / "results"
CURVES = kept.rows(FOLDER / "hugoniot_temperatures.csv", hugoniot.CURVES)
BESIDE = kept.rows(FOLDER / "hugoniot_published.csv", hugoniot.BESIDE)


def test_the_kept_tables_are_what_the_command_gives():
    assert [{key: str(value) for key, value in row.items()} for row in hugoniot.curves()] == CURVES
    assert [{key: str(value) for key, value in row.items()} for row in hugoniot.beside()] == BESIDE


def test_the_command_keeps_them(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(hugoniot, "FOLDER", tmp_path)
    (tmp_path / "results").mkdir()
    assert hugoniot.main(["--keep"]) == 0
    for file in FOLDER.glob("hugoniot_*.csv"):
        assert (tmp_path / "results" / file.name).read_text() == file.read_text()
    assert hugoniot.beside_table(BESIDE)[-1] in capsys.readouterr().out


def test_the_page_shows_them():
    page = (source.ROOT / "docs/explanation/equation-of-state.md").read_text(encoding="utf-8")
    for table in (hugoniot.curve_table(CURVES), hugoniot.beside_table(BESIDE)):
        assert "\n".join(table) in page


def differences(quantity, *metals):
    of_metals = (row for row in BESIDE if row["quantity"].startswith(quantity) and row["material"] in metals)
    return [float(row["difference_percent"]) for row in of_metals]


def test_statements_of_the_pages_on_the_differences():
    """15 % too hot where melting begins, pressures within 17 %, iron more than half off, melts 36 % too hot, 11 % at 0 GPa."""
    rows = {(row["material"], row["at_GPa"]): float(row["difference_percent"]) for row in BESIDE if row["at_GPa"]}
    assert (rows["Al6061_T6", "125"], rows["copper_OFHC", "237"]) == (15.0, 16.0)
    assert max(rows.values()) == rows["Al6061_T6", "155.8"] == 36.0
    assert differences("melting pressure", "Al6061_T6", "copper_OFHC", "tantalum") == [-17.0, -3.0, -5.0, 10.0, 8.0]
    assert differences("melting pressure", "iron_Armco") == [56.0]
    at_zero = differences("melting temperature", *(row["material"] for row in BESIDE))
    assert len(at_zero) == 7
    assert max(map(abs, at_zero)) == 11.0


def test_a_state_obeys_the_jump_conditions():
    """P = rho0 (c0 + s u) u and rho0/rho = 1 - u/U for Steinberg's aluminium; the temperature does not fall."""
    metal = hugoniot.Metal("Al6061_T6")
    temperatures = []
    for u in (500.0, 2000.0, 4000.0):
        eta, T, p = metal.behind(u)
        speed = 5240.0 + 1.4 * u
        assert p == pytest.approx(2703.0 * speed * u, rel=1e-9)
        assert eta == pytest.approx(speed / (speed - u), rel=1e-9)
        assert metal.state(p) == pytest.approx((eta, T), rel=1e-6)
        temperatures.append(T)
    assert temperatures == sorted(temperatures)
    eta, T = metal.state(metal.melts_at())
    assert hugoniot.melting.temperature(eta, metal.line) == pytest.approx(T, rel=1e-6)
