"""Sizes of lace and cables against knitted swatches: ``python -m studies.other_stitches FOLDER``.

FOLDER holds ``knitdb_stitches`` (``measured.csv``, ``charts.jsonl.gz``) and ``knitdb``, whose
stockinette is of the same yarn and machine (KnitDB; Hofmann et al., KnitPick, UIST 2019). Sizes
are compared as ratios to that stockinette, measured and predicted, as in :mod:`studies.knitdb`.

A candidate's constants are fitted without the texture that is judged, and so is the choice among
the candidates (:mod:`studies.claims`). It prints the errors of all, the choice and its error,
ranks, the cover of 90 % intervals, and the effects that are packaged.
"""

import argparse
import gzip
import json
import math
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from knitcore import StitchChart, material, predict
from knitcore.base.arrays import Array, Mask
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.read.parent_loops import read_parent_loops
from knitcore.materials import Material
from knitcore.materials.law_uncertainty import Z_SCORE
from knitcore.prediction.densities import densities
from knitcore.prediction.mixture import Mixture
from knitcore.prediction.stitch_effects import StitchDensities
from studies.claims import Nested, nested
from studies.knitdb import factor, measured_swatches, ranks

STOCKINETTE = "2_1_004Stockinette"
FADES = (0.05, 0.1, 0.2)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--material", default="lace-acrylic", help="whose pure fabrics are used")
    arguments = parser.parse_args()
    swatches = compared(arguments.folder, material(arguments.material))
    lace = swatches.lace
    for name, candidate in CANDIDATES.items():
        missed = swatches.missed(candidate)
        print(f"{name:38} lace {factor(missed[lace])}  cables {factor(missed[~lace])}")
    judged = swatches.judged
    print(f"{'chosen without it':38} lace {factor(judged.missed[lace])}  ", end="")
    print(f"cables {factor(judged.missed[~lace])}")
    for index, times in Counter(judged.chosen).most_common():
        print(f"  chosen {times:3} times: {list(CANDIDATES)[index]}")
    predicted = judged.missed + swatches.true
    for name, these in (("lace", lace), ("cables", ~lace)):
        print(f"rank  {name:6} {ranks(predicted[these], swatches.true[these])}")
    sd = np.sqrt((judged.missed**2).mean(axis=0))
    print(f"left unexplained: {sd[0]:.3f} of width, {sd[1]:.3f} of height")
    inside = np.abs(judged.missed) <= Z_SCORE * sd
    print(f"cover lace {inside[lace].mean():.2f}, cables {inside[~lace].mean():.2f}")
    constants = swatches.fitted(CANDIDATES[IN_USE], np.ones(len(lace), dtype=bool))
    spread = np.linalg.inv(swatches.with_leans.T @ swatches.with_leans).diagonal() ** 0.5
    for name, of_size, error in zip(KINDS_IN_USE, constants.T, spread, strict=True):
        print(name, *(f"{c:.2f} ± {error * s:.2f}" for c, s in zip(of_size, sd, strict=True)))


class Compared(NamedTuple):
    """Swatches against what their knits and purls predict.

    Attributes
    ----------
    textures : of the swatches; those of one texture are left out together.
    lace : (swatches,) with yarn overs; the others have cables or twisted stitches.
    true, plain, flat : (swatches, 2) logarithms of widths and heights over those of stockinette:
        measured, predicted of knits and purls, and of their mixture without folds.
    made_of : densities of the other stitches.
    """

    textures: list[str]
    lace: Mask
    true: Array
    plain: Array
    flat: Array
    made_of: list[StitchDensities]

    @property
    def counts(self) -> Array:
        """(swatches, 2) densities of yarn overs and of crossings."""
        return np.array([(own.yarn_overs, own.crossings) for own in self.made_of])

    @property
    def with_leans(self) -> Array:
        """(swatches, 3) the same, and of leaning loops."""
        return np.column_stack([self.counts, [own.leans for own in self.made_of]])

    @property
    def kinds(self) -> Array:
        """(swatches, 2) whether it is lace, or not."""
        return np.column_stack([self.lace, ~self.lace]).astype(float)

    def fitted(self, candidate: "Candidate", on: Mask) -> Array:
        """(2, constants) of a candidate, by least squares on some of the swatches."""
        given, numbers = candidate.given(self), candidate.fitted(self)
        rest = (self.true - given)[on]
        return np.asarray(np.linalg.lstsq(numbers[on], rest, rcond=None)[0].T)

    def missed(self, candidate: "Candidate") -> Array:
        """(swatches, 2) errors, each with constants fitted without its texture."""
        textures = np.array(self.textures)
        errors = candidate.given(self) - self.true
        for texture in set(self.textures):
            out = textures == texture
            errors[out] += candidate.fitted(self)[out] @ self.fitted(candidate, ~out).T
        return errors

    @property
    def judged(self) -> Nested:
        """Errors of the candidate that is chosen on the other textures."""
        missed = [self.missed(candidate) for candidate in CANDIDATES.values()]
        return nested(np.array(missed), self.textures)


class Candidate(NamedTuple):
    """A form of the size: what is given, and numbers whose constants are fitted."""

    given: Callable[[Compared], Array]
    fitted: Callable[[Compared], Array] = lambda swatches: np.zeros((len(swatches.true), 0))


def _fading(at: float) -> Callable[[Compared], Array]:
    def given(swatches: Compared) -> Array:
        fade = np.array([math.exp(-own.share / at) for own in swatches.made_of])
        return swatches.flat + fade[:, None] * (swatches.plain - swatches.flat)

    return given


KINDS_IN_USE = "yarn_overs", "crossings", "leans"
IN_USE = f"stitches and leans, folds fade at {FADES[0]:g}"
CANDIDATES = {
    "all like stockinette": Candidate(lambda s: np.zeros_like(s.true)),
    "offset of its kind": Candidate(lambda s: np.zeros_like(s.true), lambda s: s.kinds),
    "knits and purls": Candidate(lambda s: s.plain),
    "half of them, offset of its kind": Candidate(lambda s: s.plain / 2, lambda s: s.kinds),
    "stitches, with folds": Candidate(lambda s: s.plain, lambda s: s.counts),
    "stitches, without folds": Candidate(lambda s: s.flat, lambda s: s.counts),
    **{
        f"stitches and leans, folds fade at {at:g}": Candidate(_fading(at), lambda s: s.with_leans)
        for at in FADES
    },
    **{
        f"stitches, folds fade at {at:g}": Candidate(_fading(at), lambda s: s.counts)
        for at in FADES
    },
}

SIMPLE = tuple(CANDIDATES)[:4]
"""The null and the simplest forms."""


def compared(folder: Path, of: Material) -> Compared:
    """The swatches of a folder, and what a material's fabrics predict of their knits and purls."""
    base = _size(next(r for r in measured_swatches(folder / "knitdb") if r["name"] == STOCKINETTE))
    rows = measured_swatches(folder / "knitdb_stitches")
    charts = _charts(folder / "knitdb_stitches" / "charts.jsonl.gz")
    swatches = [charts[row["name"]] for row in rows]
    stockinette = _predicted(StitchChart.parse("K"), of)
    return Compared(
        [_texture(chart) for chart in swatches],
        np.array(["yo" in row["class"] for row in rows]),
        np.array([_size(row) - base for row in rows]),
        np.array([_predicted(chart.plain, of) - stockinette for chart in swatches]),
        np.array([_flat(chart.plain, of) - stockinette for chart in swatches]),
        [StitchDensities.of(chart) for chart in swatches],
    )


def _charts(file: Path) -> dict[str, SymbolChart]:
    with gzip.open(file, "rt", encoding="utf-8") as lines:
        records = [json.loads(line) for line in lines]
    return {
        record["name"]: read_parent_loops(json.dumps({"rows": record["rows"]}))[0]
        for record in records
    }


def _texture(chart: SymbolChart) -> str:
    """Name a texture; the mirror image of a chart is the same one."""
    return min(chart.key, chart.mirror().key)


def _size(row: dict[str, str]) -> Array:
    return np.log([float(row[f"relaxed_{side}_mm"]) for side in ("width", "height")])


def _predicted(chart: StitchChart, of: Material) -> Array:
    answer = predict(chart, of)
    return np.log([answer.relaxed_course_mm, answer.relaxed_wale_mm])


def _flat(chart: StitchChart, of: Material) -> Array:
    return np.log(Mixture.of(densities(chart.repeat_cut()).shares, of).size_mm)


if __name__ == "__main__":
    main()
