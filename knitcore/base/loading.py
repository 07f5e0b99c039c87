"""Loading modules without a search for garbage, which would take a third of the time."""

import contextlib
import gc
from collections.abc import Iterator


@contextlib.contextmanager
def loading() -> Iterator[None]:
    """Load modules in this block; what exists at its end is left out of later searches, too."""
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()
