"""Named patterns to begin with."""

from __future__ import annotations

from pydantic import BaseModel, Field

from knitcore.patterns import PATTERNS


class PatternResult(BaseModel):
    """A repeat with a name."""

    id: str
    name: str
    chart: str = Field(description="K/P lines of one repeat, the top row first.")
    note: str


class Patterns(BaseModel):
    """All named patterns."""

    patterns: list[PatternResult]


def list_patterns() -> Patterns:
    """The pattern shelf."""
    return Patterns(
        patterns=[
            PatternResult(id=p.identifier, name=p.name, chart=p.chart.text, note=p.note)
            for p in PATTERNS
        ]
    )
