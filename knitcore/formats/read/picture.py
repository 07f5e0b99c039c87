"""Pictures read as charts: one pixel a stitch, or a drawn grid, or a picture scaled to stitches.

The two groups of tones, or of colours, that part the stitches best decide what is knit (the lighter
one) and what is purl. Pictures of this library (:mod:`knitcore.formats.write.png`) keep their
outline and yarns.
"""

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image, ImageOps, UnidentifiedImageError

from knitcore.base.arrays import Array, Indices, Mask
from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE, StitchChart, check_chart_size
from knitcore.chart.stitch_kinds import BY_CODE, STITCHES
from knitcore.chart.symbol_chart import CONTINUED, SymbolChart
from knitcore.formats.read.chart_files import Aspect, PictureReading
from knitcore.formats.write.png import STITCHES_KEY, TEXT_KEY
from knitcore.garment.piece import Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart

MAX_PIXELS = 16_000_000
MAX_SIDE = 1600
"""Pixels along a side to which larger pictures are reduced."""
MIN_CELL_PIXELS = 8
"""Least side of a cell that is taken as a stitch; smaller blocks are stitches of a pixel each."""
MOST_LONG = 2.5
"""Height over width of a cell, or width over height, beyond which it is several stitches."""
MAX_UNTOLD = 64
"""Pixels of the longer side up to which a pixel counts as a stitch without a note."""
_LINE = 0.75
"""Part of a picture's side that a line of a grid crosses."""
_WHOLE = 0.1
"""Part of a cell by which a border may miss whole cells."""
_FORMATS = ["PNG", "JPEG", "GIF", "BMP", "TIFF", "WEBP"]
_LUMINANCE = np.array([0.299, 0.587, 0.114])
_CLEAR = 0.8
"""Share of the variance that two groups explain if there are two; noise about one has 0.64."""
_NOISE = 24.0
"""Difference of two groups that are told apart although they are not clear, of 255."""
_PLAIN_LIGHT, _PLAIN_DARK = 170.0, 84.0
"""Least tone of light stitches, and greatest of dark ones, that need no note on which is which."""


def read_picture(
    file: Path, reading: PictureReading | None = None
) -> tuple[Piece | SymbolChart, tuple[str, ...]]:
    """The piece of a picture, or its chart of other stitches, and notes on how it was read.

    Raises
    ------
    InputError
        If it cannot be read, is too large, or has no pixel for a stitch.
    """
    try:
        with Image.open(file, formats=_FORMATS) as image:
            _check_pixels(image)  # before any pixel is decoded
            text = image.info.get(TEXT_KEY)
            if isinstance(text, str) and image.mode == "P" and reading is None:
                return _own(np.asarray(image)[::-1].astype(np.intp), text, file.name), ()
            codes = image.info.get(STITCHES_KEY)
            if isinstance(codes, str) and image.mode == "P" and reading is None:
                return _own_stitches(np.asarray(image)[::-1].astype(np.intp), codes, file.name), ()
            notes = list(_lost(image, has_yarns=isinstance(text, str)))
            if isinstance(codes, str):
                notes.append("Its stitches other than knits and purls are lost.")
            is_own = image.mode == "1" or isinstance(text, str)
            is_drawn = image.format == "JPEG"
            colours, is_clear = _colours(ImageOps.exif_transpose(image))
    except (Image.DecompressionBombError, Image.DecompressionBombWarning):
        raise _too_large(f"{file.name} has more pixels than any chart has stitches.") from None
    except InputError:
        raise
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError, OverflowError):
        kind = "PNG" if file.suffix.lower() == ".png" else "picture"
        raise InputError(
            "chart", f"{file.name} is not a readable {kind}.", "Export it again as PNG."
        ) from None
    if is_clear:
        notes.append("Transparent pixels are read as knits; an outline is not taken from them.")
    reading = reading or PictureReading()
    if not is_own and reading.columns is None and reading.rows is None:
        colours, border_notes = _without_border(colours)
        notes += border_notes
    columns, rows, size_notes = _size(colours, reading, is_own=is_own, is_drawn=is_drawn)
    purl, tone_notes = _purls(_cells(colours, rows, columns), reading)
    chart = StitchChart(purl[::-1])
    return Piece.plain(chart), (*notes, *size_notes, *tone_notes)


def _check_pixels(image: Image.Image) -> None:
    if image.width * image.height > MAX_PIXELS:
        raise _too_large(f"{image.width}x{image.height} pixels are too large.")


def _too_large(problem: str) -> InputError:
    remedy = (
        f"Use at most {MAX_STITCHES_PER_SIDE} rows and {MAX_STITCHES_PER_SIDE} columns with a "
        f"pixel a stitch, or {MAX_PIXELS // 10**6} million pixels."
    )
    return InputError("chart", problem, remedy)


def _lost(image: Image.Image, *, has_yarns: bool) -> Iterator[str]:
    if has_yarns:
        why = "it is scaled" if image.mode == "P" else "another program changed its colours"
        yield f"Its outline and yarns are lost: {why}."
    if getattr(image, "n_frames", 1) > 1:
        yield "Only the first of its pictures is read."


def _colours(image: Image.Image) -> tuple[Array, bool]:
    """Red, green and blue over white, 0 to 255, (height, width, 3); whether a part is transparent.

    Large pictures come out smaller.
    """
    factor = -(-max(image.size) // MAX_SIDE)
    if image.mode.startswith(("I", "F")):
        values = np.asarray(image, dtype=np.float64)[::factor, ::factor]
        if not np.isfinite(values).all():
            raise InputError("chart", "a pixel is not a number.", "Export it again as PNG.")
        low, high = float(values.min()), float(values.max())
        whole = 65535.0 if image.mode.startswith("I") else 1.0
        if low < 0 or high > whole:  # of no usual range: that of the picture itself
            values, whole = values - low, max(high - low, 1e-300)
        return np.repeat((values * (255 / whole))[..., None], 3, axis=2), False
    clear = image.convert("RGBA")
    flat = Image.new("RGBA", image.size, "white")
    flat.alpha_composite(clear)
    alpha = np.asarray(clear.getchannel("A"))
    is_part_clear = bool((alpha == 0).any() and (alpha > 0).any())
    return np.asarray(flat.convert("RGB").reduce(factor), dtype=np.float64), is_part_clear


def _size(
    colours: Array, reading: PictureReading, *, is_own: bool, is_drawn: bool
) -> tuple[int, int, list[str]]:
    """Columns and rows of the chart, and notes on them."""
    height, width = colours.shape[:2]
    columns, rows = reading.columns, reading.rows
    if columns is None and rows is None:
        across, down, notes = _size_shown(colours, is_own=is_own, is_drawn=is_drawn)
        if reading.aspect is not Aspect.AS_KNITTED:
            check_chart_size(down, across)
            return across, down, notes
        columns, height, width = across, down, across
    else:
        notes = []
    ratio = height / width
    if reading.aspect is Aspect.AS_KNITTED:
        if reading.stitch_ratio is None:
            problem = "the size of a knitted stitch is not known."
            raise InputError("aspect", problem, "Name a material that knits stockinette.")
        ratio /= reading.stitch_ratio
        how = f"stitches are {reading.stitch_ratio:.2f} times as high as wide, as knitted"
    else:
        how = "stitches counted as squares"
    if columns is not None and rows is not None:
        change = rows / columns / ratio
        if reading.aspect is not Aspect.FREE and abs(change - 1) > max(0.05, 0.5 / rows):
            notes.append(f"Rows and columns stretch the picture {change:.2f} times in height.")
    elif reading.aspect is Aspect.FREE:
        missing = "rows" if rows is None else "columns"
        raise InputError(missing, "is needed for a free aspect.", "Give rows and columns.")
    elif rows is None:
        columns = columns or 1
        rows = max(1, round(columns * ratio))
        notes.append(f"{rows} rows keep the picture's proportions: {how}.")
    else:
        columns = max(1, round(rows / ratio))
        notes.append(f"{columns} columns keep the picture's proportions: {how}.")
    check_chart_size(rows, columns)
    if rows > colours.shape[0] or columns > colours.shape[1]:
        notes.append("The picture has fewer pixels than the chart has stitches.")
    return columns, rows, notes


def _size_shown(colours: Array, *, is_own: bool, is_drawn: bool) -> tuple[int, int, list[str]]:
    """Columns and rows that the picture itself shows.

    Parameters
    ----------
    is_own : of this library, or black and white: a pixel is a stitch.
    is_drawn : a photo or a drawing, whose pixels are not exact.
    """
    height, width = colours.shape[:2]
    is_small = max(height, width) <= MAX_STITCHES_PER_SIDE
    if is_own and is_small:
        return width, height, []
    columns, rows = (_cells_along(_changes(colours, axis)) for axis in (1, 0))
    if columns and rows:
        wide, high = width / columns, height / rows
        longer = max(wide, high) / min(wide, high)
        if longer > MOST_LONG and abs(longer - round(longer)) < _WHOLE:  # blocks of stitches
            columns, rows = (round(side / min(wide, high)) for side in (width, height))
        if min(wide, high) >= MIN_CELL_PIXELS:
            note = (
                f"A grid of {columns} x {rows} cells is seen, each a stitch; another number of "
                "stitches across reads it otherwise."
            )
            return columns, rows, [note]
    if is_small and (not is_drawn or max(height, width) <= MAX_UNTOLD):
        note = f"Each of {width} x {height} pixels is a stitch. A drawing needs fewer across."
        return width, height, [note] * (max(height, width) > MAX_UNTOLD)
    why = "a photo has no pixel for a stitch" if is_small else "it has more pixels than a chart has"
    raise InputError(
        "columns",
        f"no grid is seen in the picture, and {why}.",
        "Cut it to its cells, or give columns, the width of the chart in stitches.",
    )


def _changes(colours: Array, axis: int) -> Array:
    """How much all pixels differ from the next along an axis; small differences are noise.

    Where lines are drawn across the whole picture, only they count: not the signs in its cells.
    """
    changes = np.abs(np.diff(colours, axis=axis)).sum(axis=2)
    changes[changes < 0.2 * changes.max(initial=0)] = 0
    across = (changes > 0).mean(axis=1 - axis)
    total = np.asarray(changes.sum(axis=1 - axis))
    is_line = across > 0.5 * across.max(initial=0)
    if across.max(initial=0) > _LINE:
        lines = np.where(is_line, total, 0.0)
        count = _cells_along(lines)
        if count and is_line.sum() > 1.5 * count:  # a line has two sides
            return lines
    return total


def _without_border(colours: Array) -> tuple[Array, list[str]]:
    """A picture without what is around a grid, and a note on it.

    It ends at the frame around the cells, beyond which there may be numbers; without a frame, where
    the plain border is not as wide as whole cells.
    """
    for is_framed in (True, False):
        (top, bottom), (left, right) = spans = [_span(colours, axis, is_framed) for axis in (0, 1)]
        inner = colours[top:bottom, left:right]
        margins = (top, colours.shape[0] - bottom, left, colours.shape[1] - right)
        counts = [_cells_along(_changes(inner, axis)) if inner.size else 0 for axis in (0, 1)]
        cell = [(b - a) / max(count, 1) for (a, b), count in zip(spans, counts, strict=True)]
        if not all(counts) or max(margins) < 2 or min(cell) < MIN_CELL_PIXELS:
            continue
        edges = inner[0], inner[-1], inner[:, 0], inner[:, -1]
        if is_framed and all(_is_plain(edge) for edge in edges):
            return inner, ["What is around the frame of the grid is left out."]
        cells = [margin / cell[side // 2] for side, margin in enumerate(margins)]
        is_whole = all(abs(number - round(number)) < _WHOLE for number in cells)
        if not is_framed and not is_whole and max(colours.shape) > MAX_UNTOLD:
            return inner, ["The plain border is left out, with any plain rows beside it."]
    return colours, []


def _is_plain(line: Array) -> bool:
    """Say whether a line of pixels has one colour, but for its corners."""
    away = np.abs(line - np.median(line, axis=0)).max(axis=1)
    return bool((away < _NOISE).mean() > _LINE)


def _span(colours: Array, axis: int, is_line: bool) -> tuple[int, int]:
    """First and last change along an axis, of all or of those that go on across the picture."""
    changes = np.abs(np.diff(colours, axis=axis)).sum(axis=2)
    across = (changes > 0.2 * changes.max(initial=0)).mean(axis=1 - axis)
    at = np.flatnonzero(across > (0.5 * across.max(initial=0) if is_line else 0))
    return (int(at[0]) + 1, int(at[-1]) + 1) if at.size else (0, 0)


def _cells_along(changes: Array) -> int:
    """The smallest number of equal cells whose borders explain the changes along an axis, or 0.

    ``changes`` are those between each pixel and the next. A few may be noise, unless more cells
    explain them, too.
    """
    count = _smallest_count(changes, 1, 0.95)
    return (count and _smallest_count(changes, count, 0.995)) or count


def _smallest_count(changes: Array, step: int, share: float) -> int:
    """The smallest multiple of a number of cells that explains a share of the changes, or 0.

    The picture may be longer than its cells by a line, which is cut off in part at its beginning.
    """
    length = len(changes) + 1
    total = float(changes.sum())
    if total == 0:
        return 0
    sums = np.concatenate([[0.0, 0.0], np.cumsum(changes)])  # before pixel 0 … length
    for count in range(max(step, 2), min(MAX_STITCHES_PER_SIDE, length // 3) + 1, step):
        reach = max(1, round(length / count * 0.08))
        for begin, line in (
            (0, 0),
            (0, reach),
            (0, 2 * reach),
            (reach / 2, reach),
            (reach, 2 * reach),
        ):
            borders = begin + np.arange(count + 1) * (length - line) / count
            at = np.floor(borders + 0.5).astype(np.intp)
            first, last = np.maximum(at - reach, 0), np.minimum(at + reach, length - 1)
            explained = float((sums[last + 1] - sums[first]).sum())
            if explained > share * total and int((last - first + 1).sum()) < 0.75 * length:
                return count
    return 0


def _cells(colours: Array, rows: int, columns: int) -> Array:
    """The mean colour of the middle of each cell, (rows, columns, 3): a drawn grid has no part."""
    height, width = colours.shape[:2]
    if (rows, columns) == (height, width):
        return colours
    sums = np.zeros((height + 1, width + 1, 3))
    sums[1:, 1:] = colours.cumsum(axis=0).cumsum(axis=1)
    (y0, y1), (x0, x1) = _middles(height, rows), _middles(width, columns)
    y0, y1 = y0[:, None], y1[:, None]
    total = sums[y1, x1] - sums[y0, x1] - sums[y1, x0] + sums[y0, x0]
    return np.asarray(total / ((y1 - y0) * (x1 - x0))[..., None])


def _middles(length: int, count: int) -> tuple[Indices, Indices]:
    """First and last pixel of the middle half of each cell."""
    starts, size = np.arange(count) * length / count, length / count
    first = np.floor(starts + size / 4).astype(np.intp)
    return first, np.maximum(first + 1, np.floor(starts + 3 * size / 4).astype(np.intp))


def _purls(cells: Array, reading: PictureReading) -> tuple[Mask, list[str]]:
    """The darker of the two groups of cells, or the lighter one if that is asked, and notes."""
    tones = cells @ _LUMINANCE
    if reading.dark_below is not None:
        return (tones < reading.dark_below) != reading.light_is_purl, []
    dark, share = _two_groups(cells, tones)
    if share == 0:
        return _one_colour(tones, reading)
    light_mean, dark_mean = cells[~dark].mean(axis=0), cells[dark].mean(axis=0)
    notes = []
    if float(dark_mean @ _LUMINANCE) > _PLAIN_DARK or float(light_mean @ _LUMINANCE) < _PLAIN_LIGHT:
        knit, purl, which = _name(light_mean), _name(dark_mean), "darker"
        if reading.light_is_purl:
            knit, purl, which = purl, knit, "lighter"
        notes.append(f"{knit} is read as knit, the {which} {purl} as purl.")
    if share < _CLEAR:
        notes.append("The picture has more than two clear tones: compare the chart with it.")
    return dark != reading.light_is_purl, notes


def _two_groups(cells: Array, tones: Array) -> tuple[Mask, float]:
    """The darker of two groups of cells, and the variance that they explain; 0 for one colour."""
    dark, share = _darker(tones)
    if share < _CLEAR:
        values = cells.reshape(-1, 3)
        axis = np.linalg.eigh(np.cov(values.T))[1][:, -1] if len(values) > 1 else _LUMINANCE
        other, other_share = _darker(cells @ axis)
        if other_share > share:
            dark, share = other, other_share
            if tones[dark].mean() > tones[~dark].mean():
                dark = ~dark
    if share == 0 or not dark.any() or dark.all():
        return dark, 0.0
    apart = float(np.abs(cells[dark].mean(axis=0) - cells[~dark].mean(axis=0)).max())
    return dark, share if share >= _CLEAR or apart >= _NOISE else 0.0


def _darker(values: Array) -> tuple[Mask, float]:
    """Where values are below the threshold that parts them best, and the variance it explains.

    Otsu, IEEE Trans. Syst. Man Cybern. 9 (1979) 62, without bins.
    """
    sorted_values = np.sort(values, axis=None)
    count = len(sorted_values)
    variance = float(sorted_values.var()) * count
    if variance <= 1e-12 * count * (1 + float(np.abs(sorted_values).max()) ** 2):
        return np.zeros(values.shape, dtype=bool), 0.0
    below = np.arange(1, count)
    sums = np.cumsum(sorted_values)
    gap = sums[:-1] / below - (sums[-1] - sums[:-1]) / (count - below)
    between = below * (count - below) / count * gap**2
    between[sorted_values[1:] == sorted_values[:-1]] = 0
    best = int(np.argmax(between))
    return np.asarray(values <= sorted_values[best]), float(between[best]) / variance


def _one_colour(tones: Array, reading: PictureReading) -> tuple[Mask, list[str]]:
    is_dark = float(tones.mean()) < 128
    is_purl = is_dark != reading.light_is_purl
    kind = f"{'purls' if is_purl else 'knits'}: it is {'dark' if is_dark else 'light'}"
    note = f"The picture has one colour, so all stitches are {kind}."
    return np.full(tones.shape, is_purl), [note]


def _name(colour: Array) -> str:
    return "#" + "".join(f"{min(max(round(float(c)), 0), 255):02x}" for c in colour)


def _damaged(name: str) -> InputError:
    return InputError("chart", f"{name} is damaged.", "Export it again as PNG.")


def _own_stitches(index: Indices, text: str, name: str) -> SymbolChart:
    """The chart of other stitches of a picture that this library wrote."""
    try:
        kinds = [BY_CODE[code] for code in json.loads(text)]
    except (ValueError, TypeError, KeyError):
        raise _damaged(name) from None
    check_chart_size(*index.shape)
    if index.max() >= len(kinds):
        raise _damaged(name)
    cells = np.full(index.shape, CONTINUED, dtype=np.int16)
    for row, line in enumerate(index):
        column = 0
        while column < len(line):
            cells[row, column] = kinds[line[column]]
            column += STITCHES[cells[row, column]].width
    return SymbolChart(cells)


def _own(index: Indices, text: str, name: str) -> Piece:
    """The piece of a picture that this library wrote."""
    damaged = _damaged(name)
    try:
        yarns = tuple(PieceYarn(str(yarn), str(colour)) for yarn, colour in json.loads(text))
    except (ValueError, TypeError):
        raise damaged from None
    check_chart_size(*index.shape)
    if index.max() > 2 * len(yarns):
        raise damaged
    stitch = index > 0
    purl = stitch & (index % 2 == 0)
    return Piece(ShapedChart(StitchChart(purl), stitch), yarns, np.maximum(index - 1, 0) // 2)
