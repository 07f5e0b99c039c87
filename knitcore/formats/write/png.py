"""Charts as pictures with one pixel per stitch: a purl is dark, as the dot of a printed chart.

A piece with an outline or with yarns of its own is a picture with a palette, its "no stitch"
transparent and its yarns light where they knit and dark where they purl; the names of the yarns are
in the file. A chart of other stitches has a colour for each kind, light where it is knitted and
dark where it is purled, and their codes are in the file.
:mod:`knitcore.formats.read.picture` reads them back, and any other picture.
"""

import colorsys
import io
import json

import numpy as np
from PIL import Image, PngImagePlugin

from knitcore.base.arrays import Codes
from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.stitch_kinds import BY_CODE, STITCHES
from knitcore.chart.symbol_chart import CONTINUED, SymbolChart
from knitcore.garment.piece import Piece

TEXT_KEY = "knitcore-yarns"
STITCHES_KEY = "knitcore-stitches"
MAX_YARNS, MAX_KINDS = 127, 256
_TURN = 0.381966
"""Part of the circle of colours between a kind of stitch and the next."""
_LIGHT, _DARK = 170.0, 84.0
"""Least brightness of knits, and greatest of purls."""


def write_png(chart: StitchChart | Piece | SymbolChart) -> bytes:
    """The picture, the top row of the chart at its top.

    Raises
    ------
    InputError
        If there are more yarns or kinds of stitches than a palette holds.
    """
    buffer = io.BytesIO()
    if isinstance(chart, SymbolChart):
        _save_stitches(chart, buffer)
        return buffer.getvalue()
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


def _save_stitches(chart: SymbolChart, buffer: io.BytesIO) -> None:
    kinds = [int(place) for place in np.unique(chart.cells) if place != CONTINUED]
    if len(kinds) > MAX_KINDS:
        problem = f"it has {len(kinds)} kinds of stitches."
        raise InputError("chart", problem, f"A picture holds {MAX_KINDS}: export text.")
    columns = np.where(chart.cells != CONTINUED, np.arange(chart.columns), 0)
    begins = np.maximum.accumulate(columns, axis=1)
    index = np.searchsorted(kinds, np.take_along_axis(chart.cells, begins, axis=1))
    image = Image.fromarray(index[::-1].astype(np.uint8), mode="P")
    image.putpalette([channel for kind in kinds for channel in _colour_of(kind)])
    said = PngImagePlugin.PngInfo()
    said.add_itxt(STITCHES_KEY, json.dumps([STITCHES[kind].code for kind in kinds]))
    image.save(buffer, format="PNG", pnginfo=said)


def _colour_of(kind: int) -> tuple[int, int, int]:
    """White and black for knit and purl, colours around the circle for other stitches."""
    stitch = STITCHES[kind]
    purled = sum(site.purl for site in stitch.sites) * 2 > stitch.width
    if kind <= BY_CODE["P"]:
        return (0, 0, 0) if purled else (255, 255, 255)
    channels = colorsys.hsv_to_rgb(kind * _TURN % 1.0, 0.6, 0.9)
    colour = "#" + "".join(f"{round(255 * part):02x}" for part in channels)
    return _shade(colour, knit=not purled)


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
