"""The command of a batch that keeps its finished results, so that it can be resumed."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TypeVar

from knitcore.base.batch import run_batch
from knitcore.yarn.library.characterise import Document
from scripts.stored_stitches import tell

Task = TypeVar("Task")


def resumable(
    prog: str,
    keep: str,
    function: Callable[[Task], Document],
    tasks: Callable[[], Mapping[str, Task]],
    pack: Callable[[Path], int],
) -> None:
    """Read the options; then call a function for every task, or pack what is finished.

    Parameters
    ----------
    prog : the command, as help shows it.
    keep : folder of finished results, unless an option names another.
    function, tasks : see :func:`knitcore.base.batch.run_batch`.
    pack : packs the results of a folder and returns how many there are.
    """
    parser = argparse.ArgumentParser(prog=prog)
    parser.add_argument("--keep", type=Path, default=Path(keep))
    parser.add_argument("--scheduler", help="address of a Dask cluster, tcp://host:port")
    parser.add_argument("--workers", type=int, help="processes, all cores if left out")
    parser.add_argument("--pack", action="store_true", help="only pack what is finished")
    chosen = parser.parse_args()
    if chosen.pack:
        sys.stderr.write(f"{pack(chosen.keep)} packed\n")
        return
    run_batch(
        function, tasks(), scheduler=chosen.scheduler, workers=chosen.workers, keep=chosen.keep,
        progress=tell,
    )  # fmt: skip
