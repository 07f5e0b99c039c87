"""Reading a chart from a file: text, PNG (one pixel a stitch) or the project's JSON."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from PIL import Image, UnidentifiedImageError

from knitcore.chart import StitchChart, check_size
from knitcore.errors import InputError

MAX_FILE_BYTES = 16_000_000
DESIGN_FORMAT = "knitcore-design"
DESIGN_VERSION = 1


def read_chart(path: str | Path) -> StitchChart:
    """The chart in a ``.txt``, ``.png`` or ``.json`` file.

    Raises
    ------
    InputError
        If the file is missing, too large, of another kind, or does not hold what its name says.
    """
    file = Path(path)
    readers = {".txt": _read_text, ".png": _read_png, ".json": _read_design}
    reader = readers.get(file.suffix.lower())
    if reader is None:
        raise InputError(
            "chart",
            f"{file.name} is of no kind that holds a chart.",
            "Use a .txt file of K/P lines, a .png with one pixel a stitch, or a .json design.",
        )
    if not file.is_file():
        raise InputError("chart", f"there is no file {file}.", "Check the path.")
    if file.stat().st_size > MAX_FILE_BYTES:
        raise InputError(
            "chart", f"{file.name} is too large.", f"Use at most {MAX_FILE_BYTES // 10**6} MB."
        )
    return reader(file)


def _read_text(file: Path) -> StitchChart:
    try:
        return StitchChart.parse(file.read_text(encoding="utf-8"))
    except UnicodeDecodeError:
        raise InputError(
            "chart", f"{file.name} is not UTF-8 text.", "Save it as plain text of K and P."
        ) from None


def _read_png(file: Path) -> StitchChart:
    """Dark pixels are purls (the dots of a printed chart), light or transparent ones knits."""
    try:
        with Image.open(file, formats=["PNG"]) as image:
            check_size(image.height, image.width)  # before any pixel is decoded
            flat = Image.new("RGBA", image.size, "white")
            flat.alpha_composite(image.convert("RGBA"))
            return StitchChart(np.asarray(flat.convert("L"))[::-1] < 128)
    except (UnidentifiedImageError, OSError, SyntaxError):
        raise InputError(
            "chart", f"{file.name} is not a readable PNG.", "Export it again as PNG."
        ) from None


def _read_design(file: Path) -> StitchChart:
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
    except (UnicodeDecodeError, json.JSONDecodeError, RecursionError) as error:
        raise InputError(
            "chart", f"{file.name} is not valid JSON ({error}).", "Export the design again."
        ) from None
    if not isinstance(content, dict) or content.get("format") != DESIGN_FORMAT:
        raise InputError(
            "chart", f"{file.name} is not a design.", f'A design says "format": "{DESIGN_FORMAT}".'
        )
    if content.get("version") != DESIGN_VERSION:
        raise InputError(
            "version",
            f"{file.name} is of version {content.get('version')!r}.",
            f"This program reads version {DESIGN_VERSION}.",
        )
    text = content.get("chart")
    if not isinstance(text, str):
        raise InputError("chart", f"{file.name} holds no chart text.", "Export the design again.")
    return StitchChart.parse(text)
