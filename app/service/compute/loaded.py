"""Loads what workers need, and compiles it on the very first start.

Only the process that workers are forked from imports this module, once.
"""

import os
import threading
from pathlib import Path

import numpy as np

from knitcore.base.loading import loading

from .processes import be_nice

SERVICE = os.getppid()
_loaded = threading.Event()


def _end_with_service() -> None:
    """End this process with the service while it loads; once it waits to fork, it notices alone."""
    while not _loaded.wait(0.5):
        if os.getppid() != SERVICE:
            os._exit(1)


def _load() -> None:
    be_nice()  # the first page comes before this
    from knitcore.chart.fabric import Fabric
    from knitcore.cloth.flat.grid_kernel import respond
    from knitcore.cloth.flat.sheet_models import SheetModel
    from knitcore.materials import material

    from ...context import Context
    from ...operations.cloth.stretch import StretchRequest, stretch
    from ...requests.charts import PureFabricChart

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
    # cut pieces have another mesh, and other compiled code
    laws = SheetModel().parameters([material("acrylic").law(Fabric.GARTER)])
    at_rest = np.eye(2).reshape(1, 4)
    law_of_point = np.zeros(1, dtype=np.int32)
    respond(laws, law_of_point, False, at_rest, np.empty((1, 4)), np.empty((1, 4, 4)))


_watch = threading.Thread(target=_end_with_service, daemon=True)
_watch.start()
try:
    with loading():
        _load()
finally:
    _loaded.set()
    _watch.join()  # a process that forks should have one thread
