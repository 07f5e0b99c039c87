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

from knitcore.answer.chart_curve import chart_curve
from knitcore.answer.composite import layout_of
from knitcore.answer.relaxed import RelaxedSize, SizeSource, carried_over, reference_fabric
from knitcore.chart import StitchChart
from knitcore.errors import KnitcoreError
from knitcore.fabric import Direction, Fabric
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials import Material, material
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
    kind = layout_of(chart) or "2-D"
    if kind == "2-D" and name != "flat":
        return
    for direction in Direction:
        own = free_strains_at_stress(stored.law, direction, STRESS)
        try:
            if name == "flat":
                predicted = _flat(chart, yarn, direction)
            else:
                predicted = chart_curve(chart, yarn, direction, STRESS, relaxed=size).strain
        except KnitcoreError:
            continue
        missed[str(kind), str(direction), name].append(np.log(predicted / own))


def _flat(chart: StitchChart, yarn: Material, direction: Direction):
    from knitcore.mechanics.repeat_curve import repeat_curve_at_stress

    return repeat_curve_at_stress(chart, yarn, direction, STRESS).strain


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
    like = pure[reference_fabric(chart)]
    shorter = like.loop_length_mm / twin.loop_length_mm
    ratio = (
        twin.cell_course_mm / like.cell_course_mm * shorter,
        twin.cell_wale_mm / like.cell_wale_mm * shorter,
    )
    return carried_over(ratio, {reference_fabric(chart): (1.0, 1.0)}, chart, yarn)


if __name__ == "__main__":
    main()
