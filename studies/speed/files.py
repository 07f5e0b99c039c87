"""Files and garments: CPU time, and whether written files are read back the same.

    python -m studies.speed.files [--large]

Prints CPU seconds with each target. ``--large`` also knits 200 x 200 stitches on the virtual
machine, which takes minutes.
"""

import argparse
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from knitcore import StitchChart, predict
from knitcore.chart.fabric import Fabric
from knitcore.formats.designs.garment_design import design_of_plan
from knitcore.formats.read.chart_files import read_noted_chart
from knitcore.formats.write.export import FORMATS, ExportKind, ExportOptions, export_chart
from knitcore.garment.gauge import Gauge, GaugeSet
from knitcore.garment.glove import Hand, glove
from knitcore.materials import material

WOOL = material("glove-wool:glove")
READ_BACK = (
    ExportKind.TEXT,
    ExportKind.PNG,
    ExportKind.WRITTEN,
    ExportKind.KNITSPEAK,
    ExportKind.DESIGN,
)


def timed(work: Callable[[], Any]) -> tuple[Any, float]:
    """The result of a function, and the CPU seconds that it took."""
    start = time.process_time()
    return work(), time.process_time() - start


def there_and_back(chart: StitchChart, kind: ExportKind) -> bool:
    """Tell whether a chart comes back from a file."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"chart{FORMATS[kind].suffix}"
        file.write_bytes(export_chart(chart, kind, WOOL).content)
        return read_noted_chart(file)[0] == chart


def small_glove() -> tuple[int, int, float, dict[str, float]]:
    """A glove of about 60 x 80 stitches: columns, rows, seconds to plan and predict, and to export.

    The gauge is coarser than the paper's, so that an adult's hand takes no more stitches.
    """
    own = GaugeSet.of_material(WOOL)[Fabric.STOCKINETTE]
    coarse = Gauge(own.stitch_course_mm * 1.33, own.stitch_wale_mm * 1.85)
    gauges = GaugeSet.of_material(WOOL, coarse)

    def plan() -> Any:
        design = design_of_plan(glove(Hand(), WOOL, gauges=gauges), WOOL.identifier, intarsia=True)
        predict(design.to_chart(), WOOL)
        return design

    design, seconds = timed(plan)
    chart = design.to_chart()
    options = ExportOptions(layout=design, name=design.name, note=design.note)
    kinds = [k for k in ExportKind if k not in (ExportKind.TEXT, ExportKind.KNITSPEAK)]
    exports = {
        kind.value: timed(partial(export_chart, chart, kind, WOOL, options))[1] for kind in kinds
    }
    return chart.columns, chart.rows, seconds, exports


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--large", action="store_true", help="knit 200 x 200 on the machine, too")
    large = parser.parse_args().large
    random = np.random.default_rng(7)

    small = StitchChart(random.random((32, 32)) < 0.5)
    same, seconds = timed(partial(there_and_back, small, ExportKind.KNITOUT))
    print(f"knitout 32 x 32, written, verified, read again: {seconds:.1f} s (target 5 s), {same=}")

    chart = StitchChart(random.random((200, 200)) < 0.5)
    for kind in READ_BACK:
        same, seconds = timed(partial(there_and_back, chart, kind))
        print(f"{kind} 200 x 200 there and back: {seconds:.2f} s, {same=}")

    columns, rows, planned, exports = small_glove()
    total = planned + sum(exports.values())
    print(f"glove {columns} x {rows}: planned, filled, predicted in {planned:.2f} s")
    print("  " + ", ".join(f"{kind} {seconds:.2f} s" for kind, seconds in exports.items()))
    print(f"  all of it {total:.1f} s (target 10 s)")

    if large:
        same, seconds = timed(partial(there_and_back, chart, ExportKind.KNITOUT))
        print(f"knitout 200 x 200, written, verified, read again: {seconds:.0f} s, {same=}")


if __name__ == "__main__":
    main()
