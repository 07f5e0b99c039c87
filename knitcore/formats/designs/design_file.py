"""The project file: one design as versioned JSON.

::

    {"format": "knitcore-design", "version": 2, "name": "Cuff", "material": "acrylic",
     "chart": "KPKP\\nPKPK", "note": "", "outline": null, "regions": [], "repeats": [], "shelf": []}

Only ``format``, ``version`` and ``chart`` (K/P lines, top row first) are needed; what the rest
means is in :mod:`knitcore.formats.designs.layout`. The schema is :func:`design_schema`.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, Literal

from pydantic import ConfigDict, Field, ValidationError

from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart, as_stitches, knits_and_purls, plain_chart
from knitcore.formats.designs.layout import MAX_TEXT, DesignLayout, check_layout, piece_of
from knitcore.formats.designs.other_stitches import composed
from knitcore.garment.piece import Piece

FORMAT: Final = "knitcore-design"
VERSION: Final = 2


_HEADER = ("format", "version", "name", "material", "note", "chart")


class DesignFile(DesignLayout):
    """A design as a file holds it."""

    model_config = ConfigDict(extra="forbid", frozen=True, title="Knitcore design")

    format: Literal["knitcore-design"] = FORMAT
    version: Literal[2] = VERSION
    name: str = Field("Untitled", min_length=1, max_length=200, pattern=r"^[^\x00-\x1f]+$")
    material: str | None = Field(
        None,
        min_length=1,
        max_length=80,
        pattern=r"^[^\x00-\x1f]+$",
        description="Library id or name of a material file.",
    )
    chart: str = Field(
        max_length=MAX_TEXT,
        description="K/P lines, the top row first, face side; or lines of other stitches.",
    )
    note: str = Field("", max_length=20_000, pattern=r"^[^\x00]*$")

    def to_piece(self) -> Piece:
        """The chart with its outline and its yarns."""
        return piece_of(self.to_chart(), self)

    def to_chart(self) -> StitchChart:
        """The chart itself, of knits and purls."""
        return knits_and_purls(self.to_stitches()) if self.other_stitches else self.to_purl_map()

    def to_purl_map(self) -> StitchChart:
        """The knits and purls of the chart, also those under other stitches."""
        return plain_chart(self.chart)

    def to_stitches(self) -> StitchChart | SymbolChart:
        """The chart itself, of any stitches.

        Raises
        ------
        InputError
            As :func:`composed`.
        """
        if self.other_stitches:
            return composed(self.to_purl_map(), self.other_stitches)
        return as_stitches(self.chart)


def write_design(design: DesignFile) -> str:
    """The text of the file: a line for each field, and for each item of its lists."""
    fields = []
    for name in (*_HEADER, *DesignLayout.model_fields):
        value = design.model_dump(include={name})[name]
        if name == "other_stitches" and not value:
            continue
        written = json.dumps(value, ensure_ascii=False)
        if isinstance(value, list) and value:
            items = ",\n  ".join(json.dumps(item, ensure_ascii=False) for item in value)
            written = f"[\n  {items}\n ]"
        fields.append(f' "{name}": {written}')
    return "{\n" + ",\n".join(fields) + "\n}\n"


@in_reading_time
def read_design(file: Path) -> DesignFile:
    """The design in a file.

    Raises
    ------
    InputError
        If it is not JSON, not a design, or of a version that this program does not know.
    """
    try:
        content = json.loads(file.read_bytes())  # in any UTF, with or without its mark
    except (ValueError, RecursionError) as error:
        raise InputError(
            "chart", f"{file.name} is not valid JSON ({error}).", "Export the design again."
        ) from None
    return design_from_mapping(content, file.name)


def design_from_mapping(content: Any, name: str = "the file") -> DesignFile:
    """A design from the content of such a file."""
    if not isinstance(content, Mapping) or content.get("format") != FORMAT:
        raise InputError("chart", f"{name} is not a design.", f'A design has "format": "{FORMAT}".')
    data = dict(content)
    version = data.get("version")
    if type(version) is not int or version != VERSION:
        raise InputError(
            "version", f"{name} is of version {version!r}.", f"This program reads {VERSION}."
        )
    if not isinstance(data.get("chart"), str):
        raise InputError("chart", f"{name} holds no chart text.", "Export the design again.")
    try:
        design = DesignFile.model_validate(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(str(part) for part in first["loc"])
        raise InputError(where, f"{name}: {first['msg']}.", "Correct or export it again.") from None
    stitches = design.to_purl_map() if design.other_stitches else design.to_stitches()
    if isinstance(stitches, SymbolChart):
        check_bare(design)
    else:
        check_layout(stitches, design)
    return design


def check_bare(design: DesignLayout) -> None:
    """Refuse an outline and yarns, which belong to charts of knits and purls.

    Raises
    ------
    InputError
    """
    for field in ("outline", "regions", "repeats"):
        if getattr(design, field):
            raise InputError(
                field,
                "a chart with lace, cables, tucks or slipped stitches has none yet.",
                "Leave it out, or give a chart of K and P.",
            )


def design_schema() -> dict[str, Any]:
    """The JSON schema of the project file."""
    schema = DesignFile.model_json_schema()
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}
