"""Tests of hydro2d."""

import os

# threads that wait for work give their core away: on a machine that does other things as well, spinning ones would crawl
os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")
