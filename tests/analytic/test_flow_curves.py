"""Flow stress against strain: the curves, their heating, the command."""

import csv

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hydro2d.base.errors import DeckError
from hydro2d.cli.main import call
from hydro2d.materials import curves, library
from strength import STRENGTH_MODELS

STRAINS = [0.0, 0.1, 0.5, 1.5]


@pytest.mark.parametrize("name", ["W_alloy", "W_sintered", "Al7039", "iron_Armco:zerilli-armstrong", "Al6061_T651"])
def test_plastic_work_heats(name):
    """Against an integration of rho c dT = Y d(ep) by scipy."""
    material = library.load(name)
    model = STRENGTH_MODELS[material.strength.name]
    row, rho = model.row(material.strength.values), material.reference_density
    heat = material.eos.numbers["specific_heat"].value
    stress, T = curves.flow_stress(material, 1e4, STRAINS)

    def warming(ep, at):
        return [model.flow_stress(ep, 1e4, at[0], 0.0, rho, row) / (rho * heat)]

    exact = solve_ivp(warming, (0.0, 1.5), [T[0]], t_eval=STRAINS, rtol=1e-10, atol=1e-8, max_step=1e-3).y[0]
    assert T == pytest.approx(exact, rel=1e-4)
    assert T[-1] > T[0] + 50.0
    assert stress == pytest.approx([model.flow_stress(ep, 1e4, at, 0.0, rho, row)
                                    for ep, at in zip(STRAINS, exact, strict=True)], rel=1e-3)


def test_isothermal_keeps_the_temperature():
    material = library.load("Al7039")
    stress, T = curves.flow_stress(material, 1.0, STRAINS, isothermal=True)
    assert len(set(T)) == 1
    assert stress == pytest.approx(337e6 + 343e6 * np.array(STRAINS) ** 0.41, rel=1e-12)


def test_a_curve_at_a_temperature():
    """Johnson-Cook: the stress falls by 1 - ((T - 298)/(Tm - 298))^m, and the plastic work heats from there on."""
    material = library.load("Ti_6Al_4V")
    cold, _ = curves.flow_stress(material, 1.0, STRAINS, isothermal=True)
    hot, T = curves.flow_stress(material, 1.0, STRAINS, isothermal=True, temperature=800.0)
    assert (T == 800.0).all()
    assert hot == pytest.approx(cold * (1.0 - ((800.0 - 298.0) / (1878.0 - 298.0)) ** 0.8), rel=1e-9)
    _, T = curves.flow_stress(material, 1.0, STRAINS, temperature=800.0)
    assert T[0] == 800.0 < T[1]


def test_a_gas_has_no_curve():
    with pytest.raises(DeckError, match="gas_7_5 has no strength"):
        curves.flow_stress(library.load("gas_7_5"), 1.0, STRAINS)


def test_the_command(tmp_path, capsys):
    table, picture = tmp_path / "t.csv", tmp_path / "p.png"
    arguments = ["curve", "W_sintered", "W_90_7_3", "--rate", "1e3 /s", "--rate", "1e5 /s", "--strain", "0.5", "--strain", "0"]
    assert call([*arguments, "--csv", str(table), "--figure", str(picture)]) == 0
    out = capsys.readouterr().out.splitlines()
    assert out[2].split() == ["material", "rate", "[1/s]", "0", "0.5"]
    assert len([line for line in out if "johnson-cook" in line]) == 4
    rows = list(csv.DictReader(table.open()))
    assert len(rows) == 8
    stress, _ = curves.flow_stress(library.load("W_sintered"), 1e3, [0.0, 0.5])
    assert [float(row["flow stress [Pa]"]) for row in rows[:2]] == list(stress)
    assert picture.read_bytes()[:4] == b"\x89PNG"
    assert call(["curve", "Ti_6Al_4V", "--rate", "1 /s", "--strain", "0", "--isothermal", "--temperature", "800 K"]) == 0
    out = capsys.readouterr().out.splitlines()
    assert out[0].endswith("at a constant temperature, from 800 K on")
    assert out[3].split()[-1] == "518"
    assert call(["curve", "W_sintered", "--temperature", "0 K"]) == 2
    assert "--temperature must be above 0 K" in capsys.readouterr().err
    assert call(["curve", "W_sintered", "--rate", "-1 /s"]) == 2
    assert "must not be negative" in capsys.readouterr().err
    assert call(["curve", "W_sintered", "--rate", "1e3"]) == 2
    assert '--rate: 1000 has no unit; write "1000 /s"' in capsys.readouterr().err
    assert call(["curve", "W_sinterd"]) == 2
