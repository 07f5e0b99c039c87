"""Relaxed sizes against knitted swatches: ``python -m studies.knitdb FOLDER``.

FOLDER holds ``measured.csv`` (name, relaxed_width_mm, relaxed_height_mm) and ``charts/NAME.txt``
(top row first), as decoded from KnitDB (Hofmann et al., KnitPick, UIST 2019). The comparison is of
ratios to the stockinette of the same yarn, measured and predicted, so that neither yarn nor gauge
is fitted. The yarn is not in the library: the pure fabrics of ``--material`` are used instead.

It prints the rms factor by which widths and heights are missed, Spearman's rank correlation, and
the share inside the 90 % intervals, compared with the null model (all charts are like stockinette)
and the mixture of pure fabrics without folds. One number of the model, the most that real fabric
folds, was fitted to 29 of these swatches: its optimum here and the leave-one-out figure are printed
too.
"""

import argparse
import csv
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.stats import spearmanr

from knitcore import StitchChart, material, predict
from knitcore.base.arrays import Array
from knitcore.materials import Material
from knitcore.materials.law_uncertainty import Z_SCORE
from knitcore.prediction.densities import densities
from knitcore.prediction.learned import packaged_model
from knitcore.prediction.mixture import Mixture


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--material", default="lace-acrylic", help="whose pure fabrics are used")
    arguments = parser.parse_args()
    of, model = material(arguments.material), packaged_model()
    names, charts, first, true, ratio, spread = compared(arguments.folder, of)
    for row in zip(names, np.exp(true), np.exp(ratio), np.exp(Z_SCORE * spread), strict=True):
        print(f"{row[0]:28}", *(np.round(part, 2) for part in row[1:]))
    print("swatch, measured width and height over stockinette's, predicted, interval factor")
    made_of = [densities(chart) for chart in charts]
    mixture = np.log([Mixture.of(composition.shares, of).size_mm for composition in made_of])
    mixture -= mixture[first]
    for name, logs in (("predicted", ratio), ("mixture, no folds", mixture), ("null", 0 * true)):
        print(f"{name:18} rms {factor(logs - true)}  rank {ranks(logs, true)}")
    others = np.arange(len(names)) != first
    inside = np.abs(ratio - true)[others] <= Z_SCORE * spread[others]
    print(f"cover {inside.mean():.2f} of {inside.size} in the 90 % intervals")

    def missed(most: float) -> Array:
        fitted_to = replace(model, most_folded=most)
        sizes = np.log([fitted_to.response(composition, of).size_mm for composition in made_of])
        return np.asarray(sizes - sizes[first] - true)

    best, left_out = fitted(missed, len(names))
    print(
        f"most_folded {model.most_folded:g}, here best {best:.2f}; left out one by one {left_out}"
    )


class Compared(NamedTuple):
    """Swatches against their predictions.

    Attributes
    ----------
    names, charts : of the swatches.
    first : index of stockinette.
    true, predicted : (swatches, 2) logarithms of widths and heights over those of stockinette.
    log_sd : (swatches, 2) standard deviations of the predicted ones.
    """

    names: list[str]
    charts: list[StitchChart]
    first: int
    true: Array
    predicted: Array
    log_sd: Array


def compared(folder: Path, of: Material) -> Compared:
    """The swatches of a folder, and what a material's pure fabrics predict of their charts."""
    names, measured, charts = read(folder)
    first = next(i for i, name in enumerate(names) if name.endswith("Stockinette"))
    answers = [predict(chart, of) for chart in charts]
    logs = np.log([(a.relaxed_course_mm, a.relaxed_wale_mm) for a in answers])
    spread = np.array([(a.course.relaxed_log_sd, a.wale.relaxed_log_sd) for a in answers])
    true = np.log(measured / measured[first])
    return Compared(names, charts, first, true, logs - logs[first], spread)


def read(folder: Path) -> tuple[list[str], np.ndarray, list[StitchChart]]:
    """Names, (swatches, 2) relaxed sizes in mm, and charts."""
    with (folder / "measured.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    names = [row["name"] for row in rows]
    sizes = np.array(
        [[float(row[f"relaxed_{side}_mm"]) for side in ("width", "height")] for row in rows]
    )
    texts = [(folder / "charts" / f"{name}.txt").read_text(encoding="utf-8") for name in names]
    return names, sizes, [StitchChart.parse(text) for text in texts]


def fitted(missed: Callable[[float], Array], count: int) -> tuple[float, str]:
    """Best value of the fitted number, and the rms factor of swatches that it was not fitted to."""
    tried = np.linspace(0.3, 3.0, 28)
    table = np.array([missed(most) for most in tried])  # (values, swatches, 2)
    squares = (table**2).sum(axis=2)
    left = [squares[:, np.arange(count) != i].sum(axis=1).argmin() for i in range(count)]
    rest = np.array([table[left[i], i] for i in range(count)])
    return float(tried[squares.sum(axis=1).argmin()]), factor(rest)


def factor(logs: np.ndarray) -> str:
    """Rms factors: all, widths, heights."""
    both = np.exp(np.sqrt(np.mean(logs**2)))
    width, height = np.exp(np.sqrt(np.mean(logs**2, axis=0)))
    return f"{both:.3f} (width {width:.3f}, height {height:.3f})"


def ranks(logs: np.ndarray, true: np.ndarray) -> str:
    """Spearman's correlations of widths and heights."""
    if not np.ptp(logs):
        return "none"
    correlations = [spearmanr(logs[:, i], true[:, i]).statistic for i in range(2)]
    return f"width {correlations[0]:.2f}, height {correlations[1]:.2f}"


if __name__ == "__main__":
    main()
