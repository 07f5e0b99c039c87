"""Figures of a test, after the paper's Fig. 4, for plotly."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.cloth.flat.fields import Fields
from knitcore.cloth.flat.strip_results import SwatchTest

MAX_PATCHES = 20_000
EXTENSION_COLOUR, CONTRACTION_COLOUR = "#b2182b", "#2166ac"


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


def displacement_figure(test: SwatchTest, step: int = -1, component: str = "x") -> Any:
    """A displacement component (mm) in colour on the deformed shape.

    Parameters
    ----------
    test : any test with at least one step.
    step : which step.
    component : ``x`` (along the courses, as in the paper) or ``y``.
    """
    go = plotly_objects()
    fields = test.fields(step)
    value = fields.ux_mm if component == "x" else fields.uy_mm
    x, y = fields.x_mm + fields.ux_mm, fields.y_mm + fields.uy_mm
    top = float(np.nanmax(np.abs(value))) or 1.0
    stride = max(1, int(np.ceil(np.sqrt(value.size / MAX_PATCHES))))
    kept = (_kept(value.shape[0], stride)[:, None], _kept(value.shape[1], stride))
    figure = go.Figure(
        go.Carpet(
            a=np.arange(kept[1].size),
            b=np.arange(kept[0].size),
            x=x[kept],
            y=y[kept],
            aaxis={"showticklabels": "none", "showgrid": False},
            baxis={"showticklabels": "none", "showgrid": False},
            carpet="cloth",
        )
    )
    a, b = np.meshgrid(np.arange(kept[1].size), np.arange(kept[0].size))
    figure.add_trace(
        go.Contourcarpet(
            a=a.ravel(),
            b=b.ravel(),
            z=value[kept].ravel(),
            carpet="cloth",
            colorscale="RdBu_r",
            zmin=-top,
            zmax=top,
            line={"width": 0},
            contours={"coloring": "fill"},
            ncontours=40,
            colorbar={"title": f"u_{component} (mm)"},
        )
    )
    return _laid_out(figure, f"Displacement u_{component} on the deformed shape")


def strain_crosses_figure(test: SwatchTest, step: int = -1, crosses: int = 400) -> Any:
    """Crosses of the principal strains on the deformed shape: red extension, blue contraction."""
    go = plotly_objects()
    fields = test.fields(step)
    figure = go.Figure()
    for sign, colour, name in (
        (1, EXTENSION_COLOUR, "extension"),
        (-1, CONTRACTION_COLOUR, "contraction"),
    ):
        x, y = _arms(fields, crosses, sign)
        figure.add_trace(
            go.Scattergl(x=x, y=y, mode="lines", line={"color": colour, "width": 1.5}, name=name)
        )
    x, y = fields.x_mm + fields.ux_mm, fields.y_mm + fields.uy_mm
    figure.add_trace(
        go.Scatter(
            x=_rim(x), y=_rim(y), mode="lines", line={"color": "#777", "width": 1}, name="edge"
        )
    )
    return _laid_out(figure, "Principal strains")


def _arms(fields: Fields, crosses: int, sign: int) -> tuple[Array, Array]:
    """Lines of the crosses' arms with that sign of strain, separated by NaN."""
    rows, columns = fields.x_mm.shape
    stride = max(1, int(np.sqrt(rows * columns / crosses)))
    pick = (slice(stride // 2, None, stride), slice(stride // 2, None, stride))
    x, y = (fields.x_mm + fields.ux_mm)[pick].ravel(), (fields.y_mm + fields.uy_mm)[pick].ravel()
    angle = fields.principal_angle[pick].ravel()
    largest = float(np.nanmax(np.abs(fields.principal_strain))) or 1.0
    spacing = np.hypot(np.diff(x).max(initial=1.0) if len(x) > 1 else 1.0, 0.0)
    lines_x, lines_y = [], []
    for value, turn in zip(fields.principal_strain, (0.0, np.pi / 2), strict=True):
        strain = value[pick].ravel()
        on = strain * sign > 0
        half = 0.5 * spacing * np.abs(strain[on]) / largest
        dx, dy = half * np.cos(angle[on] + turn), half * np.sin(angle[on] + turn)
        gap = np.full(on.sum(), np.nan)
        lines_x.append(np.column_stack([x[on] - dx, x[on] + dx, gap]).ravel())
        lines_y.append(np.column_stack([y[on] - dy, y[on] + dy, gap]).ravel())
    return np.concatenate(lines_x), np.concatenate(lines_y)


def _rim(values: Array) -> Array:
    """Values along the outline, once around."""
    return np.concatenate([values[0], values[:, -1], values[-1, ::-1], values[::-1, 0]])


def _kept(count: int, stride: int) -> NDArray[np.int64]:
    """Indices in strides, the last one included."""
    return np.unique(np.append(np.arange(0, count, stride), count - 1))


def _laid_out(figure: Any, title: str) -> Any:
    figure.update_layout(
        title=title,
        xaxis_title="course direction (mm)",
        yaxis={"title": "wale direction (mm)", "scaleanchor": "x"},
        plot_bgcolor="rgba(0,0,0,0)",
    )
    return figure
