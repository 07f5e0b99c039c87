"""Cut pieces, conditions on their edges, and tests of them."""

from collections.abc import Callable
from typing import Annotated, Any, Literal, Self, TypeVar

import numpy as np
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.cloth.cut import Condition, CutPiece, Held, PieceTest, Pulled, Sewn, Traction
from knitcore.cloth.cut.cut_mesh import DEFAULT_ELEMENTS, size_for
from knitcore.cloth.cut.outline import MAX_CORNERS
from knitcore.cloth.flat.strip_uncertainty import interval_source
from knitcore.materials import Material
from knitcore.materials.law_uncertainty import Z_SCORE

from ..context import Context
from .base import Floats, IntervalResult, RequestModel
from .charts import MaterialName, RepeatInput, to_repeat
from .fabrics import Gauged, LawsRequest

T = TypeVar("T")
MAX_ELEMENT_STEPS = 40_000
"""Largest number of elements times steps over REST, about a minute; the command line accepts
more."""
MAX_CONDITIONS = 50

Millimetres = Annotated[float, Field(ge=-10_000, le=10_000)]
Size = Annotated[float, Field(ge=1, le=10_000)]
Corners = Annotated[
    list[tuple[Millimetres, Millimetres]], Field(min_length=3, max_length=MAX_CORNERS)
]
EdgeName = Annotated[str, Field(min_length=1, max_length=100)]


class HeldInput(RequestModel):
    """An edge that is gripped, or sewn to something stiff, and moved as a whole."""

    kind: Literal["held"]
    edge: EdgeName
    x_mm: Millimetres | None = Field(
        0.0, description="Displacement of the edge along x; null lets it slide along x."
    )
    y_mm: Millimetres | None = Field(
        0.0, description="Displacement of the edge along y; null lets it slide along y."
    )


class PulledInput(RequestModel, Pulled):
    """An edge in a clamp that does not turn and moves freely under a force."""

    kind: Literal["pulled"]
    edge: EdgeName


class TractionInput(RequestModel, Traction):
    """A load spread evenly along an edge, per length at rest."""

    kind: Literal["traction"]
    edge: EdgeName


class SewnInput(RequestModel):
    """An edge with a tape or elastic sewn on, which resists stretching and bends freely."""

    kind: Literal["sewn"]
    edge: EdgeName
    stiffness_n: float = Field(gt=0, description="Force of the tape over its strain.")


ConditionInput = Annotated[
    HeldInput | PulledInput | TractionInput | SewnInput, Field(discriminator="kind")
]
_CONDITIONS = {"held": Held, "pulled": Pulled, "traction": Traction, "sewn": Sewn}


class PieceInput(RequestModel):
    """A piece cut from cloth, and the conditions on its edges at the last step."""

    outline: Corners = Field(
        description="Corners in mm; side 1 goes from the first to the second.",
        examples=[[[0, 0], [50, 0], [50, 100], [0, 100]]],
    )
    holes: list[Corners] = Field(
        [], max_length=100, description="Corners of each hole; their sides continue the numbering."
    )
    grain_deg: float = Field(
        0.0, description="Angle from the x axis to the rows, counter-clockwise: 45 is on the bias."
    )
    edges: dict[EdgeName, Annotated[list[int], Field(max_length=MAX_CORNERS)]] = Field(
        description="Names of parts of the boundary, by the numbers of their sides.",
        examples=[{"bottom": [1], "top": [3]}],
        max_length=MAX_CORNERS,
    )
    conditions: list[ConditionInput] = Field(min_length=1, max_length=MAX_CONDITIONS)

    def piece(self) -> CutPiece:
        """The piece as an object of the library."""
        return self.pass_to(CutPiece)

    def loads(self) -> list[Condition]:
        """The conditions as objects of the library."""
        return [given.pass_to(_CONDITIONS[given.kind]) for given in self.conditions]


class PieceTestRequest(Gauged, LawsRequest):
    """Cloth of a chart, repeated over a piece, and how finely it is computed."""

    chart: RepeatInput
    material: MaterialName
    steps: int = Field(10, ge=1, le=1000, description="Steps of the load.")
    shear_modulus_n_per_mm: float | None = Field(
        None, ge=1e-4, le=10, description="Shear modulus C_xyxy; that of the laws by default."
    )
    mesh_mm: float | None = Field(
        None,
        gt=0,
        le=10_000,
        description="Length of an element's side; by default there are about 600 elements.",
    )

    def cut(self) -> CutPiece:
        """The piece that is tested."""
        raise NotImplementedError

    def check_parts(self, context: Context) -> None:
        """Refuse a test that would take too long for the service."""
        piece = self.cut()
        least = size_for(piece, MAX_ELEMENT_STEPS // self.steps)
        size = size_for(piece, DEFAULT_ELEMENTS) if self.mesh_mm is None else self.mesh_mm
        if size < least and not context.local:
            raise InputError(
                "mesh_mm",
                f"{size:.3g} mm is too fine here for {self.steps} steps.",
                f"Use at least {least:.3g} mm, fewer steps, or the command line.",
            )

    def pull(self, test: Callable[..., T], context: Context, **more: Any) -> tuple[T, Material]:
        """A test of the library on a rectangle of the chart's cloth, and the cloth's material."""
        self.check_parts(context)
        material = context.material(self.material)
        more |= {"progress": context.progress, "cancelled": context.cancelled}
        more["size"] = self.relaxed_size
        return self.pass_to(test, to_repeat(self.chart), material, **more), material


class PieceTestResult(IntervalResult):
    """Fields that all tests of pieces share; lists have a value per step."""

    energy_n_mm: Floats = Field(description="Energy stored in the cloth.")
    converged: bool
    seconds: float
    nodes: int
    elements: int
    utilisation: float = Field(
        description="Largest alpha * strain at the last step; 1 is the lock-up."
    )
    messages: list[str]

    @classmethod
    def of_pull(cls, pull: Any, material: Material, **more: Any) -> Self:
        """Make a result from a test of a rectangle, with an interval for each force."""
        ends = {}
        for name in cls.model_fields:
            force, is_interval, _ = name.partition("_interval_n")
            if is_interval:
                factor = np.exp(Z_SCORE * getattr(pull, f"{force}_log_sd"))
                value = getattr(pull, f"{force}_n")
                ends[name] = value / factor, value * factor
        return cls.of(pull, **ends, **of_test(pull.test, material), **more)


def of_test(test: PieceTest, material: Material) -> dict[str, Any]:
    """Fields of every result, from the library's test."""
    past = bool(test.equilibria) and test.is_past_the_law()
    extrapolated = "Some cloth has run out of stretch: do not rely on the forces."
    return {
        "energy_n_mm": test.energy_n_mm,
        "interval_source": interval_source(test.energy.cloth.sheet, material),
        "converged": test.converged,
        "seconds": test.seconds,
        "nodes": test.nodes_mm.shape[1],
        "elements": test.mesh.nelements,
        "utilisation": test.utilisation() if test.equilibria else 0.0,
        "messages": [*([test.problem] if test.problem else []), *([extrapolated] if past else [])],
    }
