"""The 3D view: time from a request to the messages sent, and bytes of a stretch.

    .venv/bin/python benchmarks/view.py

Prints one line for each figure with its target; times are CPU time, median of five runs.
"""

from __future__ import annotations

import contextlib
import io
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

import numpy as np
import zstandard

from app.context import Context
from app.drawing.design_view import StretchStep, ViewRequest, build_scene
from app.models.stretched import StretchView
from app.operations.stretch import StretchRequest, stretch
from app.viewer.views import View, new_view
from knitcore.chart import StitchChart

HERE = Context(Path())
RUNS = 5


def patterned(rows: int, columns: int) -> str:
    """A chart with all four fabrics in it."""
    row, column = np.indices((rows, columns))
    quarter = 2 * (row >= rows // 2) + (column >= columns // 2)
    purl = np.choose(quarter, [0 * row, row % 2, column % 2, (row + column) % 2])
    return StitchChart(purl.astype(bool)).text


def sent_bytes(view: View, work: Callable[[], object]) -> int:
    """Bytes of all messages that some work sends to one browser, compressed as on the wire."""
    connection = view.server._websock_server
    recorder = connection.get_message_serializer(filter=lambda message: True)
    work()
    buffers = sum(buffer.nbytes for buffer in recorder._binary_buffers)
    packed = len(zstandard.ZstdCompressor(level=1).compress(b"".join(recorder._binary_buffers)))
    recorder.serialize()
    return min(buffers, packed)


def first_scene_s(rows: int, columns: int) -> float:
    """CPU time from a request to a scene whose messages are in the hands of the connection."""
    request = ViewRequest(chart=patterned(rows, columns), material="acrylic", colour="course")
    view = new_view()
    try:
        start = time.process_time()
        view.show(build_scene(request, None, HERE).drawing())
        return time.process_time() - start
    finally:
        view.server.stop()


def stretch_bytes() -> tuple[int, float]:
    """Bytes and CPU time of the 20 frames of a stretched 32 x 32 chart."""
    chart = patterned(32, 32)
    asked = {"chart": chart, "material": "acrylic"}
    test = StretchRequest(**asked, direction="wale", strain=0.3, steps=20)
    run = stretch(test, HERE).view
    assert isinstance(run, StretchView)
    view = new_view()

    def frame(step: int) -> None:
        at = StretchStep(id="test", step=step)
        shown = ViewRequest(**asked, colour="strain", stretch=at)
        view.show(build_scene(shown, run, HERE).drawing())

    def play() -> None:
        for step in range(20):
            frame(step)

    try:
        frame(0)
        start = time.process_time()
        total = sent_bytes(view, play)
        return total, time.process_time() - start
    finally:
        view.server.stop()


def main() -> None:
    """Print the figures."""
    with contextlib.redirect_stdout(io.StringIO()):  # viser prints a message on start and stop
        build_scene(ViewRequest(chart="KP\nPK", material="acrylic"), None, HERE)
        scenes = {n: median(first_scene_s(n, n) for _ in range(RUNS)) for n in (32, 100, 200)}
        total, seconds = stretch_bytes()
    for side, value in scenes.items():
        target = " (at most 0.4 s)" if side == 100 else ""
        print(f"request to sent, {side} x {side}: {value:.3f} s CPU{target}")
    print(
        f"stretch of 32 x 32, 20 frames: {total / 1e6:.2f} MB (at most 1 MB), {seconds:.2f} s CPU"
    )


if __name__ == "__main__":
    main()
