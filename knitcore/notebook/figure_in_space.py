"""Yarn and cloth in space, as plotly figures to turn and zoom."""

from functools import singledispatch
from typing import Any

import numpy as np

from knitcore.cloth.flat.strip_figures import plotly_objects
from knitcore.cloth.space.curl import CurledPiece
from knitcore.draw.tubes import tube_mesh
from knitcore.yarn.model.relaxed_cell import RelaxedCell

YARN, CLOTH = "#d9b48a", "#c7a77f"
SIDES = 8


@singledispatch
def view(of: object) -> Any:
    """A relaxed cell as yarn, four stitches each way, or a curled piece as cloth; for plotly.

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    TypeError
        For anything else.
    """
    raise TypeError(
        f"a {type(of).__name__} has no shape in space; give a relaxed cell or a curled piece"
    )


@view.register
def _(of: RelaxedCell) -> Any:
    go = plotly_objects()
    drawn = go.Figure()
    for line in of.tiled_lines():
        mesh = tube_mesh(line, of.yarn.core_radius_mm, SIDES)
        x, y, z = mesh.vertices.T
        i, j, k = mesh.faces.T
        drawn.add_mesh3d(x=x, y=y, z=z, i=i, j=j, k=k, color=YARN, hoverinfo="skip")
    return _laid_out(drawn)


@view.register
def _(of: CurledPiece) -> Any:
    go = plotly_objects()
    x, y, z = np.moveaxis(of.corners_mm, -1, 0)
    scale = [[0, CLOTH], [1, CLOTH]]
    drawn = go.Figure(go.Surface(x=x, y=y, z=z, showscale=False, colorscale=scale))
    return _laid_out(drawn)


def _laid_out(drawn: Any) -> Any:
    axes = {f"{axis}axis_title": f"{axis} (mm)" for axis in "xyz"}
    drawn.update_scenes(aspectmode="data", **axes)
    drawn.update_layout(margin={"l": 0, "r": 0, "t": 0, "b": 0})
    return drawn
