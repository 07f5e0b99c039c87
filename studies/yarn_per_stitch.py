"""Yarn in a stitch by its surroundings, from masses: ``python -m studies.yarn_per_stitch FOLDER``.

FOLDER holds ``knitdb`` (knits and purls only, see :mod:`studies.knitdb`) and ``knitdb_stitches``
(lace, cables and twists of the same yarn and machine: ``measured.csv`` and ``charts.jsonl.gz``).
All these swatches have one machine setting, as many stitches and a frame of seed, so that masses
compare yarn per stitch. A candidate says how it depends on the chart; its constants are fitted
without the textures that are judged, where a texture is all swatches with the same knits and purls.
Yarn overs, decreases, crossings and twists have constants of their own in every candidate.

It prints each candidate's error on textures left out, what is chosen on the others and the error
of that choice; the constant of the form in use by each set; and how a model of the machine's feed
and the yarns of the paper agree with it.
"""

import argparse
import csv
import gzip
import json
import math
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from knitcore.base.arrays import Array, Mask
from knitcore.chart.fabric import Fabric
from knitcore.chart.phases import quarter_phases
from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials import load_library, material
from knitcore.materials.yarn_per_stitch import change_rule, yarn_per_stitch
from studies.claims import Nested, nested
from studies.knitdb import measured_swatches, whole_chart

STOCKINETTE = "2_1_004Stockinette"
ALIKE = "the same in every stitch"
IN_USE = "changes along the row"
FABRICS = "by the fabrics of lace-acrylic"
BETWEEN = "changes, and between rows"
KNITDB = "constant of KnitDB"
FEED = "beds as far apart as needles"
FRAME = 13, 12
"""Row (from the top) and column where the frame of a swatch ends and its 60 × 60 stitches begin."""
PITCH_MM = 25.4 / 15
"""Distance of the needles on the 15-gauge machine."""
TEX = 1000 / 15
"""Linear density of the yarn, 2/30 metric, g/km."""
NUISANCES = ("yarn_overs", "decreases", "crossed_rows", "twisted")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    sets = weighed(parser.parse_args().folder)
    plain, others, every = *sets, sets[0].with_more(sets[1])
    print(f"rms factors of {len(plain.mass_g)} swatches of knits and purls, {len(others.mass_g)}")
    print("others, all; and of the first with constants of the others")
    for name, candidate in CANDIDATES.items():
        missed = [swatches.missed(candidate) for swatches in (plain, others, every)]
        missed.append(plain.missed(candidate, others.fitted(candidate)))
        print(f"{name:40}", *(f"{rms(logs):.4f}" for logs in missed))
    for swatches in (plain, others, every):
        choice = swatches.judged()
        print(f"chosen on other textures {rms(choice.missed):.4f}", *_names(choice))
        for name in SHOWN:
            constants = swatches.constants(CANDIDATES[name])
            print(f"  {name:26}", *(f"{c:.3f} ± {sd:.3f}" for c, sd in constants))
    print(f"mass of a texture knitted again: standard deviation {plain.repeatability():.4f}")
    loop = every.loop_length_mm
    constant = every.constants(CANDIDATES[IN_USE])[0][0]
    print(f"a change takes {constant * loop:.2f} of {loop:.2f} mm, as if beds were")
    print(f"{gap(constant * loop):.2f} mm apart; as far apart as needles, {PITCH_MM:.2f} mm, they")
    print(f"would make it {feed(loop):.3f} of a stitch")
    for name, logs in of_yarns().items():
        print(f"{name:40} {rms(logs):.3f} ", *(f"{factor:.2f}" for factor in np.exp(logs)))


class Candidate(NamedTuple):
    """How the yarn of a stitch depends on its chart.

    Attributes
    ----------
    fitted : numbers of a chart per stitch, each with a constant that is fitted.
    given : yarn of the mean stitch without them, in any unit.
    """

    fitted: tuple[Callable[[Mask], float], ...] = ()
    given: Callable[[Mask], float] = lambda _: 1.0


class Swatches(NamedTuple):
    """Swatches that were weighed.

    Attributes
    ----------
    purl : (swatches, rows, columns) charts with their frames, top row first.
    counts : (swatches, 4) numbers of :data:`NUISANCES` per stitch.
    mass_g : of each.
    """

    purl: Mask
    counts: Array
    mass_g: Array

    def with_more(self, others: "Swatches") -> "Swatches":
        """All swatches of both."""
        return Swatches(*(np.concatenate(pair) for pair in zip(self, others, strict=True)))

    @property
    def textures(self) -> list[str]:
        """Names of the textures: the same for the same knits and purls, or if they are swapped."""
        inner = self.purl[:, FRAME[0] : FRAME[0] + 60, FRAME[1] : FRAME[1] + 60]
        return [_texture(chart) for chart in inner]

    def design(self, candidate: Candidate) -> Array:
        """(swatches, constants) yarn of the mean stitch for each constant of a candidate."""
        given = np.array([candidate.given(chart) for chart in self.purl])
        fitted = [[number(chart) for number in candidate.fitted] for chart in self.purl]
        return np.column_stack([given, given[:, None] * np.array(fitted), self.counts])

    def fitted(self, candidate: Candidate) -> Array:
        """Constants of a candidate by least squares."""
        return np.asarray(np.linalg.lstsq(self.design(candidate), self.mass_g, rcond=None)[0])

    def missed(self, candidate: Candidate, constants: Array | None = None) -> Array:
        """Logarithms of computed over measured mass.

        ``constants`` are fitted without the texture of the swatch if they are not given.
        """
        design, textures = self.design(candidate), np.array(self.textures)
        if constants is not None:
            return np.asarray(np.log(design @ constants / self.mass_g))
        computed = np.empty_like(self.mass_g)
        for texture in set(textures):
            out = textures == texture
            fit = np.linalg.lstsq(design[~out], self.mass_g[~out], rcond=None)[0]
            computed[out] = design[out] @ fit
        return np.asarray(np.log(computed / self.mass_g))

    def judged(self) -> Nested:
        """Errors of the candidate that is chosen on the other textures."""
        missed = [self.missed(candidate) for candidate in CANDIDATES.values()]
        return nested(np.array(missed), self.textures)

    def constants(self, candidate: Candidate) -> list[tuple[float, float]]:
        """Constants of a candidate over the yarn of a stitch without changes, and their errors."""
        design = self.design(candidate)
        fit = self.fitted(candidate)
        left = self.mass_g - design @ fit
        rank = np.linalg.matrix_rank(design)
        covariance = left @ left / (len(left) - rank) * np.linalg.pinv(design.T @ design)
        part = slice(1, 1 + len(candidate.fitted))
        ratio = fit[part] / fit[0]
        gradient = np.eye(len(fit))[part] / fit[0] - np.outer(ratio, np.eye(len(fit))[0]) / fit[0]
        deviations = np.sqrt(np.einsum("ij,jk,ik->i", gradient, covariance, gradient))
        return list(zip(ratio.tolist(), deviations.tolist(), strict=True))

    @property
    def loop_length_mm(self) -> float:
        """Yarn of a stitch without changes, from the mass and the yarn's count."""
        grams = self.fitted(CANDIDATES[IN_USE])[0] / self.purl[0].size
        return float(1e6 * grams / TEX)

    def repeatability(self) -> float:
        """Standard deviation of the logarithm of the mass of swatches with the same texture."""
        logs, textures = np.log(self.mass_g), np.array(self.textures)
        same = [logs[textures == texture] for texture in set(textures)]
        squares = sum(float(((group - group.mean()) ** 2).sum()) for group in same)
        return math.sqrt(squares / sum(len(group) - 1 for group in same))


def changes(purl: Mask) -> float:
    """Changes between knit and purl along the rows, per stitch."""
    return float((purl[:, 1:] != purl[:, :-1]).sum()) / purl.size


def between_rows(purl: Mask) -> float:
    """Stitches on one of the other kind."""
    return changes(purl.T)


def beside(purl: Mask) -> float:
    """Stitches with a stitch of the other kind beside them in the row."""
    return float(_sides(purl).any(axis=0).mean())


def lone(purl: Mask) -> float:
    """Stitches between two of the other kind."""
    return float(_sides(purl).all(axis=0).mean())


def in_seed(purl: Mask) -> float:
    """Share of quarter stitches in the phase of seed."""
    return float((quarter_phases(StitchChart(purl[::-1])) == Fabric.SEED.phase).mean())


def purls(purl: Mask) -> float:
    """Share of purls."""
    return float(purl.mean())


def by_fabrics(purl: Mask) -> float:
    """Loop length by those of ``lace-acrylic``'s pure fabrics, which is this yarn, mm."""
    chart = StitchChart(purl[::-1])
    return yarn_per_stitch(chart, material("lace-acrylic")).mean_mm


def by_feed(purl: Mask) -> float:
    """Loop length by the feed, with lace-acrylic's stockinette."""
    loop = material("lace-acrylic").record(Fabric.STOCKINETTE).loop_length_mm or math.nan
    return 1 + feed(loop) * changes(purl)


def feed(loop_mm: float, gap_mm: float = PITCH_MM, pitch_mm: float = PITCH_MM) -> float:
    """Yarn that a change takes, over that of a stitch.

    Both needles draw the same loop; the piece between them spans the pitch p, and across the beds
    the hypotenuse of the pitch and the distance g of the beds: √(p² + g²) − p longer.
    """
    return (math.hypot(gap_mm, pitch_mm) - pitch_mm) / loop_mm


def gap(added_mm: float, pitch_mm: float = PITCH_MM) -> float:
    """Distance of the beds at which a change takes so much yarn, mm; the inverse of the feed."""
    return math.sqrt((pitch_mm + added_mm) ** 2 - pitch_mm**2)


SHOWN = (IN_USE, "changes and runs of one", BETWEEN)
"""Candidates whose constants are printed."""
CANDIDATES = {
    ALIKE: Candidate(),
    IN_USE: Candidate((changes,)),
    "stitches beside a change": Candidate((beside,)),
    "runs of one": Candidate((lone,)),
    "changes between rows": Candidate((between_rows,)),
    "purls": Candidate((purls,)),
    "changes and runs of one": Candidate((changes, lone)),
    BETWEEN: Candidate((changes, between_rows)),
    "changes, rib and seed apart": Candidate((changes, in_seed)),
    "changes and purls": Candidate((changes, purls)),
    FABRICS: Candidate(given=by_fabrics),
    FEED: Candidate(given=by_feed),
}
"""Forms among which the rule is chosen. A row has as many first stitches after a change, and edges
of runs, as changes: masses cannot tell these apart."""


def weighed(folder: Path) -> tuple[Swatches, Swatches]:
    """Swatches of knits and purls only, and the others.

    A chart that is not 60 × 60 stitches, knitted by mistake, is left out.
    """
    rows = [row for row in measured_swatches(folder / "knitdb") if row["mass_g"]]
    charts = [whole_chart(folder / "knitdb", row["name"]).purl[::-1] for row in rows]
    mass = np.array([float(row["mass_g"]) for row in rows])
    plain = Swatches(np.array(charts), np.zeros((len(rows), len(NUISANCES))), mass)
    frame = charts[[row["name"] for row in rows].index(STOCKINETTE)]
    inner = slice(FRAME[0], FRAME[0] + 60), slice(FRAME[1], FRAME[1] + 60)
    with gzip.open(folder / "knitdb_stitches" / "charts.jsonl.gz", "rt", encoding="utf-8") as lines:
        parents = {chart["name"]: chart["rows"][1:] for chart in map(json.loads, lines)}
    with (folder / "knitdb_stitches" / "measured.csv").open(encoding="utf-8") as stream:
        other = [row for row in csv.DictReader(stream) if len(parents[row["name"]]) == 60]
    purl = np.array([frame] * len(other))
    for chart, row in zip(purl, other, strict=True):
        chart[inner] = [[symbol[0][0] == "P" for symbol in r] for r in parents[row["name"]]][::-1]
    counts = np.array([[float(row[name]) for name in NUISANCES] for row in other]) / frame.size
    return plain, Swatches(purl, counts, np.array([float(row["mass_g"]) for row in other]))


def of_yarns() -> dict[str, Array]:
    """Rib and seed over stockinette and garter of the paper's yarns.

    Logarithms of the ratios, and errors of the candidates; a yarn knitted by hand counts as
    another. ``garter and seed`` are these over stockinette and rib, which the rule has alike.
    """
    logs, wide = [], []
    for each in load_library().values():
        records = [each.record(fabric) for fabric in Fabric]
        width = each.record(Fabric.STOCKINETTE).stitch_course_mm
        for lengths in (
            [record.loop_length_mm for record in records],
            [record.hand_loop_length_mm for record in records],
        ):
            if None not in lengths:
                logs.append(np.log(np.array(lengths, dtype=float)).reshape(2, 2))
                wide.append(width)
    fabrics = np.array(logs)
    flat, changed = fabrics.mean(axis=2).T
    true = changed - flat
    feeds = [math.log1p(feed(loop, w, w)) for loop, w in zip(np.exp(flat), wide, strict=True)]
    return {
        "measured": true,
        "garter and seed": np.diff(fabrics, axis=2).ravel(),
        ALIKE: -true,
        KNITDB: math.log1p(change_rule().per_change) - true,
        "beds one stitch apart": np.array(feeds) - true,
        "mean of the other yarns": (true.sum() - true) / (len(true) - 1) - true,
    }


def rms(logs: Array) -> float:
    """Rms factor."""
    return float(np.exp(np.sqrt(np.mean(logs**2))))


def _names(choice: Nested) -> Iterator[str]:
    names = list(CANDIDATES)
    for index, times in Counter(choice.chosen).most_common():
        yield f"{names[index]} {times} times;"


def _sides(purl: Mask) -> Mask:
    change = np.pad(purl[:, 1:] != purl[:, :-1], ((0, 0), (1, 1)))
    return np.stack([change[:, 1:], change[:, :-1]])


def _texture(purl: Mask) -> str:
    return bytes((purl ^ purl[0, 0]).tobytes()).hex()


if __name__ == "__main__":
    main()
