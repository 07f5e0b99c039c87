"""A garment in five sizes: stitches and rows of each."""

from collections.abc import Callable, Iterator, Sequence

from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.garment.plan import GarmentPlan

from .base import RequestModel, ResultModel
from .garments import Template

AS_MEASURED = "as measured"
SIZES = {"XS": -2, "S": -1, AS_MEASURED: 0, "L": 1, "XL": 2}
"""Names of the sizes, and how many steps each is from the measurements."""


class SizeSteps(RequestModel):
    """How much larger a size is than the one before it."""

    wider_percent: float = Field(5.0, ge=0, le=20, description="On measures around the body.")
    longer_percent: float = Field(3.0, ge=0, le=20, description="On measures along the body.")


class PartSize(ResultModel):
    """Stitches of a part's longest row, and rows of its longest column."""

    name: str
    columns: int
    rows: int


class SizeResult(PartSize):
    """A size of the garment: its whole chart and its parts."""

    yarn_m: float
    parts: list[PartSize]


def sizes_of(
    template: Template, steps: SizeSteps, plan_of: Callable[[Template], GarmentPlan]
) -> list[SizeResult]:
    """Plan a garment in every size.

    Raises
    ------
    InputError
        If a size cannot be planned; it is named.
    """
    around, along = (1 + by / 100 for by in (steps.wider_percent, steps.longer_percent))
    results = []
    for name, step in SIZES.items():
        try:
            plan = plan_of(template.scaled(around**step, along**step))
        except InputError as error:
            problem = f"size {name} cannot be planned: {error.problem}"
            raise InputError("sizes", problem, "Use smaller steps between sizes.") from None
        results.append(_size(name, plan))
    return results


def _size(name: str, plan: GarmentPlan) -> SizeResult:
    stitch = plan.shaped.stitch
    cells = {region.name: region.cells & stitch for region in plan.regions}
    return SizeResult(
        name=name,
        columns=stitch.shape[1],
        rows=stitch.shape[0],
        yarn_m=plan.yarn.length_m,
        parts=[
            PartSize(
                name=part, columns=int(where.sum(axis=1).max()), rows=int(where.sum(axis=0).max())
            )
            for part, where in cells.items()
        ],
    )


def size_lines(sizes: list[SizeResult]) -> Iterator[str]:
    """Lines for the knitter: the whole, then every part, in all sizes."""
    if not sizes:
        return
    names = "; ".join(size.name for size in sizes)
    yield f"Sizes {names}, each as stitches of the longest row × rows of the longest column."
    yield f"Whole: {_in_all(sizes)}."
    for part in next(size for size in sizes if size.name == AS_MEASURED).parts:
        same = [next((p for p in size.parts if p.name == part.name), None) for size in sizes]
        yield f"{part.name[:1].upper()}{part.name[1:]}: {_in_all(same)}."
    yield f"Yarn: {'; '.join(f'{size.yarn_m:.0f}' for size in sizes)} m."


def _in_all(parts: Sequence[PartSize | None]) -> str:
    return "; ".join(f"{p.columns} × {p.rows}" if p else "none" for p in parts)
