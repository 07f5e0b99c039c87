"""Loads what workers need, and compiles it on the very first start.

Only the process that workers are forked from imports this module, once.
"""

from __future__ import annotations

from pathlib import Path

from app.compute.processes import be_nice


def _load() -> None:
    be_nice()  # the first page comes before this
    from app.models.charts import PureFabricChart
    from app.operations.context import Context
    from app.operations.stretch import StretchRequest, stretch

    stretch(
        StretchRequest(
            chart=PureFabricChart(fabric="garter", columns=3, rows=3),
            material="acrylic",
            direction="wale",
            strain=0.1,
            steps=1,
        ),
        Context(Path()),
    )


_load()
