"""Models from outside for tests, a deck with one, and a process of its own to load it in."""

import os
import subprocess
import sys
import textwrap
from pathlib import Path

import eos.dispatch
import hydro2d
import strength.dispatch

#: loaded before any model of these tests: the kernels of the other tests in this process have only hydro2d's models
KERNELS = eos.dispatch, strength.dispatch

VOCE = '''\
"""Voce hardening."""

import math

import numpy as np

from hydro2d.jit import point
from hydro2d.base.parameters import REQUIRED, Parameter, collect
from strength.layout import ROW, SHEAR, YIELD

NAME = "own-voce"
CONSTANT_MODULUS = True
THERMAL = False
EQUATION = "Y = Y0 + Q (1 - exp(-10 ep))"
SOURCE = "Voce, J. Inst. Metals 74 (1948) 537"
VALIDITY = "metals at one rate and temperature"
PARAMETERS = (
    Parameter("shear_modulus", "Pa", REQUIRED, "shear modulus", "G"),
    Parameter("yield_stress", "Pa", REQUIRED, "initial yield stress", "Y0"),
    Parameter("saturation", "Pa", 0.0, "what hardening adds at most", "Q"),
)
EXAMPLE = {"shear_modulus": 26e9, "yield_stress": 240e6, "saturation": 150e6}


@point
def shear_modulus(p, rho, T, par):
    """Shear modulus, Pa."""
    return par[SHEAR]


@point
def flow_stress(ep, rate, T, p, rho, par):
    """Flow stress, Pa."""
    return par[YIELD] + par[2] * (1.0 - math.exp(-10.0 * ep))


def row(values):
    given = collect(NAME, PARAMETERS, values)
    par = np.zeros(ROW)
    par[:3] = given["shear_modulus"], given["yield_stress"], given["saturation"]
    return par
'''
#: a gas and a damage model, as short as can be
GAS = '''\
"""An ideal gas with gamma = 2."""

import numpy as np

from eos.layout import ROW
from hydro2d.jit import point
from hydro2d.base.parameters import REQUIRED, Parameter, collect

NAME = "gamma-two"
EQUATION = "p = rho e"
SOURCE = "a test"
VALIDITY = "everywhere"
PARAMETERS = (Parameter("reference_density", "kg/m^3", REQUIRED, "density at rest", "rho0"),)
EXAMPLE = {"reference_density": 1.2}
DENSITIES, ENERGIES = (0.01, 0.1, 1.0, 10.0), (1e5, 1e6, 1e7)


@point
def evaluate(rho, e, par):
    """(p, dp/drho, dp/de, T), SI."""
    return rho * e, e, rho, max(e, 0.0) / 700.0


def row(values):
    par = np.zeros(ROW)
    par[0] = collect(NAME, PARAMETERS, values)["reference_density"]
    return par
'''
STRAIN = '''\
"""Damage that grows with the plastic strain."""

import numpy as np

from hydro2d.jit import point
from hydro2d.base.parameters import POSITIVE, REQUIRED, Parameter, collect
from strength.layout import DAMAGE_ROW

NAME = "strain"
THERMAL = False
EQUATION = "dD = dep/ef"
SOURCE = "a test"
VALIDITY = "everywhere"
PARAMETERS = (Parameter("fracture_strain", "", REQUIRED, "strain at fracture", "ef", POSITIVE),)
EXAMPLE = {"fracture_strain": 0.3}


@point
def damage_increment(dep, rate, T, p, seq, par):
    """Increment of damage."""
    return dep / par[0]


def row(values):
    par = np.zeros(DAMAGE_ROW)
    par[0] = collect(NAME, PARAMETERS, values)["fracture_strain"]
    return par
'''
DECK = """\
[mesh]
r = [{ to = "6 mm", cells = 6 }]
z_start = "-6 mm"
z = [{ to = "6 mm", cells = 12 }]

[[body]]
name = "ball"
shape = "sphere"
material = "Al5083"
radius = "4 mm"
centre = 0
velocity = "800 m/s"

[materials.Al5083]
based_on = "Al5083"

[materials.Al5083.strength]
file = "my_model.py"
shear_modulus = "26 GPa"
yield_stress = "240 MPa"

[stop]
time = "1 us"
"""


def python(text: str, folder: Path, *path: Path) -> str:
    """Output of a process of its own, in a folder, with further folders of packages."""
    root = Path(hydro2d.__file__).resolve().parent.parent
    variables = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, (root, *path)))}
    command = [sys.executable, "-c", textwrap.dedent(text)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, env=variables)
    return done.stdout + done.stderr
