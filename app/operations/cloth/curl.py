"""Curling and folding of a piece under no load."""

from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import Field

from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import size_in_words
from knitcore.cloth.space.curl import MAX_STITCHES, TIME_LIMIT_S, CurledPiece, Pull
from knitcore.cloth.space.curl import curl as curl_piece
from knitcore.formats.write.yarn_mesh import write_curled_glb
from knitcore.garment.shaped import outline_marks

from ...cli.options import out_option
from ...context import Context
from ...drawing.computed import PosedView
from ...requests.base import Known, RequestModel, ResultModel
from ...requests.charts import OutlineInput
from ...requests.fabrics import GaugedRequest
from ...requests.weighed import Corners, TimeLimit, corner_lists
from ..perform import Viewed
from ..registry import Command, Operation

FLAT = 0.02
"""Edges that stand out by less than this fraction of the thickness count as flat."""


class PullInput(RequestModel):
    """Two clamps that hold the outermost rows or columns and move apart."""

    direction: Direction = Field(Direction.WALE, description="Direction of the pull.")
    strain: float = Field(gt=0, le=1, description="Strain from clamp to clamp: 0.3 is 30 %.")


class CurlRequest(GaugedRequest):
    """A whole piece whose edges are free, all or beside two clamps."""

    outline: OutlineInput = None
    pull: PullInput | None = Field(
        None, description="Pull by clamps; the free sides between them curl."
    )
    after: str | None = Field(
        None,
        max_length=128,
        description="Id of a shape of as many stitches, such as that before a stitch was changed: "
        "the calculation begins there, and its first shapes come sooner. Has no effect if the "
        "service has forgotten it, or with another size.",
    )
    corners: bool = Field(False, description="Also return the corners of all stitches.")
    time_limit_s: TimeLimit = TIME_LIMIT_S


class CurlResult(ResultModel):
    """The piece as it lies; heights are positive towards the face (the front)."""

    kind: Literal["curl"] = "curl"
    id: str = Field(description="Name of the shape, for 3D views.")
    rows: int
    columns: int
    width_mm: float = Field(description="Extent along the rows of the piece as a whole.")
    height_mm: float
    depth_mm: float
    curl_course_mm: Known = Field(
        description="Height of the sides above the fabric next to them; negative to the back. Null "
        "for a shaped piece."
    )
    curl_wale_mm: Known = Field(
        description="Height of the top and bottom above the fabric next to them."
    )
    flat_width_mm: float = Field(description="Extent of the piece laid flat.")
    flat_height_mm: float
    thickness_mm: float
    converged: bool = Field(
        description="True if the shape is at rest; otherwise it is only a preview."
    )
    seconds: float = Field(description="CPU time.")
    corners_mm: Corners = None
    notes: list[str]


def curl(request: CurlRequest, context: Context) -> Viewed[CurlResult]:
    """Shape of least energy of a piece with free edges, without friction, set and weight.

    Stockinette rolls its sides to the back and its ends to the front, garter, 1x1 rib and seed lie
    flat, wide ribs pleat. Directions agree with real fabric; sizes of tight rolls and folds are
    those of frictionless cloth. Pieces may have up to 10,000 stitches.
    """
    piece = _curled(request, context)
    return Viewed(_result(piece, request), PosedView(piece.corners_mm.astype(np.float32)))


def _curled(request: CurlRequest, context: Context) -> CurledPiece:
    chart, material = request.fabric(context)
    stitches = None if request.outline is None else outline_marks(request.outline)
    before = context.before
    shape = (chart.rows + 1, chart.columns + 1, 3)
    begin = before.corners_mm if isinstance(before, PosedView) else None
    return request.pass_to(
        curl_piece,
        chart,
        material,
        stitches=stitches,
        size=request.relaxed_size,
        begin=begin if begin is not None and begin.shape == shape else None,
        pull=None if request.pull is None else request.pull.pass_to(Pull),
        cancelled=context.cancelled,
    )


def _result(piece: CurledPiece, request: CurlRequest) -> CurlResult:
    flat = piece.flat_mm[-1, -1] - piece.flat_mm[0, 0]
    return CurlResult.of(
        piece,
        id=OPERATION.key(request),
        rows=piece.chart.rows,
        columns=piece.chart.columns,
        flat_width_mm=float(flat[0]),
        flat_height_mm=float(flat[1]),
        corners_mm=corner_lists(piece.corners_mm, piece.used) if request.corners else None,
    )


@out_option("--out", help="Write the shape to FILE.npz or FILE.glb.", suffixes=(".npz", ".glb"))
def _and_write(request: CurlRequest, context: Context, out: Path | None) -> CurlResult:
    piece = _curled(request, context)
    if out is not None and out.suffix.lower() == ".glb":
        material = context.material(request.material)
        drawn = write_curled_glb(piece.chart, piece.corners_mm, material, piece.stitches)
        out.write_bytes(drawn)
    elif out is not None:
        piece.write(out)
    return _result(piece, request)


def _lines(r: CurlResult) -> list[str]:
    state = "" if r.converged else "  NOT converged: a preview"
    return [
        f"{size_in_words(r.columns, r.rows)}, flat {r.flat_width_mm:.0f} x "
        f"{r.flat_height_mm:.0f} mm",
        f"as it lies      {r.width_mm:.0f} x {r.height_mm:.0f} x {r.depth_mm:.0f} mm{state}",
        *(
            f"{edges:15} {_where(curl_mm, r.thickness_mm)}"
            for edges, curl_mm in (("sides", r.curl_course_mm), ("top and bottom", r.curl_wale_mm))
            if curl_mm is not None
        ),
        f"solved          {r.seconds:.1f} s CPU",
    ]


def _where(curl_mm: float, thickness_mm: float) -> str:
    if abs(curl_mm) < FLAT * thickness_mm:
        return "flat"
    return f"{abs(curl_mm):.1f} mm to the {'front' if curl_mm > 0 else 'back'}"


OPERATION = Operation(
    curl,
    tag="mechanics",
    summary="Curling and folding of a piece",
    most_stitches=MAX_STITCHES,
    example={"chart": {"fabric": "stockinette", "columns": 6, "rows": 4}, "material": "acrylic"},
    job=True,
    command=Command(
        _lines,
        more=f"It has up to {MAX_STITCHES:,} stitches.",
        names={"after": None, "corners": None},
        run=_and_write,
    ),
)
