"""Displacement fields in requests and results."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from knitcore.chart.fabric import Direction
from knitcore.fit.measured_field import MeasuredField, load_field

from .base import RequestModel, ResultModel
from .faults import CheckedBy
from .uploads import UploadedFile, stored


class FieldRequest(RequestModel):
    """A displacement field and how the fabric in it was pulled."""

    field: Annotated[UploadedFile, CheckedBy(lambda file, _: load(file))] = Field(
        description=".npz: displacement (frames, 2, rows, columns), frame."
    )
    direction: Direction = Field(description="Direction in which the fabric was pulled.")
    frames: list[int] | None = Field(None, description="Frames to use; all by default.")

    def chosen(self, field: MeasuredField) -> MeasuredField:
        """The frames that the request selects."""
        return field.only(set(self.frames)) if self.frames else field


class FrameErrorResult(ResultModel):
    """Simulated minus measured displacement at one frame, in per cent of the width."""

    frame: int
    applied_stretch: float
    ux_rms_percent_width: float
    ux_max_percent_width: float
    uy_rms_percent_width: float
    uy_max_percent_width: float


def load(file: UploadedFile) -> MeasuredField:
    """A field in a file."""
    with stored([file]) as (path,):
        return load_field(path)


def errors_table(frames: list[FrameErrorResult]) -> list[str]:
    """Lines of a table, in per cent of the width."""
    head = f"{'frame':>6} {'stretch':>8} {'ux rms':>7} {'ux max':>7} {'uy rms':>7} {'uy max':>7}"
    return [
        head + "   (% of width)",
        *(
            f"{f.frame:6d} {f.applied_stretch:8.3f} {f.ux_rms_percent_width:7.2f} "
            f"{f.ux_max_percent_width:7.2f} {f.uy_rms_percent_width:7.2f} "
            f"{f.uy_max_percent_width:7.2f}"
            for f in frames
        ),
    ]
