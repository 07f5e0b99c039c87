"""A piece of cloth cut along any outline and loaded at its edges."""

from __future__ import annotations

from itertools import product
from pathlib import Path
from typing import Annotated, Any, Literal

import click
from pydantic import Field, ValidationError

from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.cloth.cut import CutPiece, PieceTest, cloth_under, solve
from knitcore.cloth.cut.cut_results import SUFFIXES
from knitcore.cloth.cut.cut_uncertainty import piece_spreads
from knitcore.materials import Material
from knitcore.materials.law_uncertainty import Z_SCORE

from ...cli.options import out_option
from ...context import Context
from ...requests.base import EndsOfList, Floats, ResultModel, first_fault
from ...requests.charts import to_repeat
from ...requests.faults import CheckedBy
from ...requests.pieces import PieceInput, PieceTestRequest, PieceTestResult, of_test
from ..registry import Command, Operation


class PieceRequest(PieceTestRequest):
    """Cloth, the piece cut from it, and the conditions on its edges."""

    piece: Annotated[PieceInput, CheckedBy(lambda cut, _: cut.piece())]
    fields: bool = Field(False, description="Return the final shape and strains too.")

    def cut(self) -> CutPiece:
        """The piece that is tested."""
        return self.piece.piece()


class LoadedEdge(ResultModel):
    """Force and motion of an edge at each step."""

    edge: str
    kind: str
    force_x_n: Floats = Field(description="Force on the whole edge; 0 for a tape.")
    force_y_n: Floats
    moved_x_mm: Floats = Field(description="Mean displacement of the edge.")
    moved_y_mm: Floats
    force_x_interval_n: EndsOfList
    force_y_interval_n: EndsOfList
    moved_x_interval_mm: EndsOfList
    moved_y_interval_mm: EndsOfList


class DeformedPiece(ResultModel):
    """The mesh after the last step."""

    corners_mm: list[tuple[float, float]] = Field(description="Corners of the mesh at rest.")
    moved_mm: list[tuple[float, float]] = Field(description="Displacement of each corner.")
    elements: list[list[int]] = Field(description="Corner numbers of each element, from 0.")
    strain_course: Floats = Field(description="Strain of each element, like the fields below.")
    strain_wale: Floats
    shear_angle: Floats = Field(description="Shear angle in radians.")
    stress_course: Floats = Field(description="Stress, N/mm.")
    stress_wale: Floats
    stress_shear: Floats
    utilisation: Floats = Field(
        description="Nearness to the lock-up: alpha * strain; 1 is the lock-up."
    )


class PieceResult(PieceTestResult):
    """Equilibria of a piece under a growing load."""

    kind: Literal["piece"] = "piece"
    share: Floats = Field(description="Share of the load at each step.")
    area_mm2: float
    edges: list[LoadedEdge] = Field(description="Loaded edges, in the order of the conditions.")
    shape: DeformedPiece | None


def piece(request: PieceRequest, context: Context) -> PieceResult:
    """Forces, motions and strains of a piece of any outline whose edges are held, moved, pulled,
    loaded or sewn to a tape.
    """
    material = context.material(request.material)
    return _result(request, _test(request, material, context), material)


def _test(request: PieceRequest, material: Material, context: Context) -> PieceTest:
    request.check_parts(context)
    cut = request.cut()
    cloth = request.pass_to(
        cloth_under, cut, to_repeat(request.chart), material, size=request.relaxed_size
    )
    control = {"progress": context.progress, "cancelled": context.cancelled}
    return request.pass_to(solve, cut, cloth, request.piece.loads(), **control)


def _result(request: PieceRequest, test: PieceTest, material: Material) -> PieceResult:
    values = {"force": ("n", test.force_n), "moved": ("mm", test.moved_mm)}
    margins = dict(zip(values, Z_SCORE * piece_spreads(test, material), strict=True))
    edges = []
    for i, given in enumerate(request.piece.conditions):
        edge: dict[str, Any] = {"edge": given.edge, "kind": given.kind}
        for (name, (unit, by_edge)), (axis, letter) in product(values.items(), enumerate("xy")):
            value, margin = by_edge[:, i, axis], margins[name][:, i, axis]
            edge[f"{name}_{letter}_{unit}"] = value
            edge[f"{name}_{letter}_interval_{unit}"] = value - margin, value + margin
        edges.append(edge)
    return PieceResult(
        share=test.share,
        area_mm2=test.piece.area_mm2,
        edges=edges,
        shape=_shape(test) if request.fields and test.equilibria else None,
        **of_test(test, material),
    )


def _shape(test: PieceTest) -> DeformedPiece:
    corners = test.mesh.p
    return DeformedPiece.of(
        test.fields(),
        corners_mm=corners.T.tolist(),
        moved_mm=(test.corners_mm[-1] - corners).T.tolist(),
        elements=test.mesh.t.T.tolist(),
    )


@click.option(
    "--piece",
    type=click.Path(path_type=Path),
    required=True,
    help="FILE.json with outline, holes, grain_deg, edges and conditions.",
)
@in_reading_time
def _piece_file(piece: Path) -> dict[str, Any]:
    try:
        return {"piece": PieceInput.model_validate_json(piece.read_bytes())}
    except OSError as error:
        raise InputError(
            "piece", f"{piece}: {error.strerror}.", "Name a JSON file that can be read."
        ) from None
    except ValidationError as error:
        problem = f"{piece.name}: {first_fault(error)}."
        raise InputError(
            "piece", problem, "Correct the file as docs/piece.md describes it."
        ) from None


@out_option("--out", help="Write FILE.npz, .csv or .vtu.", suffixes=SUFFIXES)
def _command(request: PieceRequest, context: Context, out: Path | None) -> PieceResult:
    material = context.material(request.material)
    test = _test(request, material, context)
    if out is not None:
        test.write(out)
    return _result(request, test, material)


def _lines(r: PieceResult) -> list[str]:
    lines = [f"{len(r.share)} steps, {r.nodes} nodes"]
    for e in r.edges if r.share else []:
        lines += [
            f"{e.edge} ({e.kind})",
            f"  x {_last(e.force_x_n, e.force_x_interval_n)} N"
            f" {_last(e.moved_x_mm, e.moved_x_interval_mm)} mm",
            f"  y {_last(e.force_y_n, e.force_y_interval_n)} N"
            f" {_last(e.moved_y_mm, e.moved_y_interval_mm)} mm",
        ]
    return lines


def _last(values: list[float], ends: tuple[list[float], list[float]]) -> str:
    """The last value and half the width of its interval."""
    low, high = ends
    return f"{values[-1]:9.3f} ± {(high[-1] - low[-1]) / 2:.3f}"


OPERATION = Operation(
    piece,
    tag="pieces",
    summary="Load a piece of any outline at its edges",
    example={
        "chart": "K",
        "material": "acrylic",
        "steps": 2,
        "mesh_mm": 10,
        "piece": {
            "outline": [[0, 0], [50, 0], [50, 80], [25, 100], [0, 80]],
            "holes": [[[20, 30], [30, 30], [25, 45]]],
            "grain_deg": 45,
            "edges": {"hem": [1], "top": [3, 4], "hole": [6, 7, 8]},
            "conditions": [
                {"kind": "held", "edge": "hem"},
                {"kind": "pulled", "edge": "top", "y_n": 1.0},
                {"kind": "sewn", "edge": "hole", "stiffness_n": 10.0},
            ],
        },
    },
    job=True,
    command=Command(
        _lines,
        more="Loads act at its edges.",
        names={"piece": None},
        fields=_piece_file,
        run=_command,
    ),
)
