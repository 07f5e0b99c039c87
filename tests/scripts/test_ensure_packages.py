"""Packages for the tests are installed by one process at a time."""

import os
import subprocess
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "scripts" / "ensure-packages"
APT = """#!/bin/sh
echo begin >>"$(dirname "$0")/log"
sleep 0.2
echo end >>"$(dirname "$0")/log"
"""


@pytest.mark.skipif(os.geteuid() != 0, reason="only the superuser installs packages")
def test_two_installations_take_turns(tmp_path: Path) -> None:
    program = tmp_path / "apt-get"
    program.write_text(APT, encoding="utf-8")
    program.chmod(0o755)
    environment = os.environ | {"PATH": f"{tmp_path}:{os.environ['PATH']}"}
    both = [subprocess.Popen([SCRIPT, "a-package"], env=environment) for _ in range(2)]
    assert [process.wait(timeout=120) for process in both] == [0, 0]
    assert (tmp_path / "log").read_text(encoding="utf-8").split() == ["begin", "end"] * 4
