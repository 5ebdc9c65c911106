"""Puts compiled kernels into the wheel that `python -m build` makes, so that the first run need not compile them.

`pip install .` does not compile, since what it builds serves one machine, whose first run compiles for just its processor; nor
does an editable install. HYDRO2D_BUILD_COMPILED=1 compiles for pip as well, and 0 compiles for nobody.
"""

import os
import platform
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

#: named targets of `hydro2d/jit/target.py` by the kind of machine
TARGETS = {"x86_64": "x86-64-v3", "aarch64": "generic"}


class CompiledKernels(BuildHookInterface):
    """Compiles for the named target of this machine, in a process that sees the sources and nothing of the user's."""

    folder: str | None = None

    def _wanted(self) -> bool:
        by_default = "PIP_BUILD_TRACKER" not in os.environ and platform.machine() in TARGETS  # pip sets it, as hatchling knows
        return self.target_name == "wheel" and (os.environ.get("HYDRO2D_BUILD_COMPILED") or str(int(by_default))) != "0"

    def dependencies(self) -> list[str]:
        """The dependencies of hydro2d, in the newest versions that are allowed, to compile."""
        return list(self.metadata.core.dependencies) if self._wanted() else []

    def initialize(self, version: str, build_data: dict) -> None:
        if version == "editable" or not self._wanted():
            return
        self.folder = tempfile.mkdtemp(prefix="hydro2d-compiled-")
        compiled = Path(self.folder) / "_compiled"
        own = {name: value for name, value in os.environ.items() if not name.startswith(("NUMBA_", "HYDRO2D_"))}
        own |= {"HYDRO2D_CACHE_DIR": str(compiled), "HYDRO2D_TARGET": TARGETS[platform.machine()], "PYTHONPATH": self.root}
        try:
            subprocess.run([sys.executable, "-m", "hydro2d.running.compile_all"], cwd=self.folder, env=own, check=True)
        except subprocess.CalledProcessError as problem:
            self.finalize(version, build_data, "")
            raise SystemExit(f"hydro2d: no compiled kernels for the wheel ({problem}); "
                             "HYDRO2D_BUILD_COMPILED=0 builds one without") from None
        build_data["force_include"][str(compiled)] = "hydro2d/_compiled"

    def finalize(self, version: str, build_data: dict, artifact_path: str) -> None:
        if self.folder:
            shutil.rmtree(self.folder)
