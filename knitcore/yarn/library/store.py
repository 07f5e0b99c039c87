"""Relaxed stitches that come with the package.

``data/stitches.json`` holds sizes, energies and laws, ``data/stitches.npz`` control points;
``scripts/stored_stitches.py`` makes both. ``data/lowest.json`` records which of them are minima
without their mirrors, ``data/bending.json`` how they bend; ``scripts/from_store.py`` makes these. A
response to bending is four numbers there: moment (N), rigidity with the size across free and held
(N·mm), and strain across per curvature (mm).
"""

import json
from dataclasses import astuple, dataclass, fields
from functools import cache
from importlib.resources import files
from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Fabric
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.yarn.kernels.curve_samples import sample_curve
from knitcore.yarn.library.yarns import ChartYarn
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.images import placement
from knitcore.yarn.study.bending import FabricBending, RepeatBending
from knitcore.yarn.study.bent_cell import BendingResponse
from knitcore.yarn.study.relax import Branch

MATERIALS = ("acrylic", "cotton")
DIGITS = 6
"""Significant digits of the numbers of bending in the file."""
_NOTHING = 1e-9
"""Below this, in N or mm, a moment or a strain per curvature is rounding."""


@dataclass(frozen=True)
class FreeStitch:
    """A repeat in the ``free`` branch: size (mm) and energy (N·mm) of a stitch, law."""

    cell_course_mm: float
    cell_wale_mm: float
    energy_n_mm: float
    converged: bool
    law: ConstitutiveLaw | None


@dataclass(frozen=True)
class Unmirrored:
    """The fate of a mirrored repeat whose symmetries are dropped.

    Attributes
    ----------
    minimum : whether it stays, being a minimum without them too.
    cell_course_mm, cell_wale_mm, energy_n_mm : size and energy of a stitch of the minimum that it
        is or that its instability leads to.
    converged : whether the solver reached its tolerance there.
    """

    minimum: bool
    cell_course_mm: float
    cell_wale_mm: float
    energy_n_mm: float
    converged: bool


@dataclass(frozen=True, eq=False, repr=False)
class StoredStitch(Result):
    """A relaxed repeat from the store.

    Parameters
    ----------
    chart : the repeat that was asked for.
    material : ``acrylic`` or ``cotton``.
    yarn, loop_length_mm, yarn_provenance : of the relaxation.
    branch, convention : of the relaxation.
    cell_course_mm, cell_wale_mm : size of one stitch, mm.
    energy_n_mm, bending_share, contact_share : per stitch.
    converged : whether the solver reached its tolerance.
    law : fitted to stretches in both directions up to ``law_max_stress_n_per_mm``; None where none
        could be fitted, for the reason in ``law_failure``.
    law_jumps : abrupt changes of shape within the fitted range, course-wise and wale-wise.
    controls : (rows, columns * N, 3) control points over the repeat without the drift, mm.
    free : the repeat without imposed symmetry, for repeats of a known name.
    unmirrored : what becomes of it without its symmetries; None where that was not found out.
    bending : its curling moments, bending rigidities and shear modulus; None where they were not
        computed.
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
    law_failure: str
    law_jumps: tuple[int, int]
    controls: Array
    free: FreeStitch | None = None
    unmirrored: Unmirrored | None = None
    bending: RepeatBending | None = None

    def centre_lines(self, per_span: int = 2) -> Array:
        """(rows, points, 3): centre lines across the repeat, mm, bottom course first."""
        per_stitch = self.controls.shape[1] // self.chart.columns
        grid = SplineGrid(per_stitch, per_span)
        curve = sample_curve(self.controls, self.cell_course_mm, 1, grid.basis)
        lines = np.array(curve[:, :, 0])
        lines[..., 0] += self.cell_course_mm * (np.arange(lines.shape[1]) + 0.5) / grid.samples
        lines[..., 1] += self.cell_wale_mm * np.arange(len(lines))[:, None]
        return lines


_AS_THEY_ARE = (
    *("loop_length_mm", "yarn_provenance", "cell_course_mm", "cell_wale_mm", "energy_n_mm"),
    *("bending_share", "contact_share", "converged", "law_max_stress_n_per_mm", "law_failure"),
)
"""Fields of a stored stitch that the file has in the same form."""


def stored_stitch(chart: StitchChart, material_id: str) -> StoredStitch | None:
    """The packaged relaxation of a chart's repeat, mirrored and shifted to fit; None if there is
    none.

    Examples
    --------
    >>> stored = stored_stitch(StitchChart.parse("PK"), "acrylic")
    >>> stored.chart.text
    'PK'
    """
    repeat = chart.repeat()
    representative = repeat.canonical()
    key = f"{material_id}/{representative.key}"
    entry = _entries().get(key)
    if entry is None or "failure" in entry:
        return None
    placed = placement(repeat, representative)
    if placed is None:
        return None
    points = np.asarray(_controls()[key], dtype=float)
    bent = _table("bending.json").get(key)
    bending = None if bent is None else of_document(bent)
    if placed.mirror:
        bending = bending and bending.mirror_image()
    if placed.swap:
        bending = bending and bending.swapped()
    free = entry.get("free", {"failure": "not relaxed freely"})
    unmirrored = _table("lowest.json").get(key, {"failure": "not tried"})
    return StoredStitch(
        chart=repeat,
        material=material_id,
        yarn=YarnModel(**entry["yarn"]),
        branch=Branch(entry["branch"]),
        convention=Convention(entry["convention"]),
        law=_law(entry),
        **{name: entry[name] for name in _AS_THEY_ARE},
        law_jumps=(entry["law_jumps"][0], entry["law_jumps"][1]),
        controls=placed.points(points, repeat.columns),
        free=None if "failure" in free else FreeStitch(**{**free, "law": _law(free)}),
        unmirrored=None if "failure" in unmirrored else Unmirrored(**unmirrored),
        bending=bending,
    )


def stored_for(chart: StitchChart, used: ChartYarn) -> StoredStitch | None:
    """The packaged relaxation of a chart's repeat in this yarn, at this loop length; None if there
    is none."""
    parameters = (*astuple(used.yarn), used.loop_length_mm)
    for material_id in MATERIALS:
        stored = stored_stitch(chart, material_id)
        if stored is not None and np.allclose(
            (*astuple(stored.yarn), stored.loop_length_mm), parameters, rtol=1e-9, atol=0.0
        ):
            return stored
    return None


def stored_fabric(fabric: Fabric, material_id: str) -> StoredStitch:
    """The packaged relaxation of a pure fabric; the store has all four of each material."""
    stored = stored_stitch(StitchChart.of_fabric(fabric), material_id)
    assert stored is not None  # noqa: S101 - packaged, and tested
    return stored


def stored_charts(material_id: str) -> list[StitchChart]:
    """The relaxed repeats in the store, one of each fabric."""
    prefix = f"{material_id}/"
    return [
        StitchChart.parse(key.removeprefix(prefix))
        for key, entry in _entries().items()
        if key.startswith(prefix) and "failure" not in entry
    ]


def document_of(bending: RepeatBending) -> dict[str, Any]:
    """Bending of a repeat as the entry of the file."""
    parts = {
        "mirrored": _state(bending.mirrored),
        "unmirrored": _state(bending.unmirrored),
        "failure": bending.failure,
        "unmirrored_failure": bending.unmirrored_failure,
    }
    return {name: part for name, part in parts.items() if part}


def of_document(entry: dict[str, Any]) -> RepeatBending:
    """Bending of a repeat from an entry of the file."""
    return RepeatBending(
        mirrored=_read(entry.get("mirrored")),
        unmirrored=_read(entry.get("unmirrored")),
        failure=entry.get("failure", ""),
        unmirrored_failure=entry.get("unmirrored_failure", ""),
    )


def _state(bending: FabricBending | None) -> dict[str, Any] | None:
    if bending is None:
        return None
    return {field.name: _written(getattr(bending, field.name)) for field in fields(bending)}


def _written(value: Any) -> Any:
    """A value as the file has it: numbers short, a response as its four numbers."""
    if isinstance(value, BendingResponse):
        value = astuple(value)
    if isinstance(value, tuple):
        return [_written(part) for part in value]
    return _short(value) if isinstance(value, float) else value


def _read(state: dict[str, Any] | None) -> FabricBending | None:
    if state is None:
        return None
    course, wale, *oblique = (
        BendingResponse(*numbers)
        for numbers in (state["course"], state["wale"], *(state["oblique"] or ()))
    )
    known = {
        "course": course,
        "wale": wale,
        "oblique": (oblique[0], oblique[1]) if oblique else None,
    }
    return FabricBending(**(state | known))


def _short(value: float) -> float:
    return 0.0 if abs(value) < _NOTHING else float(f"{value:.{DIGITS}g}")


def _law(entry: dict[str, Any]) -> ConstitutiveLaw | None:
    return None if entry["law"] is None else ConstitutiveLaw(**entry["law"])


def _entries() -> dict[str, Any]:
    entries: dict[str, Any] = _table("stitches.json")["stitches"]
    return entries


@cache
def _table(name: str) -> dict[str, Any]:
    table: dict[str, Any] = json.loads(_data(name))
    return table


@cache
def _controls() -> dict[str, NDArray[np.float32]]:
    with np.load(BytesIO(_data("stitches.npz"))) as archive:
        return {name: archive[name] for name in archive.files}


def _data(name: str) -> bytes:
    return (files("knitcore.yarn.library") / "data" / name).read_bytes()
