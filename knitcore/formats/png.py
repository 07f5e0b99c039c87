"""Charts as pictures with one pixel a stitch: a purl is dark, as the dot of a printed chart."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
from PIL import Image, UnidentifiedImageError

from knitcore.chart import StitchChart, check_size
from knitcore.errors import InputError


def write_png(chart: StitchChart) -> bytes:
    """The picture, the top row of the chart at its top."""
    image = Image.fromarray(np.where(chart.purl[::-1], 0, 255).astype(np.uint8)).convert("1")
    buffer = io.BytesIO()
    image.save(buffer, format="PNG", optimize=True)
    return buffer.getvalue()


def read_png(file: Path) -> StitchChart:
    """Dark pixels are purls, light or transparent ones knits.

    Raises
    ------
    InputError
        If it is no PNG, or over-large.
    """
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
