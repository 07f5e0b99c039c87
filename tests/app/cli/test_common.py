"""Kernels are compiled once on a machine, and a command says so."""

from pathlib import Path

import pytest

from knitcore import warm_up
from knitcore.base.compiled import COMPILING
from tests.app.command_line import printed
from tests.app.running import python

KERNEL = """
from knitcore.base.compiled import compiled

@compiled
def twice(x):
    return 2 * x
"""
CALL = """
import contextlib, gc, sys
import kernel
import knitcore.base.compiled
from knitcore_app.cli.common import telling_what_is_compiled

knitcore.base.compiled.TELL_AFTER_S = 0.0
told = telling_what_is_compiled() if sys.argv[1] == "command" else contextlib.nullcontext()
with told:
    assert kernel.twice(21) == 42
assert gc.isenabled()
"""


def stderr(folder: Path, program: str) -> str:
    """Words of a program on stderr when it first calls a kernel."""
    (folder / "kernel.py").write_text(KERNEL)
    return python("-c", CALL, program, cwd=folder, env=_cache(folder / "cache")).stderr


def _cache(folder: Path) -> dict[str, str]:
    return {"NUMBA_CACHE_DIR": str(folder)}


@pytest.mark.slow
def test_only_a_command_says_that_it_compiles_and_only_when_it_does(tmp_path: Path) -> None:
    ours, theirs = tmp_path / "ours", tmp_path / "theirs"
    for folder in (ours, theirs):
        folder.mkdir()
    assert stderr(ours, "command") == f"{COMPILING}\n"
    assert stderr(ours, "command") == ""
    assert stderr(theirs, "library") == ""


def nothing() -> None:
    """Compile nothing."""


def test_warm_up_names_the_parts_that_are_done(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(warm_up, "TASKS", (nothing,))
    result = printed("warm-up")
    assert result.stdout == ""
    assert result.stderr.splitlines() == [
        "Compiling kernels for this processor in 1 parts …",
        "1 of 1: nothing",
    ]


COMPILED = """
import sys
from numba.core import event

compiled = set()


class Names(event.Listener):
    def on_start(self, event):
        function = event.data["dispatcher"].py_func
        compiled.add(f"{function.__module__}.{function.__name__}")

    def on_end(self, event):
        pass


event.register("numba:compile", Names())
import knitcore
from knitcore.cloth.space import tangent
from knitcore.cloth.space.curl import curl
from knitcore.linear import front_tree

curl(knitcore.StitchChart.parse("K/P").tile(2, 4), knitcore.material("acrylic"))
needed = front_tree._eliminate, front_tree._forward, front_tree._backward, tangent._hinges
for kernel in needed:
    name = f"{kernel.__module__}.{kernel.__name__}"
    assert kernel._made.signatures and name not in compiled, name
"""


@pytest.mark.slow
def test_other_processes_compile_what_is_needed_late(tmp_path: Path) -> None:
    for number in ("0", "1"):
        module = "knitcore.cloth.space.sheet_kernels"
        python("-m", "knitcore.compile_share", module, number, env=_cache(tmp_path))
    python("-c", COMPILED, env=_cache(tmp_path))
