"""For notebooks: interactive figures, a view in space, and an editor for charts.

Needs the extra ``knitcore[notebook]`` (plotly, anywidget). Charts, materials, answers, curves,
relaxed cells, swatches and curled pieces display without it.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from knitcore.notebook.editor import ChartEditor
    from knitcore.notebook.figures import figure
    from knitcore.notebook.space import view

__all__ = ["ChartEditor", "figure", "view"]

_HOMES = {"ChartEditor": "editor", "figure": "figures", "view": "space"}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'knitcore.notebook' has no attribute {name!r}")
    return getattr(import_module(f"knitcore.notebook.{_HOMES[name]}"), name)
