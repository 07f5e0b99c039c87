"""Kernels are compiled once on a machine, and a command says so."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from knitcore import warm_up
from knitcore.base.compiled import COMPILING
from tests.app.command_line import printed

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
    """What the first call of a kernel in a program says."""
    (folder / "kernel.py").write_text(KERNEL)
    environment = os.environ | {"NUMBA_CACHE_DIR": str(folder / "cache")}
    told = subprocess.run(
        [sys.executable, "-c", CALL, program],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    return told.stderr


def test_a_command_says_once_that_it_compiles_and_is_silent_when_that_is_done(
    tmp_path: Path,
) -> None:
    assert stderr(tmp_path, "command") == f"{COMPILING}\n"
    assert stderr(tmp_path, "command") == ""


def test_the_library_prints_nothing(tmp_path: Path) -> None:
    assert stderr(tmp_path, "library") == ""


def nothing() -> None:
    """Compile nothing."""


def test_warm_up_names_the_parts_that_are_done(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(warm_up, "TASKS", (nothing,))
    told = printed("warm-up")
    assert told.stdout == ""
    assert told.stderr.splitlines() == [
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
from knitcore.cloth.space.curl import curl
from knitcore.yarn.library.yarns import yarn_for

chart, acrylic = knitcore.StitchChart.parse("K/P"), knitcore.material("acrylic")
if sys.argv[1] == "yarn":
    used = yarn_for(acrylic, chart)
    knitcore.relax(chart, used.yarn, used.loop_length_mm)
else:
    curl(chart.tile(2, 4), acrylic)
print(*compiled)
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("study", "module", "spared"),
    [
        (
            "yarn",
            "knitcore.yarn.kernels.curve_samples",
            {"yarn.kernels.rod.rod_hessian", "yarn.kernels.scatter.scatter_local",
             "linear.dense.eliminate", "linear.dense.substitute", "linear.dense.solved",
             "yarn.solve.clasps._crossings"},
        ),
        (
            "shape",
            "knitcore.cloth.space.sheet_kernels",
            {f"linear.front_tree.{name}" for name in ("_eliminate", "_forward", "_backward")},
        ),
    ],
)  # fmt: skip
def test_a_second_process_compiles_what_is_needed_last(
    tmp_path: Path, study: str, module: str, spared: set[str]
) -> None:
    def compiled(cache: str) -> set[str]:
        told = subprocess.run(
            [sys.executable, "-c", COMPILED, study],
            env=os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / cache)},
            capture_output=True,
            text=True,
            check=True,
        )
        return {name.removeprefix("knitcore.") for name in told.stdout.split()}

    subprocess.run(
        [sys.executable, "-m", "knitcore.warm_up", module],
        env=os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "kept")},
        check=True,
    )
    assert spared <= compiled("new")
    assert not spared & compiled("kept")
