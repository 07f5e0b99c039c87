"""Relaxed stitches that come with the package, and the command that makes them.

``python -m knitcore.yarnlevel.store build`` relaxes and stretches the repeats anew and writes
``data/stitches.json`` (sizes, energies, laws) and ``data/stitches.npz`` (control points).
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import asdict, dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from knitcore.chart import StitchChart
from knitcore.errors import KnitcoreError
from knitcore.fabric import Direction
from knitcore.materials import material
from knitcore.mechanics.constitutive import ConstitutiveLaw
from knitcore.yarnlevel.catalogue import COMMON, canonical, distinct_repeats, place
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.kernels import sample_curve
from knitcore.yarnlevel.lawfit import MAX_STRESS_N_PER_MM, fit_law
from knitcore.yarnlevel.relax import Branch, RelaxedRepeat, relax
from knitcore.yarnlevel.spline import SplineGrid
from knitcore.yarnlevel.sweep import sweep
from knitcore.yarnlevel.tiling import tiled_controls
from knitcore.yarnlevel.yarn import YarnModel
from knitcore.yarnlevel.yarns import ChartYarn, yarn_for

Array = NDArray[np.float64]

MATERIALS = ("acrylic", "cotton")
_DATA = "knitcore.yarnlevel"


@dataclass(frozen=True, eq=False)
class StoredStitch:
    """A relaxed repeat from the store.

    Parameters
    ----------
    chart : the repeat that was asked for.
    material : ``acrylic`` or ``cotton``.
    yarn, loop_length_mm, yarn_provenance : what it was relaxed with.
    branch, convention : of the relaxation.
    cell_course_mm, cell_wale_mm : size of one stitch, mm.
    energy_n_mm, bending_share, contact_share : per stitch.
    converged : whether the solver reached its tolerance.
    law : fitted to stretches in both directions up to ``law_max_stress_n_per_mm``; None where none
        could be fitted.
    controls : (rows, columns * N, 3) control points over the repeat without the drift, mm.
    free_course_mm, free_wale_mm : the size in the ``free`` branch, for repeats of a known name.
    """

    chart: StitchChart
    material: str
    yarn: YarnModel
    loop_length_mm: float
    yarn_provenance: str
    branch: Branch
    convention: Convention
    cell_course_mm: float
    cell_wale_mm: float
    energy_n_mm: float
    bending_share: float
    contact_share: float
    converged: bool
    law: ConstitutiveLaw | None
    law_max_stress_n_per_mm: float
    controls: Array
    free_course_mm: float | None = None
    free_wale_mm: float | None = None

    def centre_lines(self, per_span: int = 2) -> Array:
        """(rows, points, 3): centre lines across the repeat, mm, bottom course first."""
        per_stitch = self.controls.shape[1] // self.chart.columns
        grid = SplineGrid(per_stitch, per_span)
        curve = sample_curve(self.controls, self.cell_course_mm, 1, grid.basis)
        lines = np.array(curve[:, :, 0])
        lines[..., 0] += self.cell_course_mm * (np.arange(lines.shape[1]) + 0.5) / grid.samples
        lines[..., 1] += self.cell_wale_mm * np.arange(len(lines))[:, None]
        return lines


def stored_stitch(chart: StitchChart, material_id: str) -> StoredStitch | None:
    """The packaged relaxation of a chart's repeat, turned and moved to fit; None if there is none.

    Examples
    --------
    >>> stored = stored_stitch(StitchChart.parse("PK"), "acrylic")
    >>> stored.chart.text
    'PK'
    """
    repeat = chart.repeat()
    representative = canonical(repeat)
    entry = _entries().get(f"{material_id}/{_key(representative)}")
    if entry is None:
        return None
    placement = place(repeat, representative)
    if placement is None:
        return None
    points = np.asarray(_controls()[f"{material_id}/{_key(representative)}"], dtype=float)
    per_stitch = points.shape[1] // repeat.columns
    if placement.mirror:
        # t -> columns - t turns control c into control -c, and stitch i into columns - 1 - i
        points = np.roll(points[:, ::-1], 1, axis=1) * (-1.0, 1.0, 1.0)
    if placement.swap:
        points = points * (1.0, 1.0, -1.0)
    points = np.roll(points, (placement.up, placement.right * per_stitch), axis=(0, 1))
    law = entry["law"]
    return StoredStitch(
        chart=repeat,
        material=material_id,
        yarn=YarnModel(**entry["yarn"]),
        loop_length_mm=entry["loop_length_mm"],
        yarn_provenance=entry["yarn_provenance"],
        branch=Branch(entry["branch"]),
        convention=Convention(entry["convention"]),
        cell_course_mm=entry["cell_course_mm"],
        cell_wale_mm=entry["cell_wale_mm"],
        energy_n_mm=entry["energy_n_mm"],
        bending_share=entry["bending_share"],
        contact_share=entry["contact_share"],
        converged=entry["converged"],
        law=None if law is None else ConstitutiveLaw(**law),
        law_max_stress_n_per_mm=entry["law_max_stress_n_per_mm"],
        controls=points,
        free_course_mm=entry.get("free_course_mm"),
        free_wale_mm=entry.get("free_wale_mm"),
    )


def stored_charts(material_id: str) -> list[StitchChart]:
    """The repeats in the store, one of each fabric."""
    prefix = f"{material_id}/"
    return [
        StitchChart.parse(key.removeprefix(prefix).replace("/", "\n"))
        for key in _entries()
        if key.startswith(prefix)
    ]


@cache
def _entries() -> dict[str, Any]:
    path = files(_DATA) / "data" / "stitches.json"
    if not path.is_file():
        return {}
    entries: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))["stitches"]
    return entries


@cache
def _controls() -> dict[str, NDArray[np.float32]]:
    with (files(_DATA) / "data" / "stitches.npz").open("rb") as stream, np.load(stream) as found:
        return {name: found[name] for name in found.files}


def _key(chart: StitchChart) -> str:
    return chart.text.replace("\n", "/")


# -- making it ----------------------------------------------------------------------------------


def build(folder: Path, most_stitches: int) -> None:
    """Relax and stretch the common repeats, and all of at most so many stitches, for each yarn."""
    entries: dict[str, Any] = {}
    controls: dict[str, NDArray[np.float32]] = {}
    common = {canonical(StitchChart.parse(text)): name for name, text in COMMON.items()}
    charts = dict.fromkeys([*common, *distinct_repeats(most_stitches)])
    for number, chart in enumerate(charts, start=1):
        for material_id in MATERIALS:
            used = yarn_for(material(material_id), chart)
            key = f"{material_id}/{_key(chart)}"
            try:
                relaxed = relax(chart, used.yarn, used.loop_length_mm)
            except KnitcoreError as error:
                _tell(f"{key}: {error}")
                continue
            entry = _entry(relaxed, used)
            if chart in common:
                entry["name"] = common[chart]
                free = relax(chart, used.yarn, used.loop_length_mm, branch=Branch.FREE)
                entry["free_course_mm"] = round(free.cell_course_mm, 5)
                entry["free_wale_mm"] = round(free.cell_wale_mm, 5)
            entries[key] = entry
            points = tiled_controls(relaxed.cell, relaxed.state, chart.rows, chart.columns)
            controls[key] = points.astype(np.float32)
            size = f"{entry['cell_course_mm']:.3f} x {entry['cell_wale_mm']:.3f} mm"
            _tell(f"{number}/{len(charts)} {key}: {size}, law {entry['law'] is not None}")
        _write(folder, entries, controls)


def _write(folder: Path, entries: dict[str, Any], controls: dict[str, NDArray[np.float32]]) -> None:
    lines = ",\n".join(f"{json.dumps(k)}: {json.dumps(v)}" for k, v in entries.items())
    text = f'{{"stitches": {{\n{lines}\n}}}}\n'
    (folder / "stitches.json").write_text(text, encoding="utf-8")
    np.savez_compressed(folder / "stitches.npz", **controls)  # type: ignore[arg-type]


def _entry(relaxed: RelaxedRepeat, used: ChartYarn) -> dict[str, Any]:
    return {
        "yarn": asdict(used.yarn),
        "loop_length_mm": used.loop_length_mm,
        "yarn_provenance": used.provenance,
        "branch": relaxed.branch,
        "convention": relaxed.convention.value,
        "cell_course_mm": round(relaxed.cell_course_mm, 5),
        "cell_wale_mm": round(relaxed.cell_wale_mm, 5),
        "energy_n_mm": round(relaxed.energy_n_mm, 6),
        "bending_share": round(relaxed.bending_share, 5),
        "contact_share": round(relaxed.contact_share, 5),
        "converged": relaxed.converged,
        "law": _law(relaxed),
        "law_max_stress_n_per_mm": MAX_STRESS_N_PER_MM,
    }


def _law(relaxed: RelaxedRepeat) -> dict[str, float] | None:
    try:
        course, wale = (
            sweep(
                relaxed, direction, far, points=36, back=False,
                max_stress_n_per_mm=1.1 * MAX_STRESS_N_PER_MM,
            )
            for direction, far in ((Direction.COURSE, 3.0), (Direction.WALE, 2.0))
        )  # fmt: skip
        law = fit_law(course, wale).law
    except KnitcoreError as error:
        _tell(f"  no law: {error}")
        return None
    return {name: round(value, 6) for name, value in asdict(law).items()}


def _tell(line: str) -> None:
    sys.stderr.write(line + "\n")
    sys.stderr.flush()


def main() -> None:
    """Entry of ``python -m knitcore.yarnlevel.store``."""
    parser = argparse.ArgumentParser(prog="python -m knitcore.yarnlevel.store")
    commands = parser.add_subparsers(required=True)
    command = commands.add_parser("build", help="relax the repeats anew and write the store")
    command.add_argument("--most-stitches", type=int, default=8)
    command.add_argument("--folder", type=Path, default=Path(__file__).parent / "data")
    chosen = parser.parse_args()
    build(chosen.folder, chosen.most_stitches)


if __name__ == "__main__":
    main()
