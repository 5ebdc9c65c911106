"""What a run notes of its origin, whatever git and the machine say."""

import subprocess
from pathlib import Path

from hydro2d.running import provenance


def test_git_and_the_processor_may_say_anything(monkeypatch, tmp_path):
    """Text that is not UTF-8, and no text at all."""
    git = tmp_path / "git"
    git.write_text("#!/bin/sh\nprintf 'a\\377\\n'\n")
    git.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    assert provenance.git_commit() == ("a\ufffd", True)
    git.write_text("#!/bin/sh\nexit 128\n")
    assert provenance.git_commit() is None
    real = Path.read_text
    (tmp_path / "cpuinfo").write_bytes(b"model name : \xff 3\n")
    monkeypatch.setattr(Path, "read_text", lambda self, *given, **named: real(tmp_path / "cpuinfo", *given, **named))
    assert provenance.processor() == "\ufffd 3"
    monkeypatch.setattr(subprocess, "run", lambda *given, **named: (_ for _ in ()).throw(OSError("no git")))
    assert provenance.git_commit() is None
