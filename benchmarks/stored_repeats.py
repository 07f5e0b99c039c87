"""The composite against the yarn level, for every repeat of the packaged store.

The composite is made of the store's own pure fabrics, so that only the rule of mixing and its
correction are tested; no repeat's own law enters what is predicted for it. Strain at a stress is
read from the law that was fitted to the repeat's own sweep. Printed are median, 90 % quantile and
worst of the factor by which the strain misses: flat, corrected with the repeat's own relaxed size,
and corrected with the size of the same repeat in the other yarn. Three minutes of CPU time.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

import numpy as np

from knitcore.answer.composite import composite
from knitcore.answer.folded import folded
from knitcore.answer.relaxed import RelaxedSize, SizeSource
from knitcore.answer.repeat import Repeat
from knitcore.chart import StitchChart
from knitcore.fabric import Direction, Fabric
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials import Material, material
from knitcore.phases import reference_fabric
from knitcore.yarnlibrary.store import StoredStitch, stored_charts, stored_stitch

STRESS = np.array([0.03, 0.05, 0.1, 0.2])
YARNS = ("acrylic", "cotton")


def main() -> None:
    """Print the table."""
    pure = {yarn: _pure(yarn) for yarn in YARNS}
    simulated = {yarn: _simulated(yarn, pure[yarn]) for yarn in YARNS}
    missed = defaultdict(list)
    for yarn in YARNS:
        other = YARNS[1 - YARNS.index(yarn)]
        for chart in stored_charts(yarn):
            stored = stored_stitch(chart, yarn)
            if stored is None or stored.law is None or not stored.converged:
                continue
            if chart in {s.chart for s in pure[yarn].values()}:
                continue
            twin = stored_stitch(chart, other)
            sizes = {
                "own size": RelaxedSize(
                    stored.cell_course_mm, stored.cell_wale_mm, SizeSource.YARN_LEVEL
                ),
                "other yarn's": _carried(twin, pure[other], chart, simulated[yarn]),
                "flat": None,
            }
            for name, size in sizes.items():
                if size is None and name != "flat":
                    continue
                _miss(missed, name, chart, stored, simulated[yarn], size)
    print(f"factor by which the strain at {STRESS} N/mm misses: median, 90 %, worst; repeats")
    for (kind, direction, name), factors in sorted(missed.items()):
        logs = np.abs(np.array(factors))
        found = np.round(np.exp(np.quantile(logs, (0.5, 0.9, 1.0), axis=0)), 2)
        print(f"{kind:5} {direction:7} {name:13}", *found, len(logs))


def _miss(missed, name, chart, stored: StoredStitch, yarn: Material, size) -> None:
    repeat = Repeat.of(chart.tile(2, 2))
    if repeat.layout is None and size is not None:
        return
    found = composite(repeat, yarn) if size is None else folded(repeat, yarn, size)
    for direction in Direction:
        own = free_strains_at_stress(stored.law, direction, STRESS)
        predicted = found.along(direction).strain(STRESS)
        missed[str(repeat.layout or "2-D"), str(direction), name].append(np.log(predicted / own))


def _pure(yarn: str) -> dict[Fabric, StoredStitch]:
    return {f: stored_stitch(StitchChart.of_fabric(f, 2, 2).repeat(), yarn) for f in Fabric}


def _simulated(yarn: str, pure: dict[Fabric, StoredStitch]) -> Material:
    """The material whose pure fabrics are those of the store."""
    measured = material(yarn)
    fabrics = {
        fabric: replace(
            measured.record(fabric),
            law=stored.law,
            stitch_course_mm=stored.cell_course_mm,
            stitch_wale_mm=stored.cell_wale_mm,
            loop_length_mm=stored.loop_length_mm,
        )
        for fabric, stored in pure.items()
    }
    return Material(yarn, yarn, measured.yarn, fabrics)


def _carried(twin, pure: dict[Fabric, StoredStitch], chart: StitchChart, yarn: Material):
    if twin is None:
        return None
    like, other = reference_fabric(chart), pure[reference_fabric(chart)]
    shorter = other.loop_length_mm / twin.loop_length_mm
    own, lengths = yarn.record(like), Repeat.of(chart.tile(2, 2))
    mean = sum(lengths.shares[f.phase] * yarn.record(f).loop_length_mm for f in lengths.present)
    scale = shorter * mean / own.loop_length_mm
    return RelaxedSize(
        twin.cell_course_mm / other.cell_course_mm * own.stitch_course_mm * scale,
        twin.cell_wale_mm / other.cell_wale_mm * own.stitch_wale_mm * scale,
        SizeSource.STORE,
    )


if __name__ == "__main__":
    main()
