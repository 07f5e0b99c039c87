"""How a tester's table is read."""

from typing import Annotated

from pydantic import Field

from knitcore.measure.table_reading import TableReading

from .base import RequestModel

Title = Annotated[str, Field(max_length=200)]


class TableTemplate(RequestModel):
    """How a table of a stretch test is read, where it does not say so itself or says it wrongly."""

    columns: dict[str, Title] = Field(
        {},
        max_length=10,
        description="What the table calls our columns: strain_along or extension_mm, "
        'strain_across, force_n, width_mm; such as {"force_n": "Channel 2 (N)"}. An empty title '
        "leaves a column out.",
    )
    units: dict[str, Annotated[str, Field(max_length=20)]] = Field(
        {},
        max_length=10,
        description='Units of our columns in place of the table\'s, such as {"force_n": "cN"}; '
        "`ratio` for a strain that is length over length at rest.",
    )
    width_mm: float | None = Field(None, ge=5, le=10_000, description="Clamped width at rest.")
    length_mm: float | None = Field(
        None, ge=5, le=10_000, description="Distance of the clamps at rest."
    )
    narrowing_is_positive: bool = Field(
        False, description="The strain across is positive where the fabric narrows."
    )
    keeps_slack: bool = Field(
        False, description="Strains count from the first reading, though the force rises later."
    )


def reading_of(template: TableTemplate | None) -> TableReading:
    """The library's form of a template."""
    return TableReading(**dict(template or {}))
