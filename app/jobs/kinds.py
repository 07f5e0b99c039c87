"""What can run in the background: the operations that take longer than a page should wait."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from app.operations.field import (
    CalibrateRequest,
    CalibrateResult,
    CompareRequest,
    CompareResult,
    run_calibrate,
    run_compare,
)
from app.operations.fit import FitRequest, FitResult, run_fit
from app.operations.measure import BendingRequest, BendingResult, run_bending
from app.operations.relax import RelaxRequest, RelaxResult, run_relax
from app.operations.stretch import StretchRequest, StretchResult, StretchRun, run_stretch
from app.operations.sweep import SweepRequest, SweepResult, run_sweep


class StretchJob(BaseModel):
    """A stretch test."""

    model_config = ConfigDict(extra="forbid")
    kind: Literal["stretch"]
    request: StretchRequest


class RelaxJob(BaseModel):
    """A relaxation at the yarn level."""

    model_config = ConfigDict(extra="forbid")
    kind: Literal["relax"]
    request: RelaxRequest


class SweepJob(BaseModel):
    """A stretch sweep at the yarn level."""

    model_config = ConfigDict(extra="forbid")
    kind: Literal["sweep"]
    request: SweepRequest


class FitJob(BaseModel):
    """A law from two stretch tests."""

    model_config = ConfigDict(extra="forbid")
    kind: Literal["fit"]
    request: FitRequest


class BendingJob(BaseModel):
    """A bending modulus from photos."""

    model_config = ConfigDict(extra="forbid")
    kind: Literal["bending"]
    request: BendingRequest


class CompareJob(BaseModel):
    """A law beside a measured displacement field."""

    model_config = ConfigDict(extra="forbid")
    kind: Literal["compare"]
    request: CompareRequest


class CalibrateJob(BaseModel):
    """A law calibrated on a measured displacement field."""

    model_config = ConfigDict(extra="forbid")
    kind: Literal["calibrate"]
    request: CalibrateRequest


JobRequest = Annotated[
    StretchJob | RelaxJob | SweepJob | FitJob | BendingJob | CompareJob | CalibrateJob,
    Field(discriminator="kind"),
]


def _json(answer: BaseModel) -> bytes:
    return answer.model_dump_json().encode()


def _json_of_run(run: StretchRun) -> bytes:
    return run.result_json


@dataclass(frozen=True)
class JobKind:
    """An operation as a job.

    Attributes
    ----------
    request, result : what it takes and gives.
    function : does the work in a worker.
    told : JSON for the caller, of what the function returns.
    """

    request: type[BaseModel]
    result: type[BaseModel]
    function: Callable[..., Any]
    told: Callable[[Any], bytes] = _json


KINDS: dict[str, JobKind] = {
    "stretch": JobKind(StretchRequest, StretchResult, run_stretch, _json_of_run),
    "relax": JobKind(RelaxRequest, RelaxResult, run_relax),
    "sweep": JobKind(SweepRequest, SweepResult, run_sweep),
    "fit": JobKind(FitRequest, FitResult, run_fit),
    "bending": JobKind(BendingRequest, BendingResult, run_bending),
    "compare": JobKind(CompareRequest, CompareResult, run_compare),
    "calibrate": JobKind(CalibrateRequest, CalibrateResult, run_calibrate),
}


def content_key(kind: str, request: str) -> str:
    """A name made of everything that decides a result."""
    return hashlib.sha256(f"{kind}\0{request}".encode()).hexdigest()
