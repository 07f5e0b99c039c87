"""Learning curve of the learned answer over charts and yarns: ``python -m benchmarks.learning``.

The model learns from some of the packaged samples' charts, drawn at random, and is tested on all
other mixed charts (learning curve). Then each yarn in turn is left out. Settings and slopes stay
those of the packaged model. It prints the median and 90 % quantile of the factor by which width,
height, and the strains at 2000 B/L³ (about 0.05 N/mm) along course and wale are missed; for the
strains without and with the relaxed size known.
"""

from __future__ import annotations

import numpy as np

from knitcore.prediction.gaussian_process import KernelModel
from knitcore.prediction.learned import packaged_model
from scripts.training.learned import Row, kind_of, rows

COUNTS = (12, 25, 50, 100, 150)
DRAWS = 4
AT = [2, 8]
"""Outputs: strains at 2000 B/L³."""


def main() -> None:
    """Print both tables."""
    found = rows()
    charts = np.array([row.chart.key for row in found])
    kinds = np.array([kind_of(row.chart) for row in found])
    mixed = kinds == "2-D"
    draw = np.random.default_rng(0)
    texts = np.unique(charts[kinds != "pure"])
    print("2-D charts left out: width height | strains without size | with known size")
    for count in (*COUNTS, round(0.9 * len(texts))):
        parts = []
        for _ in range(DRAWS):
            learned_from = np.isin(charts, draw.choice(texts, count, replace=False))
            parts.append(missed(found, learned_from | (kinds == "pure"), mixed & ~learned_from))
        print(f"{count:4} charts:", table(np.vstack(parts)))
    yarns = np.array([row.yarn_name for row in found])
    for yarn in np.unique(yarns[mixed]):
        own = yarns == yarn
        print(f"{yarn} left out:", table(missed(found, ~own | (kinds == "pure"), mixed & own)))


def missed(found: list[Row], learned_from: np.ndarray, judged: np.ndarray) -> np.ndarray:
    """(charts, 6) logarithms: width, height, strains without and with size; nan if not swept."""
    model = packaged_model()
    numbers = np.array([row.numbers for row in found])
    samples = model.sample(np.array([row.features for row in found]), numbers)
    samples.pure[:] = [row.pure for row in found]
    fold = np.array([row.fold for row in found])
    slopes = np.array([row.follows for row in found])[..., None] * model.slopes
    rest = np.array([row.ratio for row in found]) - np.einsum("njk,nk->nj", slopes, fold)
    swept = learned_from & np.isfinite(rest).all(axis=1)
    folding = KernelModel.fit(model.folding.settings, samples[learned_from], fold[learned_from])
    unfolding = KernelModel.fit(model.unfolding.settings, samples[swept], rest[swept])
    fold_off = folding(samples[judged])[0] - fold[judged]
    known = (unfolding(samples[judged])[0] - rest[judged])[:, AT]
    blind = known + np.einsum("njk,nk->nj", slopes[judged][:, AT], fold_off)
    return np.hstack([fold_off, blind, known])


def table(logs: np.ndarray) -> str:
    """Median and 90 % quantile of each column, the number of charts, and of those swept."""
    swept = logs[np.isfinite(logs).all(axis=1)]
    parts = [*logs[:, :2].T, *(swept[:, 2:].T if len(swept) else ())]
    found = [np.exp(np.quantile(np.abs(part), (0.5, 0.9))) for part in parts]
    return "  ".join(f"{a:.2f}/{b:.2f}" for a, b in found) + f"  n {len(logs)}, swept {len(swept)}"


if __name__ == "__main__":
    main()
