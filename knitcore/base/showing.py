"""Small pictures and tables in HTML, with which notebooks display results.

SVG and tables without scripts, fonts or addresses. Lines and text have the colour of the page
around them, light or dark. Objects use them in ``_repr_html_``.
"""

from collections.abc import Iterable, Sequence
from html import escape
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array, Mask

INKS = ("#3f74b5", "#d98032")
"""Colours of the first and the second curve."""
MAX_CELLS = 80
"""Largest number of rows or columns of a chart that is drawn."""
WIDTH, HEIGHT = 300, 200
_LEFT, _BOTTOM, _RIGHT, _TOP = 46, 34, 10, 22


def svg(width: float, height: float, title: str, parts: Iterable[str]) -> str:
    """An SVG picture of a size in pixels; ``title`` is read to those who cannot see it."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" '
        f'viewBox="0 0 {width:.0f} {height:.0f}" role="img" style="max-width:100%;height:auto">'
        f"<title>{escape(title)}</title>{''.join(parts)}</svg>"
    )


def captioned(picture: str, *lines: str) -> str:
    """A picture or table with lines of text below it."""
    caption = "".join(f"<div>{escape(line)}</div>" for line in lines if line)
    return f'<figure style="margin:0">{picture}<figcaption>{caption}</figcaption></figure>'


def beside(*parts: str) -> str:
    """Pictures and tables beside each other where there is room."""
    return f'<div style="display:flex;flex-wrap:wrap;gap:1.5em">{"".join(parts)}</div>'


def html_table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table; the first cell of a row is its head."""
    lines = [f"<tr>{''.join(f'<th>{escape(cell)}</th>' for cell in head)}</tr>"]
    for first, *others in rows:
        cells = "".join(f"<td>{escape(str(cell))}</td>" for cell in others)
        lines.append(f"<tr><th>{escape(str(first))}</th>{cells}</tr>")
    return f"<table>{''.join(lines)}</table>"


def stitches(purl: Mask, inside: Mask | None = None) -> str:
    """A chart: knits are light, purls dark with a dash; the bottom row is row 0.

    Parameters
    ----------
    purl : bool (rows, columns).
    inside : bool (rows, columns), where there are stitches; everywhere by default.
    """
    rows, columns = (min(n, MAX_CELLS) for n in purl.shape)
    there = np.ones_like(purl) if inside is None else inside
    cell = float(np.clip(480 / max(rows, columns), 4, 18))
    knits, purls, dashes = "", "", ""
    for row in range(rows):
        y = cell * (rows - 1 - row)
        for column in np.flatnonzero(there[row, :columns]).tolist():
            box = f"M{cell * column:g} {y:g}h{cell:g}v{cell:g}h-{cell:g}z"
            if purl[row, column]:
                purls += box
                dashes += f"M{cell * (column + 0.25):g} {y + cell / 2:g}h{cell / 2:g}"
            else:
                knits += box
    line = 'stroke="#857b70" stroke-width=".5"'
    parts = [
        f'<path d="{knits}" fill="#fbf8f2" {line}/>',
        f'<path d="{purls}" fill="#cbbfae" {line}/>',
        f'<path d="{dashes}" stroke="#4a4238" stroke-width="{cell / 9:.2g}"/>',
    ]
    title = f"Chart of {columns} columns and {rows} rows"
    return svg(cell * columns + 1, cell * rows + 1, title, parts)


def rectangles(drawn: Sequence[tuple[str, float, float]], unit: str) -> str:
    """Rectangles by their name, width and height, to one scale, around one centre."""
    most = max(max(width, height) for _, width, height in drawn)
    scale, middle = 120 / most, 70.0
    parts = []
    for (_, width, height), ink in zip(drawn, INKS, strict=False):
        w, h = width * scale, height * scale
        parts.append(
            f'<rect x="{middle - w / 2:.1f}" y="{middle - h / 2:.1f}" width="{w:.1f}" '
            f'height="{h:.1f}" fill="{ink}" fill-opacity=".25" stroke="{ink}"/>'
        )
    caption = "; ".join(f"{name} {w:.3g} × {h:.3g} {unit}".strip() for name, w, h in drawn)
    return svg(2 * middle, 2 * middle, caption, parts)


def curves(
    drawn: Sequence[tuple[str, ArrayLike, ArrayLike, tuple[ArrayLike, ArrayLike] | None]],
    x_name: str,
    y_name: str,
) -> str:
    """Curves with their names: x, y, and the low and high ends of x at each y, or None."""
    lines = [(name, np.asarray(x, float), np.asarray(y, float), ends) for name, x, y, ends in drawn]
    right = max(float(np.nanmax(x)) for _, x, _, _ in lines) or 1.0
    top = max(float(np.nanmax(y)) for _, _, y, _ in lines) or 1.0
    wide, high = WIDTH - _LEFT - _RIGHT, HEIGHT - _BOTTOM - _TOP

    def path(x: Array, y: Array) -> str:
        places = zip(
            _LEFT + wide * np.clip(x / right, 0, 1), _TOP + high * (1 - y / top), strict=True
        )
        return "M" + "L".join(f"{a:.1f} {b:.1f}" for a, b in places)

    parts = [f'<path d="M{_LEFT} {_TOP}v{high}h{wide}" fill="none" stroke="currentColor"/>']
    names = ""
    for index, (name, x, y, ends) in enumerate(lines):
        ink = INKS[index % len(INKS)]
        if ends is not None:
            low, soft = np.asarray(ends[0], float), np.asarray(ends[1], float)
            band = path(np.append(low, soft[::-1]), np.append(y, y[::-1]))
            parts.append(f'<path d="{band}z" fill="{ink}" fill-opacity=".18"/>')
        parts.append(f'<path d="{path(x, y)}" fill="none" stroke="{ink}" stroke-width="2"/>')
        names += f'<tspan dx="8" fill="{ink}">{escape(name)}</tspan>'
    texts = [
        (_LEFT, HEIGHT - _BOTTOM + 14, "start", "0"),
        (_LEFT + wide, HEIGHT - _BOTTOM + 14, "end", f"{right:.3g}"),
        (_LEFT + wide / 2, HEIGHT - 4, "middle", escape(x_name)),
        (_LEFT - 4, _TOP + 9, "end", f"{top:.3g}"),
        (_LEFT, 12, "start", escape(y_name) + names),
    ]
    parts += [
        f'<text x="{x:.0f}" y="{y:.0f}" text-anchor="{anchor}" font-size="11" '
        f'fill="currentColor">{text}</text>'
        for x, y, anchor, text in texts
    ]
    caption = " and ".join(name for name, *_ in lines)
    return svg(WIDTH, HEIGHT, f"{y_name} over {x_name}: {caption}", parts)


def net(lines: Sequence[Array], title: str) -> str:
    """Lines in the plane, (points, 2), to scale."""
    points = np.concatenate(lines)
    low, extent = points.min(axis=0), np.maximum(np.ptp(points, axis=0), 1e-9)
    scale = 240 / float(max(extent))
    drawn = ""
    for line in lines:
        places = ((line - low) * (scale, -scale) + (1.0, float(extent[1]) * scale + 1.0)).tolist()
        drawn += "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in places)
    part = f'<path d="{drawn}" fill="none" stroke="currentColor" stroke-width=".6"/>'
    return svg(float(extent[0]) * scale + 2, float(extent[1]) * scale + 2, title, [part])


def in_space(lines: Sequence[Array], title: str, *, thickness: float, tilt: float) -> str:
    """Lines in space (points, 3), seen from above the face; what is nearer is drawn later.

    Parameters
    ----------
    lines : in mm, z towards the viewer.
    title : of the picture.
    thickness : of the lines, mm.
    tilt : how far the view is turned about the courses, rad.
    """
    turn = np.array([[1, 0, 0], [0, np.cos(tilt), np.sin(tilt)], [0, -np.sin(tilt), np.cos(tilt)]])
    turned = [np.asarray(line, float) @ turn.T for line in lines]
    points = np.concatenate(turned)
    low, extent = points.min(axis=0) - thickness, np.ptp(points, axis=0) + 2 * thickness
    scale = 280 / max(extent[0], extent[1])
    shade = max(float(extent[2]), 1e-9)
    width = max(thickness * scale, 0.6)
    pieces = []
    for line in turned:
        x = (line[:, 0] - low[0]) * scale
        y = (low[1] + extent[1] - line[:, 1]) * scale
        step = max(1, len(line) // 120)
        cuts = [*range(0, len(line) - 1, step), len(line) - 1]
        for a, b in pairwise(cuts):
            depth = float(line[[a, b], 2].mean())
            light = int(90 + 130 * (depth - low[2]) / shade)
            colour = f"rgb({min(light + 25, 255)},{light},{int(light * 0.8)})"
            drawn = f'<path d="M{x[a]:.1f} {y[a]:.1f}L{x[b]:.1f} {y[b]:.1f}" stroke="{colour}"/>'
            pieces.append((depth, drawn))
    pieces.sort(key=lambda piece: piece[0])
    group = f'<g stroke-linecap="round" stroke-width="{width:.2f}">'
    parts = [group, *(drawn for _, drawn in pieces), "</g>"]
    return svg(extent[0] * scale, extent[1] * scale, title, parts)
