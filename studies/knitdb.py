"""Relaxed sizes against knitted swatches: ``python -m studies.knitdb FOLDER``.

FOLDER holds ``measured.csv`` (name, mass_g, relaxed_width_mm, relaxed_height_mm) and charts, top
row first: ``charts/NAME.txt``, and ``charts/NAME.whole.txt`` with the frame of the swatch, as
decoded from KnitDB (Hofmann et al., KnitPick, UIST 2019). Sizes are compared as ratios to the
stockinette of the same yarn, measured and predicted, so that neither yarn nor gauge is fitted. The
yarn is not in the library: the pure fabrics of ``--material`` are used instead.

It prints, of each swatch, widths and heights over those of stockinette; then the rms factors by
which they are missed. Which of the candidates is used (all like stockinette, the mixture of pure
fabrics, or folds by one of several rules) is chosen without the texture that is judged
(:mod:`studies.claims`).
"""

import argparse
import csv
import re
from collections import Counter
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.stats import spearmanr

from knitcore import StitchChart, material, predict
from knitcore.base.arrays import Array
from knitcore.chart.fabric import PHASES
from knitcore.materials import Material
from knitcore.materials.law_uncertainty import Z_SCORE
from knitcore.prediction.densities import Densities, densities
from knitcore.prediction.learned import packaged_model
from knitcore.prediction.mixture import Mixture
from studies.claims import Nested, nested

POWERS = (1, 2, 3)
MOST = (0.5, 0.7, 0.87, 1.0, 1.2, 2.0, np.inf)
"""Powers of straightness, and most that fabric folds, among which the rule was chosen."""
ALL_ALIKE = "all like stockinette"
NO_FOLDS = "mixture, no folds"
_ONE_FABRIC = 0.9
"""Share of a pure fabric from which on a swatch counts as that texture."""


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--material", default="lace-acrylic", help="whose pure fabrics are used")
    arguments = parser.parse_args()
    swatches = compared(arguments.folder, material(arguments.material))
    columns = swatches.true, swatches.predicted, Z_SCORE * swatches.log_sd
    for name, *values in zip(swatches.names, *map(np.exp, columns), strict=True):
        print(f"{name:28}", *(np.round(value, 2) for value in values))
    print("swatch, measured width and height over stockinette's, predicted, interval factor")
    judged = swatches.judged
    print(f"in sample          rms {factor(swatches.missed)}")
    print(f"chosen without it  rms {factor(judged.missed)}")
    for name in (ALL_ALIKE, NO_FOLDS):
        print(f"{name:18} rms {factor(swatches.candidates[name])}")
    for index, times in Counter(judged.chosen).most_common():
        print(f"  chosen {times:2} times: {list(swatches.candidates)[index]}")
    print(f"rank  {ranks(swatches.predicted, swatches.true)}")
    print(f"cover {swatches.inside.mean():.2f} of {swatches.inside.size} in the 90 % intervals")


class Compared(NamedTuple):
    """Swatches other than stockinette against their predictions.

    Attributes
    ----------
    names, textures : of the swatches; swatches of one texture are left out together.
    true, predicted : (swatches, 2) logarithms of widths and heights over those of stockinette.
    log_sd : (swatches, 2) standard deviations of the predicted ones.
    candidates : by name, (swatches, 2) errors of the null, the mixture and each rule of folds.
    """

    names: list[str]
    textures: list[str]
    true: Array
    predicted: Array
    log_sd: Array
    candidates: dict[str, Array]

    @property
    def missed(self) -> Array:
        """(swatches, 2) errors of the predictions."""
        return self.predicted - self.true

    @property
    def judged(self) -> Nested:
        """Errors of the candidate that is chosen on the other textures."""
        return nested(np.array([*self.candidates.values()]), self.textures)

    @property
    def inside(self) -> np.ndarray:
        """(swatches, 2) whether the 90 % interval holds the measured size."""
        return np.abs(self.missed) <= Z_SCORE * self.log_sd


def compared(folder: Path, of: Material) -> Compared:
    """The swatches of a folder, and what a material's pure fabrics predict of their charts."""
    names, measured, charts = read(folder)
    first = next(i for i, name in enumerate(names) if name.endswith("Stockinette"))
    answers = [predict(chart, of) for chart in charts]
    logs = np.log([(a.relaxed_course_mm, a.relaxed_wale_mm) for a in answers])
    spread = np.array([(a.course.relaxed_log_sd, a.wale.relaxed_log_sd) for a in answers])
    true = np.log(measured / measured[first])
    made_of = [densities(chart) for chart in charts]
    others = np.arange(len(names)) != first
    return Compared(
        [name for name, other in zip(names, others, strict=True) if other],
        [
            _texture(name, composition)
            for name, composition, other in zip(names, made_of, others, strict=True)
            if other
        ],
        true[others],
        (logs - logs[first])[others],
        spread[others],
        {name: (sizes - sizes[first] - true)[others] for name, sizes in _candidates(made_of, of)},
    )


def _texture(name: str, made_of: Densities) -> str:
    fabric = int(made_of.shares.argmax())
    return PHASES[fabric] if made_of.shares[fabric] > _ONE_FABRIC else name


def _candidates(made_of: list[Densities], of: Material) -> Iterator[tuple[str, Array]]:
    """Logarithms of sizes (swatches, 2) by the null, the mixture, and rules of folds."""
    model = packaged_model()
    mixtures = [Mixture.of(composition.shares, of) for composition in made_of]
    flat = np.log([mixture.size_mm for mixture in mixtures])
    features = np.array([composition.features for composition in made_of])
    fold, _ = model.folding(model.sample(features, np.array([m.numbers for m in mixtures])))
    straight = np.array([composition.straight for composition in made_of])
    runs = np.array([composition.even for composition in made_of])
    yield ALL_ALIKE, np.zeros_like(flat)
    yield NO_FOLDS, flat
    for power, most in product(POWERS, MOST):
        for how, weight in (("", np.ones_like(runs)), (", even runs", runs)):
            shown = straight**power * weight / (1 + np.abs(fold) / most)
            yield f"folds, power {power}, at most {most:g}{how}", flat + shown * fold


def read(folder: Path) -> tuple[list[str], np.ndarray, list[StitchChart]]:
    """Names, (swatches, 2) relaxed sizes in mm, and charts."""
    rows = measured_swatches(folder)
    names = [row["name"] for row in rows]
    sizes = np.array(
        [[float(row[f"relaxed_{side}_mm"]) for side in ("width", "height")] for row in rows]
    )
    return names, sizes, [_chart(folder / "charts" / f"{name}.txt") for name in names]


def measured_swatches(folder: Path) -> list[dict[str, str]]:
    """Rows of ``measured.csv``, with their columns' names."""
    with (folder / "measured.csv").open(encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def whole_chart(folder: Path, name: str) -> StitchChart:
    """The chart of a swatch with its frame."""
    return _chart(folder / "charts" / f"{name}.whole.txt")


def _chart(file: Path) -> StitchChart:
    """A chart; stitches of a frame that are neither K nor P are counted as K."""
    return StitchChart.parse(re.sub(r"[^KP\n]", "K", file.read_text(encoding="utf-8")))


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
