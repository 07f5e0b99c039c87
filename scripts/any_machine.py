"""Compare answers under several instruction sets of one machine: ``python -m scripts.any_machine``.

Every set is a process of its own, with its own cache of compiled kernels, that asks the same
questions as a client would. The table gives, for every question and set, the largest relative
difference from the first set: of energies and sizes, and of all other numbers.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

SIZES, OTHERS = 1e-6, 1e-4
"""Agreed relative difference of energies and sizes, and of all other numbers."""
NOTHING = 1e-9
"""Numbers of this size, in the units of the answer, count as zero."""
NO_FORCE_N = 1e-5
"""Forces of this size count as zero: that of a free size is what the search leaves."""
NOT_COMPARED = ("seconds", "evaluations", "iterations", "steps", "rounds", "starts", "notes")
"""Fields that tell how an answer was found, not what it is."""
LEFT_OVER = ("energy_change", "size_change", "may_fall", "largest_force_n")
"""Fields for the rest that an iteration leaves; it is bounded, not the same."""

_V3 = ("X86_V3",)
_V4 = ("X86_V4", "AVX512_ICL", "AVX512_SPR")
_NUMPY = {
    "X86_V3": "avx2", "X86_V4": "avx512f", "AVX512_ICL": "avx512_vbmi2",
    "AVX512_SPR": "avx512_fp16",
}  # fmt: skip
"""Parts of NumPy's dispatch, and the flag of a processor that has them; it refuses to switch off
others."""


@dataclass(frozen=True)
class InstructionSet:
    """A processor as the libraries are told to see it.

    Attributes
    ----------
    needs : flag of /proc/cpuinfo without which this machine cannot play it.
    numba : processor that kernels are compiled for.
    blas : kernels of OpenBLAS.
    without : parts of NumPy's dispatch that are switched off.
    tunables : of glibc, whose mathematical functions differ with and without FMA.
    """

    needs: str
    numba: str
    blas: str
    without: tuple[str, ...]
    tunables: str = ""

    @property
    def environment(self) -> dict[str, str]:
        """The variables that make it so."""
        return {
            "NUMBA_CPU_NAME": self.numba,
            "NUMBA_CPU_FEATURES": "",
            "OPENBLAS_CORETYPE": self.blas,
            "OPENBLAS_NUM_THREADS": "1",
            "NPY_DISABLE_CPU_FEATURES": ",".join(
                part for part in self.without if _NUMPY[part] in _flags()
            ),
            "GLIBC_TUNABLES": self.tunables,
        }


_NO_FMA = "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F,-AVX2_Usable,-FMA_Usable"
INSTRUCTION_SETS = {
    "haswell": InstructionSet("avx2", "haswell", "Haswell", _V4),
    "nehalem": InstructionSet("sse4_2", "nehalem", "Nehalem", _V3 + _V4, _NO_FMA),
    "skylake-avx512": InstructionSet("avx512f", "skylake-avx512", "SkylakeX", ()),
    "generic": InstructionSet("sse2", "generic", "Prescott", _V3 + _V4, _NO_FMA),
    "znver4": InstructionSet("avx512f", "znver4", "Zen", ()),
}


def cases() -> dict[str, tuple[str, dict[str, Any]]]:
    """Questions by name: an operation and its request."""
    requests: dict[str, tuple[str, dict[str, Any]]] = {}

    def ask(operation: str, chart: str, material: str, **fields: Any) -> None:
        name = " ".join([operation, chart, material, *(f"{k}={v}" for k, v in fields.items())])
        requests[name] = operation, {"chart": chart, "material": material, **fields}

    small = ("K", "K/P", "KP", "KP/PK", "KKP", "KKPP", "KKKKP", "KP/KK", "KKP/PKK", "K/K/P/P")
    for chart in small:
        ask("relax", chart, "acrylic", fresh=True)
        ask("relax", chart, "cotton", fresh=True)
    for chart in ("KKPP/PKKP/PPKK/KPPK", "PKPK/PKKP/PKPK/KPKP", "KKKPPP/PPKKPK/PKPKPK/KKPPKP"):
        ask("relax", chart, "acrylic", fresh=True)
        ask("relax", chart, "cotton", fresh=True)
    ask("relax", "KP", "cotton", flat=True, fresh=True)
    ask("relax", "KKPP/PPKK", "acrylic", flat=True, fresh=True)
    ask("relax", "KKP/PKK", "acrylic", branch="free", fresh=True)
    ask("relax", "K/P", "acrylic", branch="published", fresh=True)
    ask("relax", "KP/PK", "cotton", branch="published", fresh=True)
    ask("relax", "KP", "acrylic", cell_wale_mm=2.2, fresh=True)
    for chart in ("PKKKKP;P[2/2R]P;PKKKKP;PKKKKP", "KKKKKK;KO/\\OK", "TP;KP;PT;PK"):
        ask("relax", chart, "acrylic", fresh=True)
        ask("relax", chart, "cotton", fresh=True, history="as-knitted")
    ask("relax", "KKKKKK;KO/\\OK", "acrylic", fresh=True, history="agitated")
    ask("relax", "KKKK;VKVK;KKKK;KVKV", "cotton", fresh=True)
    ask("whole", "KPKP/KPKP/KPKP/KPKP", "cotton", flat=True)
    ask("whole", "KPKP/KPKP/KPKP/KPKP", "acrylic")
    ask("whole", "KKKPK/KPKKP/PKPKK/KKPPK/PPKKP", "acrylic")
    ask("whole", "KKKPKP/KPKKPP/PKPKKK/KKPPKP/PPKKPK/KKPKPP", "cotton", flat=True)
    for chart in ("K", "KP", "KKP", "KKKKP"):
        ask("bend", chart, "acrylic", loop_length_mm=12.0)  # one that is not stored
        ask("bend", chart, "cotton")
    ask("tube", "K", "acrylic", wales=60)
    ask("tube", "KKPP", "acrylic", wales=80)
    ask("sweep", "K/P", "acrylic", direction="wale", max_strain=0.3, points=7)
    ask("sweep", "KKP/PKK", "cotton", direction="course", max_strain=0.3, points=7)
    ask("hysteresis", "KP", "acrylic", points=6, rest_sizes=False)
    for chart in ("KKPP", "KKP/PKK"):
        ask("predict", chart, "acrylic")
        ask("curve", chart, "cotton", direction="course", stress_n_per_mm=[0.0, 0.05, 0.1])
    for fabric, rows in (("stockinette", 12), ("rib", 8)):
        piece = {"fabric": fabric, "columns": 12, "rows": rows}
        requests[f"curl {fabric} 12x{rows}"] = "curl", {"chart": piece, "material": "acrylic"}
    for fabric, direction in (("garter", "wale"), ("seed", "course")):
        requests[f"stretch {fabric} 20x20 {direction}"] = "stretch", {
            "chart": {"fabric": fabric, "columns": 20, "rows": 20}, "material": "acrylic",
            "direction": direction, "strain": 0.5, "steps": 5,
        }  # fmt: skip
    weight = {"linear_density_g_per_m": 0.5}
    requests["border K"] = (
        "border",
        {"chart": "K", "material": "acrylic", "border": "rib", **weight},
    )
    requests["drape K/P"] = "drape", {"chart": "K/P", "material": "acrylic", "across": 10, **weight}
    requests["overhang K/P"] = "overhang", {"chart": "K/P", "material": "acrylic", **weight}
    return requests


SHORT = (
    "relax K acrylic fresh=True",
    "relax KP cotton fresh=True",
    "relax KKKKP cotton fresh=True",
    "relax PKPK/PKKP/PKPK/KPKP cotton fresh=True",
    "relax PKKKKP;P[2/2R]P;PKKKKP;PKKKKP acrylic fresh=True",
    "whole KPKP/KPKP/KPKP/KPKP cotton flat=True",
    "bend KKP acrylic loop_length_mm=12.0",
    "curl rib 12x8",
    "stretch garter 20x20 wale",
)
"""Questions that take half a minute together, kernels compiled."""


def answered(names: list[str]) -> Iterator[tuple[str, Any]]:
    """Ask the questions here; an error's text stands in place of its answer."""
    from app.context import Context
    from app.operations.perform import Viewed
    from app.operations.registry import operations
    from knitcore.base.errors import KnitcoreError

    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            operation, request = cases()[name]
            known = operations()[operation]
            clock = time.process_time()
            try:
                answer = known.run(known.request.model_validate(request), Context(Path(folder)))
            except KnitcoreError as error:
                yield name, {"error": str(error)}
            else:
                result = answer.result if isinstance(answer, Viewed) else answer
                yield name, result.model_dump(mode="json")
            print(f"  {name}: {time.process_time() - clock:.1f} s", file=sys.stderr, flush=True)


def flattened(answer: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """The values of an answer with their places; lists of numbers stay lists."""
    if isinstance(answer, dict):
        for name, value in answer.items():
            if name not in (*NOT_COMPARED, *LEFT_OVER):
                yield from flattened(value, f"{path}.{name}")
    elif isinstance(answer, list) and not all(isinstance(v, float | int) for v in answer):
        for k, value in enumerate(answer):
            yield from flattened(value, f"{path}[{k}]")
    else:
        yield path, answer


def difference(answer: Any, other: Any) -> tuple[float, float, str]:
    """Largest relative difference of energies and sizes, and of other numbers, of two answers, and
    the place of the worst, measured by what is agreed; infinite where words or shapes differ."""
    first, second = dict(flattened(answer)), dict(flattened(other))
    largest = {SIZES: 0.0, OTHERS: 0.0}
    worst, where = 0.0, ""
    for place in first.keys() | second.keys():
        a, b = first.get(place), second.get(place)
        name = place.rpartition(".")[2]
        is_size = name.endswith("_mm") and not name.endswith(("_n_mm", "_per_mm"))
        agreed = SIZES if is_size or "energy" in name else OTHERS
        by = relative(a, b, NO_FORCE_N if name.startswith("force_") else NOTHING)
        largest[agreed] = max(largest[agreed], by)
        if by / agreed > worst:
            worst, where = by / agreed, place
    return largest[SIZES], largest[OTHERS], where


def relative(a: Any, b: Any, nothing: float = NOTHING) -> float:
    """Relative difference of two numbers, or of two lists by the largest in them; none where all
    are as small as ``nothing``."""
    left, right = (v if isinstance(v, list) else [v] for v in (a, b))
    numbers = all(isinstance(v, float | int) and not isinstance(v, bool) for v in (*left, *right))
    if not numbers or len(left) != len(right):
        return 0.0 if a == b else float("inf")
    scale = max((abs(v) for v in (*left, *right)), default=0.0)
    if scale < nothing:
        return 0.0
    return max((abs(v - w) for v, w in zip(left, right, strict=True)), default=0.0) / scale


def playable() -> list[str]:
    """The instruction sets that this machine has."""
    return [name for name, of in INSTRUCTION_SETS.items() if of.needs in _flags()]


@cache
def _flags() -> set[str]:
    """Words of this machine's description of its processors."""
    return set(Path("/proc/cpuinfo").read_text(encoding="ascii").split())


def run_set(name: str, names: list[str], folder: Path) -> dict[str, Any]:
    """The answers under one instruction set, from a process of its own."""
    out = folder / f"{name}.json"
    cache = {"NUMBA_CACHE_DIR": str(folder / "kernels" / name)}
    subprocess.run(
        [sys.executable, "-m", "scripts.any_machine", "--answer", str(out), *names],
        env=os.environ | INSTRUCTION_SETS[name].environment | cache, check=True,
    )  # fmt: skip
    answers: dict[str, Any] = json.loads(out.read_text(encoding="utf-8"))
    return answers


def table(answers: dict[str, dict[str, Any]]) -> tuple[list[str], int]:
    """Lines of the table, and how many answers differ by more than is agreed."""
    first, *others = answers
    width = max(map(len, answers[first]))
    heads = [f"{name:>17}" for name in others]
    lines = [f"{'relative to ' + first:{width}} {' '.join(heads)}"]
    beyond = 0
    for name, answer in answers[first].items():
        cells, notes = [], []
        for other in others:
            sizes, rest, where = difference(answer, answers[other][name])
            differs = sizes > SIZES or rest > OTHERS
            beyond += differs
            cells.append(f"{sizes:8.0e} {rest:7.0e}{'*' if differs else ' '}")
            if differs:
                notes.append(where)
        lines.append(f"{name:{width}} {' '.join(cells)} {', '.join(sorted(set(notes)))}".rstrip())
    lines.append(
        f"{len(answers[first])} answers under {len(answers)} instruction sets, "
        f"{beyond} beyond {SIZES:g} (energies and sizes, first) or {OTHERS:g} (others, second)"
    )
    return lines, beyond


def main() -> int:
    """Print the table; the exit code says whether all answers agree."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("names", nargs="*", help="questions (default: all)")
    parser.add_argument("--short", action="store_true", help="a few questions that take least long")
    parser.add_argument(
        "--sets",
        type=lambda of: of.split(","),
        help="with commas between; all that this machine has",
    )
    parser.add_argument("--folder", type=Path, help="keep answers and compiled kernels here")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--environment", choices=INSTRUCTION_SETS, help="print one's variables")
    parser.add_argument("--answer", type=Path, help=argparse.SUPPRESS)
    given = parser.parse_args()
    names = given.names or [*(SHORT if given.short else cases())]
    if given.environment:
        print(*(f"{k}={v}" for k, v in INSTRUCTION_SETS[given.environment].environment.items()))
        return 0
    if given.answer:
        given.answer.write_text(json.dumps(dict(answered(names))), encoding="utf-8")
        return 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = given.folder or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        sets = given.sets or playable()
        with ThreadPoolExecutor(given.processes) as pool:
            answered_sets = pool.map(lambda name: run_set(name, names, folder), sets)
            answers = dict(zip(sets, answered_sets, strict=True))
    lines, beyond = table(answers)
    print("\n".join(lines))
    return 1 if beyond else 0


if __name__ == "__main__":
    sys.exit(main())
