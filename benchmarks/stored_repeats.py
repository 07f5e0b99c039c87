"""Learned answers against the yarn level, for every repeat of the packaged store.

Each repeat is predicted by a model fitted without it in either yarn, in a material whose pure
fabrics are those of the store, so that only the learned correction is tested. It prints the median,
90 % quantile and worst of the factor by which relaxed size and strain miss the repeat's relaxation
and sweep, and the share inside 90 % intervals, with and without the repeat's relaxed size known.
Two minutes of CPU time.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

import numpy as np

from knitcore.chart import StitchChart
from knitcore.fabric import Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials import Material, Origin, material
from knitcore.materials.uncertainty import Z_SCORE
from knitcore.phases import pure_fabric
from knitcore.prediction.densities import densities
from knitcore.prediction.learned import packaged_model
from knitcore.prediction.size import RelaxedSize
from knitcore.yarnlibrary.store import MATERIALS, StoredStitch, stored_charts, stored_stitch

STRESS = np.array([0.03, 0.05, 0.1, 0.2])


def main() -> None:
    """Print the table."""
    missed: dict[tuple[str, str, str], list[np.ndarray]] = defaultdict(list)
    inside: dict[tuple[str, str, str], list[np.ndarray]] = defaultdict(list)
    for yarn in MATERIALS:
        simulated = _simulated(yarn)
        for chart in stored_charts(yarn):
            stored = stored_stitch(chart, yarn)
            if stored is None or stored.law is None or not stored.converged or pure_fabric(chart):
                continue
            model = packaged_model(frozenset({chart.canonical().key}))
            kind = "rib" if chart.rows == 1 else "welt" if chart.columns == 1 else "2-D"
            size = np.array([stored.cell_course_mm, stored.cell_wale_mm])
            measured = RelaxedSize(stored.cell_course_mm, stored.cell_wale_mm, 0.0)
            for name, known in (("learned", None), ("with size", measured)):
                found = model.response(densities(chart), simulated, known)
                for direction in Direction:
                    own = free_strains_at_stress(stored.law, direction, STRESS)
                    off = np.append(
                        np.log(found.size_mm[direction.axis] / size[direction.axis]),
                        np.log(found.strain(direction, STRESS) / own),
                    )
                    spread = np.append(
                        found.size_log_sd[direction.axis], found.strain_log_sd(direction, STRESS)
                    )
                    missed[kind, str(direction), name].append(np.abs(off))
                    inside[kind, str(direction), name].append(np.abs(off) <= Z_SCORE * spread)
    print(
        f"factor by which size and strain at {STRESS} N/mm are missed: median, 90 %, worst; cover"
    )
    for key, factors in sorted(missed.items()):
        found = np.round(np.exp(np.quantile(factors, (0.5, 0.9, 1.0), axis=0)), 2)
        cover = np.mean(inside[key], axis=0).round(2)
        print(f"{key[0]:5} {key[1]:7} {key[2]:10}", *found, cover, len(factors))


def _simulated(yarn: str) -> Material:
    """The material whose pure fabrics are those of the store."""
    measured = material(yarn)

    def stored(fabric: Fabric) -> StoredStitch:
        found = stored_stitch(StitchChart.of_fabric(fabric, 2, 2), yarn)
        assert found is not None
        return found

    def law(fabric: Fabric) -> ConstitutiveLaw:
        found = stored(fabric).law
        assert found is not None
        return found

    fabrics = {
        fabric: replace(
            measured.record(fabric),
            law=law(fabric),
            stitch_course_mm=stored(fabric).cell_course_mm,
            stitch_wale_mm=stored(fabric).cell_wale_mm,
            loop_length_mm=stored(fabric).loop_length_mm,
            origin=Origin.SIMULATED,
        )
        for fabric in Fabric
    }
    return Material(yarn, yarn, measured.yarn, fabrics)


if __name__ == "__main__":
    main()
