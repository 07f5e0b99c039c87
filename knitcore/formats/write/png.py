"""Charts as pictures with one pixel per stitch: a purl is dark, as the dot of a printed chart.

A piece with an outline or with yarns of its own is a picture with a palette, its "no stitch"
transparent and its yarns light where they knit and dark where they purl; the names of the yarns are
in the file. :mod:`knitcore.formats.read.picture` reads them back, and any other picture.
"""

import io
import json

import numpy as np
from PIL import Image, PngImagePlugin

from knitcore.base.arrays import Codes
from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.garment.piece import Piece

TEXT_KEY = "knitcore-yarns"
MAX_YARNS = 127
_LIGHT, _DARK = 170.0, 84.0
"""Least brightness of knits, and greatest of purls."""


def write_png(chart: StitchChart | Piece) -> bytes:
    """The picture, the top row of the chart at its top.

    Raises
    ------
    InputError
        If there are more yarns than a palette holds.
    """
    buffer = io.BytesIO()
    if isinstance(chart, Piece) and not chart.is_plain:
        _save_piece(chart, buffer)
        return buffer.getvalue()
    purl = chart.chart.purl if isinstance(chart, Piece) else chart.purl
    image = Image.fromarray(np.where(purl[::-1], 0, 255).astype(np.uint8)).convert("1")
    image.save(buffer, format="PNG", optimize=True)
    return buffer.getvalue()


def write_grey(grey: Codes) -> bytes:
    """A picture of grey levels, uint8 (rows, columns), its first row at the top."""
    buffer = io.BytesIO()
    Image.fromarray(grey).save(buffer, format="PNG", optimize=True)
    return buffer.getvalue()


def _save_piece(piece: Piece, buffer: io.BytesIO) -> None:
    if len(piece.yarns) > MAX_YARNS:
        raise InputError(
            "yarns", f"{len(piece.yarns)} are too many.", f"Use at most {MAX_YARNS} yarns."
        )
    index = np.where(piece.shaped.stitch, 1 + 2 * piece.yarn_of + piece.chart.purl, 0)
    image = Image.fromarray(index[::-1].astype(np.uint8), mode="P")
    palette = [(255, 255, 255)]
    for yarn in piece.yarns:
        palette += [_shade(yarn.colour, knit=True), _shade(yarn.colour, knit=False)]
    image.putpalette([channel for colour in palette for channel in colour])
    said = PngImagePlugin.PngInfo()
    yarns = [[yarn.name, yarn.colour] for yarn in piece.yarns]
    said.add_itxt(TEXT_KEY, json.dumps(yarns, ensure_ascii=False))
    image.save(buffer, format="PNG", transparency=0, pnginfo=said)


def _shade(colour: str, *, knit: bool) -> tuple[int, int, int]:
    """A yarn's colour, bright enough to be read as a knit or dark enough to be read as a purl."""
    rgb = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)], dtype=np.float64)
    bright = float(rgb @ (0.299, 0.587, 0.114))
    if knit and bright < _LIGHT:
        rgb += (255 - rgb) * (_LIGHT - bright) / (255 - bright)
    elif not knit and bright > _DARK:
        rgb *= _DARK / bright
    red, green, blue = (int(channel) for channel in rgb.round())
    return red, green, blue
