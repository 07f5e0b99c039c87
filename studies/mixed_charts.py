"""The learned answer against yarn-level sweeps: ``python -m studies.mixed_charts FILE.json``.

The file is a list of charts relaxed and swept at the yarn level: ``chart`` (rows from the top
separated by ``/``), ``yarn`` (acrylic, cotton or a yarn of the training library), ``size`` (mm of
the mean stitch, course and wale), ``stress_n_per_mm`` and ``strain`` by direction. A chart that the
packaged model has learned from is predicted by the model without it. Materials are the yarn level's
own pure fabrics, so that only the mixing is tested.

For each class it prints the median and the 90 % quantile of the factor by which sizes and strains
are missed, and the share inside the 90 % interval: learned; with a gauge (3 % off at random); with
the relaxed size known; and for the null model, in which a chart is like the mean of its class among
the charts that were learned from.
"""

import argparse
import json
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials.law_uncertainty import Z_SCORE
from knitcore.prediction.densities import densities
from knitcore.prediction.learned import STRESS_GRID, LearnedResponse, packaged_model
from knitcore.prediction.size import RelaxedSize
from scripts.training.learned import Row, kind_of, rows, simulated_materials

GAUGE_LOG_SD = 0.03
RELAXED_LOG_SD = 0.003
"""Spread of the ends of a relaxation's starts."""

Entry = dict[str, Any]
"""A chart and what was simulated of it."""
Missed = defaultdict[tuple[str, str, str], list[tuple[float, float]]]
"""By kind, quantity and name: logarithms of the error and of its standard deviation."""
Strains = Callable[[Direction, Array], Array]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("file", type=Path)
    entries = json.loads(parser.parse_args().file.read_text(encoding="utf-8"))
    materials, learned_from = simulated_materials(), rows()
    draw = np.random.default_rng(0)
    missed: Missed = defaultdict(list)
    seen = 0
    for entry in entries:
        chart = StitchChart.parse(entry["chart"])
        key, size = chart.canonical().key, np.array(entry["size"])
        seen += key in packaged_model().charts
        model = packaged_model(frozenset({key}))
        gauge = size * np.exp(GAUGE_LOG_SD * draw.standard_normal(2))
        for name, known in (
            ("learned", None),
            ("gauge", RelaxedSize(gauge[0], gauge[1], GAUGE_LOG_SD)),
            ("known size", RelaxedSize(size[0], size[1], RELAXED_LOG_SD)),
        ):
            answer = model.response(densities(chart), materials[entry["yarn"]], known)
            if known is None:
                record(
                    missed,
                    kind_of(chart),
                    "null",
                    entry,
                    *like_the_mean(answer, chart, learned_from),
                )
            record(
                missed,
                kind_of(chart),
                name,
                entry,
                answer.size_mm,
                answer.strain,
                answer.size_log_sd,
                answer.strain_log_sd,
            )
    print(f"{len(entries)} charts, {seen} of them predicted by a model without them")
    for (kind, quantity, name), pairs in sorted(missed.items()):
        off, spread = np.array(pairs).T
        inside = np.mean(np.abs(off) <= Z_SCORE * spread)
        cover = "" if np.isnan(spread).all() else f"  cover {inside:.2f}"
        median, most = np.exp(np.quantile(np.abs(off), (0.5, 0.9)))
        print(f"{kind:5} {quantity:11} {name:11} {len(off):3}  {median:.2f}/{most:.2f}{cover}")


def like_the_mean(
    answer: LearnedResponse, chart: StitchChart, learned_from: list[Row]
) -> tuple[Array, Strains]:
    """The mixture with the mean correction of the chart's class."""
    alike = [r for r in learned_from if kind_of(r.chart) == kind_of(chart) and r.chart != chart]
    fold = np.mean([row.fold for row in alike], axis=0)
    ratio = np.nanmean([row.ratio[:12] for row in alike], axis=0).reshape(2, -1)

    def strain(direction: Direction, stress: Array) -> Array:
        at = np.log(stress / answer.mixture.bending_stress_n_per_mm)
        factor = np.exp(np.interp(at, np.log(STRESS_GRID), ratio[direction.axis]))
        return np.asarray(factor * answer.mixture.strain(direction, stress))

    return answer.mixture.size_mm * np.exp(fold), strain


def record(
    missed: Missed,
    kind: str,
    name: str,
    entry: Entry,
    size: Array,
    strains: Strains,
    size_sd: Array | None = None,
    strain_sd: Strains | None = None,
) -> None:
    """Note by how much sizes and strains are missed."""
    stress = np.array(entry["stress_n_per_mm"])
    if name in ("learned", "null"):
        for i, side in enumerate(("width", "height")):
            spread = np.nan if size_sd is None else size_sd[i]
            missed[kind, side, name].append((np.log(size[i] / entry["size"][i]), spread))
    for direction in Direction:
        true = np.array(entry["strain"][str(direction)])
        off = np.log(strains(direction, stress) / true)
        spread = strain_sd(direction, stress) if strain_sd else np.full(len(stress), np.nan)
        for at, log, sd in zip(stress, off, spread, strict=True):
            missed[kind, f"{direction} {at:g}", name].append((log, sd))


if __name__ == "__main__":
    main()
