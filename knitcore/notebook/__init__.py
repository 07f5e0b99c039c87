"""Interactive figures and a view in space, for notebooks.

Needs the extra ``knitcore[notebook]`` (plotly). Charts, materials, predictions, curves,
relaxed cells, swatches and curled pieces display without it.
"""

from knitcore.notebook.figures import figure, view

__all__ = ["figure", "view"]
