"""Five designs for every machine, each checked: ``python -m studies.five_designs FOLDER``.

Programs are knitted on the virtual machine and held against the machine's profile. With
``--back-end FILE`` those for a Kniterate are given to the public Kniterate back end as well
(``knitout-to-kcode.js`` of textiles-lab/knitout-backend-kniterate, with ``node``), which must take
them without a word of warning.
"""

import argparse
import re
import subprocess
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from knitcore import InputError, StitchChart, material
from knitcore.formats.designs.layout import layout_of
from knitcore.formats.write.export import ExportKind, ExportOptions, export_chart
from knitcore.garment.piece import MAIN_YARN, Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart
from knitcore.machine.profile import MachineProfile, profiles
from knitcore.machine.program import Finish
from knitcore.machine.program_check import check_program

MATERIAL = "glove-wool"
HOME_FILES = (ExportKind.HAND_PLAN, ExportKind.AYAB, ExportKind.PUNCH_CARD)
_COMPLAINT = re.compile(r"warn|assert|error|throw", re.IGNORECASE)


def designs() -> Mapping[str, Piece]:
    """Stockinette, a 2x2 rib, seed, a piece that is cut out at both edges, and two colours."""
    rib = StitchChart.parse("KKPP").resized(24, 40)
    spans = [(8, 32)] * 4 + [(5, 35), (4, 36), (3, 36), (3, 35), (2, 38), (2, 38)]
    spans += [(2, 38)] * 4 + [(6, 34), (7, 33), (8, 32), (8, 31), (10, 30), (14, 26)]
    stitch = np.array([[a <= column < b for column in range(40)] for a, b in spans])
    row, column = np.mgrid[:24, :40]
    diamond = (abs(row - 12) + abs(column - 20) < 9).astype(np.intp)
    yarns = MAIN_YARN, PieceYarn("blue", "#3b6fb6")
    plain = StitchChart.of_fabric("stockinette", rows=24, columns=40)
    return {
        "stockinette": Piece.of(plain),
        "rib": Piece.of(rib),
        "seed": Piece.of(StitchChart.of_fabric("seed", rows=24, columns=40)),
        "cut-out": Piece.plain(ShapedChart(rib.resized(len(spans), 40), stitch)),
        "two colours": Piece(ShapedChart.rectangle(plain), yarns, diamond),
    }


@dataclass(frozen=True)
class Made:
    """A file of a design for a machine, or the reason why there is none."""

    design: str
    machine: MachineProfile
    kind: str
    name: str
    content: bytes = b""
    refusal: str = ""
    notes: tuple[str, ...] = ()


def all_files() -> Iterator[Made]:
    """Every design for every machine: programs with either end, or plans, pictures and cards."""
    for machine in profiles().values():
        for design, piece in designs().items():
            if machine.reads_programs:
                for finish in Finish:
                    yield _made(design, piece, machine, ExportKind.KNITOUT, finish)
            else:
                for kind in HOME_FILES:
                    yield _made(design, piece, machine, kind, Finish.WASTE)


def _made(
    design: str, piece: Piece, machine: MachineProfile, kind: ExportKind, finish: Finish
) -> Made:
    layout = layout_of(piece).model_copy(update={"machine": machine.identifier})
    options = ExportOptions(name=design, layout=layout, finish=finish)
    part = f"-{finish}" if kind is ExportKind.KNITOUT else f"-{kind}"
    name = f"{machine.identifier}-{design.replace(' ', '-')}{part}"
    try:
        file = export_chart(piece.chart, kind, material(MATERIAL), options)
    except InputError as error:
        return Made(design, machine, kind, name, refusal=str(error))
    return Made(design, machine, kind, name + file.suffix, file.content, notes=file.notes)


def complaints(made: Made, back_end: Path | None, folder: Path) -> list[str]:
    """Complaints of the machine's profile and the public back end about a program."""
    if made.kind != ExportKind.KNITOUT or made.refusal:
        return []
    problems = [str(problem) for problem in check_program(made.content.decode(), made.machine)]
    if back_end is not None and made.machine.identifier == "kniterate":
        file = folder / made.name
        command = ["node", str(back_end), str(file), str(file.with_suffix(".kc"))]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        problems += [f"exit code {run.returncode}"] * (run.returncode != 0)
        lines = (run.stdout + run.stderr).splitlines()
        problems += [line for line in lines if _COMPLAINT.search(line)]
    return problems


def main() -> None:
    """Make all files and say what is wrong with them."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--back-end", type=Path)
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    for made in all_files():
        if not made.refusal:
            (given.folder / made.name).write_bytes(made.content)
        wrong = complaints(made, given.back_end, given.folder)
        outcome = f"refused: {made.refusal}" if made.refusal else "; ".join(wrong) or "right"
        print(f"{made.name:50} {outcome}", flush=True)


if __name__ == "__main__":
    main()
