"""Tests of hydro2d."""

import os

# waiting threads give up their core: spinning ones would crawl on a machine that does other things as well
os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")
