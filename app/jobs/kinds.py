"""What can run in the background: the operations that take longer than a page should wait."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Generic, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Field

from app.http.packed import packed
from app.operations.atlas import AtlasRequest, AtlasResult, run_atlas
from app.operations.characterise import (
    CharacteriseRequest,
    CharacteriseResult,
    run_characterise,
)
from app.operations.context import Context
from app.operations.curve import CurveRequest, CurveResult, curve
from app.operations.field import (
    CalibrateRequest,
    CalibrateResult,
    CompareRequest,
    CompareResult,
    run_calibrate,
    run_compare,
)
from app.operations.fill import FillRequest, FillResult, run_fill
from app.operations.find import FindRequest, FindResult, run_find
from app.operations.fit import FitRequest, FitResult, run_fit
from app.operations.measure import (
    BendingRequest,
    BendingResult,
    CompressionRequest,
    CompressionResult,
    run_bending,
    run_compression,
)
from app.operations.relax import RelaxRequest, RelaxResult, run_relax
from app.operations.shape import ShapeRequest, ShapeResult, run_shape
from app.operations.stretch import StretchRequest, StretchResult, StretchRun, run_stretch
from app.operations.sweep import SweepRequest, SweepResult, run_sweep
from app.settings import Settings

DECIDING = frozenset({".py", ".csv", ".json", ".npz"})
"""Endings of program and data files."""

Kind = TypeVar("Kind", bound=str)
Request = TypeVar("Request", bound=BaseModel)


class JobOf(BaseModel, Generic[Kind, Request]):
    """An operation and what it is asked."""

    model_config = ConfigDict(extra="forbid")
    kind: Kind
    request: Request


class StretchJob(JobOf[Literal["stretch"], StretchRequest]):
    """A stretch test."""


class CurveJob(JobOf[Literal["curve"], CurveRequest]):
    """The stress-strain curve of a chart."""


class RelaxJob(JobOf[Literal["relax"], RelaxRequest]):
    """A relaxation at the yarn level."""


class SweepJob(JobOf[Literal["sweep"], SweepRequest]):
    """A stretch sweep at the yarn level."""


class CharacteriseJob(JobOf[Literal["characterise"], CharacteriseRequest]):
    """The pure fabrics of a yarn at many stitch settings."""


class AtlasJob(JobOf[Literal["atlas"], AtlasRequest]):
    """The constants of all small repeats of a material."""


class FindJob(JobOf[Literal["find"], FindRequest]):
    """Fabrics that do what is wanted."""


class FillJob(JobOf[Literal["fill"], FillRequest]):
    """A chart for a map of wanted stiffness."""


class ShapeJob(JobOf[Literal["shape"], ShapeRequest]):
    """A chart that takes a wanted outline when it is stretched."""


class FitJob(JobOf[Literal["fit"], FitRequest]):
    """A law from two stretch tests."""


class BendingJob(JobOf[Literal["bending"], BendingRequest]):
    """A bending modulus from photos."""


class CompressionJob(JobOf[Literal["compression"], CompressionRequest]):
    """Contact constants from compression tests."""


class CompareJob(JobOf[Literal["compare"], CompareRequest]):
    """A law beside a measured displacement field."""


class CalibrateJob(JobOf[Literal["calibrate"], CalibrateRequest]):
    """A law calibrated on a measured displacement field."""


JobRequest = Annotated[
    StretchJob
    | CurveJob
    | RelaxJob
    | SweepJob
    | CharacteriseJob
    | AtlasJob
    | FindJob
    | FillJob
    | ShapeJob
    | FitJob
    | BendingJob
    | CompressionJob
    | CompareJob
    | CalibrateJob,
    Field(discriminator="kind"),
]


def _packed_already(run: StretchRun) -> bytes:
    return run.result


@dataclass(frozen=True)
class JobKind:
    """An operation as a job.

    Attributes
    ----------
    request, result : what it takes and gives.
    function : does the work in a worker.
    told : packed JSON for the caller, of what the function returns.
    """

    request: type[BaseModel]
    result: type[BaseModel]
    function: Callable[..., Any]
    told: Callable[[Any], bytes] = packed


def run_curve(request: CurveRequest, *, cancelled: Callable[[], bool]) -> CurveResult:
    """The curve, until all kinds are made of operations."""
    return curve(request, Context(Settings().data_dir, cancelled=cancelled))


KINDS: dict[str, JobKind] = {
    "stretch": JobKind(StretchRequest, StretchResult, run_stretch, _packed_already),
    "curve": JobKind(CurveRequest, CurveResult, run_curve),
    "relax": JobKind(RelaxRequest, RelaxResult, run_relax),
    "sweep": JobKind(SweepRequest, SweepResult, run_sweep),
    "characterise": JobKind(CharacteriseRequest, CharacteriseResult, run_characterise),
    "atlas": JobKind(AtlasRequest, AtlasResult, run_atlas),
    "find": JobKind(FindRequest, FindResult, run_find),
    "fill": JobKind(FillRequest, FillResult, run_fill),
    "shape": JobKind(ShapeRequest, ShapeResult, run_shape),
    "fit": JobKind(FitRequest, FitResult, run_fit),
    "bending": JobKind(BendingRequest, BendingResult, run_bending),
    "compression": JobKind(CompressionRequest, CompressionResult, run_compression),
    "compare": JobKind(CompareRequest, CompareResult, run_compare),
    "calibrate": JobKind(CalibrateRequest, CalibrateResult, run_calibrate),
}


def content_key(kind: str, request: str) -> str:
    """A name made of everything that decides a result: kind, request, and this program."""
    return hashlib.sha256(f"{program_version()}\0{kind}\0{request}".encode()).hexdigest()


@cache
def program_version() -> str:
    """Digest of what computes: after an update, no older result is taken for a new one."""
    root = Path(__file__).resolve().parents[2]
    digest = hashlib.sha256()
    for file in sorted((*root.glob("knitcore/**/*"), *root.glob("app/operations/*"))):
        if file.suffix in DECIDING:
            digest.update(str(file.relative_to(root)).encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()
