"""Give every chart of the documentation one size, one type, one palette and one file format.

The colours are those of the page (``frontend/styles/tokens.css``), so a fabric has the same colour
in the documentation as on the screen.
"""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
from cycler import cycler
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from knitcore.chart.fabric import Fabric

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "figures"
WIDTH_IN, HEIGHT_IN = 5.8, 3.7
"""Size of a chart that stands alone, inches."""


def _tokens() -> dict[str, str]:
    """Colours of the page in its light theme, by name."""
    styles = (ROOT / "frontend" / "styles" / "tokens.css").read_text(encoding="utf-8")
    return dict(re.findall(r"--([\w-]+): light-dark\((#[0-9a-f]{6}),", styles))


TOKENS = _tokens()
FABRICS = {fabric: TOKENS[fabric] for fabric in Fabric}
"""Colour of each fabric."""
INKS = (*FABRICS.values(), TOKENS["even"])
"""Colours of curves that stand for no fabric, in the order of their use."""
MUTED, PALE = TOKENS["muted"], TOKENS["purl"]
"""Colours of what is drawn for comparison, and of intervals behind points."""

mpl.use("svg")
mpl.rcParams.update(
    {
        "axes.axisbelow": True,
        "axes.edgecolor": TOKENS["line-strong"],
        "axes.grid": True,
        "axes.labelcolor": TOKENS["text"],
        "axes.prop_cycle": cycler(color=INKS),
        "axes.spines.right": False,
        "axes.spines.top": False,
        "axes.titlelocation": "left",
        "axes.titlesize": "medium",
        "axes.titleweight": "bold",
        "figure.constrained_layout.use": True,
        "figure.facecolor": TOKENS["raised"],
        "font.sans-serif": ["DejaVu Sans"],
        "font.size": 10.0,
        "grid.color": TOKENS["pane"],
        "legend.frameon": False,
        "legend.labelcolor": "linecolor",
        "legend.loc": "upper left",
        "lines.linewidth": 1.8,
        "lines.markersize": 4.5,
        "svg.fonttype": "none",
        "svg.hashsalt": "knitcore",
        "text.color": TOKENS["text"],
        "xtick.color": MUTED,
        "ytick.color": MUTED,
    }
)


def chart(x_label: str = "", y_label: str = "", **properties: Any) -> Axes:
    """Axes of a chart that stands alone; ``properties`` are matplotlib's (``xlim``, ``title``)."""
    (axes,) = panels(1, width_in=WIDTH_IN)
    axes.set(xlabel=x_label, ylabel=y_label, **properties)
    return axes


def panels(count: int, *, width_in: float = 4.1) -> list[Axes]:
    """Axes of charts beside each other, each as wide (in inches) as given."""
    _, axes = plt.subplots(1, count, figsize=(width_in * count, HEIGHT_IN), squeeze=False)
    return list(axes[0])


def columns(names: Sequence[str], y_label: str) -> Axes:
    """Axes with a column one wide for each name, the first from 0 to 1."""
    (axes,) = panels(1, width_in=max(WIDTH_IN, 0.9 * len(names)))
    axes.set(ylabel=y_label, xlim=(0, len(names)))
    axes.set_xticks([place + 0.5 for place in range(len(names))], names, fontsize="small")
    axes.tick_params(axis="x", length=0)
    axes.grid(visible=False, axis="x")
    return axes


def diagonal(axes: Axes, label: str = "") -> None:
    """Draw where both values are equal."""
    axes.axline((1, 1), (2, 2), color=MUTED, linestyle="--", linewidth=1, label=label or None)


def level(axes: Axes, value: float) -> None:
    """Draw a value for comparison across the chart."""
    axes.axhline(value, color=MUTED, linestyle="--", linewidth=1)


def logarithmic(axes: Axes, x: Sequence[float], y: Sequence[float]) -> None:
    """Make both axes logarithmic, with plain numbers at these ticks, from the first to the last."""
    axes.set(xscale="log", yscale="log", xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    axes.set_xticks(x, [f"{tick:g}" for tick in x])
    axes.set_yticks(y, [f"{tick:g}" for tick in y])
    axes.minorticks_off()


def name_fabrics(axes: Axes, *more: Any) -> None:
    """Add a legend of the fabrics' colours, then of further lines or points."""
    lines = [Line2D([], [], color=ink, label=str(name)) for name, ink in FABRICS.items()]
    axes.legend(handles=[*lines, *more])


def save(axes: Axes, name: str) -> None:
    """Write the figure that has these axes to ``docs/figures``."""
    path = FOLDER / f"{name}.svg"
    figure = axes.get_figure(root=True)
    assert figure is not None
    figure.savefig(path, metadata={"Date": None, "Creator": None})
    plt.close("all")
    drawn = re.sub(r"(\d\.\d\d)\d{3,}", r"\1", path.read_text(encoding="utf-8"))  # 0.01 pt
    path.write_text(re.sub(r"\s*\n\s*", " ", drawn).strip() + "\n", encoding="utf-8")
