"""Stress-strain curves, yarn and cloth in space, as plotly figures."""

from functools import singledispatch
from typing import Any

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.showing import INKS
from knitcore.chart.fabric import Direction
from knitcore.cloth.flat.strip_results import StripTest
from knitcore.cloth.space.curl import CurledPiece
from knitcore.draw.tubes import tube_mesh
from knitcore.prediction.curve import ChartCurve
from knitcore.prediction.prediction import SHOWN_STRESS_N_PER_MM, Prediction
from knitcore.yarn.model.relaxed_cell import RelaxedCell, Sweep

YARN, CLOTH = "#d9b48a", "#c7a77f"
SIDES = 8


def plotly_objects() -> Any:
    """Import ``plotly.graph_objects``.

    Raises
    ------
    ModuleNotFoundError
        If plotly is not installed; the message says how to install it.
    """
    try:
        from plotly import graph_objects
    except ModuleNotFoundError:
        raise ModuleNotFoundError(
            "Figures need plotly. Install it with: pip install 'knitcore[notebook]'", name="plotly"
        ) from None
    return graph_objects


@singledispatch
def figure(of: object) -> Any:
    """The stress-strain curves of a prediction, a curve, a sweep or a strip test, for plotly.

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    TypeError
        For anything else.
    ModuleNotFoundError
        If plotly is not installed.
    """
    raise TypeError(
        f"{type(of).__name__} has no stress-strain curve; "
        "give a prediction, a curve, a sweep or a strip test"
    )


@figure.register
def _(of: Prediction) -> Any:
    stress = np.linspace(0.0, SHOWN_STRESS_N_PER_MM, 61)
    drawn = _empty(f"{of.provenance}, with 90 % intervals")
    for direction, ink in zip(Direction, INKS, strict=True):
        along = of.along(direction)
        _add(drawn, str(direction), along.strain(stress), stress, ink)
        _add_band(drawn, *along.strain_interval(stress), stress, ink)
    return drawn


@figure.register
def _(of: ChartCurve) -> Any:
    drawn = _empty(f"{of.provenance}, with its 90 % interval")
    _add(drawn, str(of.provenance), of.strain, of.stress_n_per_mm, INKS[0])
    _add_band(drawn, of.strain_low, of.strain_high, of.stress_n_per_mm, INKS[0])
    return drawn


@figure.register
def _(of: Sweep) -> Any:
    drawn = _empty(f"pulled {of.direction}-wise at the yarn level")
    _add(drawn, str(of.direction), of.strain, of.stress_n_per_mm, INKS[0])
    return drawn


@figure.register
def _(of: StripTest) -> Any:
    drawn = _empty("Simulated strip test (geometry after ISO 20932-1), not a certified test")
    name, start = f"simulated, {of.sheet.model.energy}", np.zeros(1)
    strain, stress = (np.append(start, v) for v in (of.strain, of.stress_n_per_mm))
    _add(drawn, name, strain, stress, INKS[0])
    return drawn


def _empty(title: str) -> Any:
    go = plotly_objects()
    drawn = go.Figure()
    drawn.update_layout(title=title, xaxis_title="strain", yaxis_title="stress (N/mm)")
    return drawn


def _add(drawn: Any, name: str, strain: Array, stress: Array, ink: str) -> None:
    drawn.add_scatter(x=strain, y=stress, name=name, line={"color": ink})


def _add_band(drawn: Any, low: Array, high: Array, stress: Array, ink: str) -> None:
    drawn.add_scatter(
        x=np.append(low, high[::-1]),
        y=np.append(stress, stress[::-1]),
        fill="toself",
        fillcolor=ink,
        opacity=0.2,
        line={"width": 0},
        hoverinfo="skip",
        showlegend=False,
    )


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
        f"{type(of).__name__} has no shape in space; give a relaxed cell or a curled piece"
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
    return _in_space(drawn)


@view.register
def _(of: CurledPiece) -> Any:
    go = plotly_objects()
    x, y, z = np.moveaxis(of.corners_mm, -1, 0)
    scale = [[0, CLOTH], [1, CLOTH]]
    drawn = go.Figure(go.Surface(x=x, y=y, z=z, showscale=False, colorscale=scale))
    return _in_space(drawn)


def _in_space(drawn: Any) -> Any:
    axes = {f"{axis}axis_title": f"{axis} (mm)" for axis in "xyz"}
    drawn.update_scenes(aspectmode="data", **axes)
    drawn.update_layout(margin={"l": 0, "r": 0, "t": 0, "b": 0})
    return drawn
