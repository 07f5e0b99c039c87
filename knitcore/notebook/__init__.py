"""Interactive figures and a view in space, for notebooks.

Needs the extra ``knitcore[notebook]`` (plotly). Charts, materials, predictions, curves,
relaxed cells, swatches and curled pieces display without it.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from knitcore.notebook.figure_in_space import view
    from knitcore.notebook.result_figures import figure

__all__ = ["figure", "view"]

_HOMES = {"figure": "result_figures", "view": "figure_in_space"}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'knitcore.notebook' has no attribute {name!r}")
    return getattr(import_module(f"knitcore.notebook.{_HOMES[name]}"), name)
