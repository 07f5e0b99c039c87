"""The same answers under several instruction sets of this machine."""

import ast
import json
import subprocess
import sys
from pathlib import Path

import pytest

from scripts.any_machine import SHORT, cases, difference, playable, relative, run_set, table

ROOT = Path(__file__).parent.parent


QUESTIONS = [name for name in SHORT if not name.startswith(("whole", "bend", "relax K"))]
"""Few, for each compiles kernels of its own; `make any-machine` asks all."""


@pytest.mark.slow
def test_answers_are_the_same_under_the_oldest_instruction_set(tmp_path):
    """Kernels are compiled for it anew; all others are those of this machine."""
    sets = [name for name in ("skylake-avx512", "haswell", "nehalem") if name in playable()]
    if len(sets) < 2:
        pytest.skip("this processor has one instruction set only")
    oldest, here = sets[-1], tmp_path / "here.json"
    command = [sys.executable, "-m", "scripts.any_machine", "--answer", here, *QUESTIONS]
    subprocess.run(command, cwd=ROOT, check=True)
    answers = {"here": json.loads(here.read_text()), oldest: run_set(oldest, QUESTIONS, tmp_path)}
    lines, beyond = table(answers)
    assert not beyond, "\n".join(lines)


def test_the_short_form_asks_what_the_long_one_asks():
    assert set(SHORT) <= cases().keys()


def test_energies_and_sizes_are_held_to_more_digits():
    first = {"energy_n_mm": 1.0, "cell_course_mm": 2.0, "moment_n": 1.0, "seconds": 3.0}
    other = {"energy_n_mm": 1.0 + 2e-6, "cell_course_mm": 2.0, "moment_n": 1.00005, "seconds": 9.0}
    sizes, others, worst = difference(first, other)
    assert sizes == pytest.approx(2e-6, rel=1e-3)
    assert others == pytest.approx(5e-5, rel=1e-3)
    assert worst == ".energy_n_mm"
    moduli = {"shear_modulus_n_per_mm": 1.0}, {"shear_modulus_n_per_mm": 1.00002}
    assert difference(*moduli)[:2] == (0.0, pytest.approx(2e-5, rel=1e-3))


def test_other_words_and_other_shapes_differ_beyond_measure():
    assert difference({"minimum": True}, {"minimum": False})[1] == float("inf")
    assert relative([1.0, 2.0], [1.0]) == float("inf")
    assert relative([1.0, 1e-12], [1.0, 2e-12]) == pytest.approx(1e-12)
    assert relative(1e-15, -1e-12) == 0.0


SAME_EVERYWHERE = sorted(
    path
    for folder in ("yarn", "cloth/space", "linear")
    for path in (ROOT / "knitcore" / folder).rglob("*.py")
)
SUMMED = {
    "yarn/solve/fronts.py": "whole numbers",
    "yarn/paper/bezier_relax.py": "whole numbers",
    "yarn/model/relaxed_cell.py": "seconds",
    "yarn/solve/search.py": "whole numbers",
    "yarn/loops/relaxed_stitches.py": "whole numbers",
    "yarn/loops/drawn_yarn.py": "whole numbers",
}
"""Files of these rooms that use Python's sum, and why they may."""
LINEAR = {
    "yarn/study/bent_cell.py": "a linear response, which hangs on no last digit",
    "yarn/study/yarn_tube.py": "the same",
    "yarn/solve/clasps.py": "logarithms of determinants, compared with a margin",
    "yarn/study/sweep.py": "a measure of what was found",
    "yarn/solve/rounds.py": "the force that is left",
    "cloth/space/curl.py": "turns what was found",
    "cloth/space/surface.py": "draws what was found",
    "linear/grid_factor.py": "the solver of cut cloth, which leaves no saddle",
}
"""Files of these rooms that use BLAS, and why they may."""


def _uses_blas(path: Path) -> bool:
    """Return whether a file has a product of matrices, or calls a library's linear algebra; the
    lengths of many vectors are sums."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult):
            return True
        if isinstance(node, ast.ImportFrom) and node.module in (
            "scipy.linalg",
            "scipy.sparse.linalg",
        ):
            return True
        if isinstance(node, ast.Call):
            called = ast.unparse(node.func)
            lengths = called == "np.linalg.norm" and any(k.arg == "axis" for k in node.keywords)
            raised = called == "np.linalg.LinAlgError"
            if "linalg." in called and "(" not in called and not (lengths or raised):
                return True
    return False


def test_shapes_are_found_without_blas():
    """Its sums differ between processors, and a shape that leaves a saddle hangs on them."""
    modules = {
        str(path.relative_to(ROOT / "knitcore"))
        for path in SAME_EVERYWHERE
        if _uses_blas(path) and "paper" not in path.parts
    }
    assert modules == LINEAR.keys()


def test_shapes_are_found_without_pythons_sum():
    """It rounds otherwise from Python 3.12 on."""
    modules = {
        str(path.relative_to(ROOT / "knitcore"))
        for path in SAME_EVERYWHERE
        if any(
            isinstance(node, ast.Call) and ast.unparse(node.func) == "sum"
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        )
    }
    assert modules == SUMMED.keys()
