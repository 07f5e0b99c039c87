"""Accuracy of inverse design: the numbers of docs/inverse-design.md.

``python -m studies.inverse_design ATLAS.npz [--wishes 200]`` with the full atlas of acrylic.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.flat import strip_test
from knitcore.design.atlas import Atlas, load_atlas
from knitcore.design.atlas_build import predict_repeat
from knitcore.design.fill import fill_field
from knitcore.design.shape import fill_shape
from knitcore.materials import material
from knitcore.mechanics.local_moduli import local_moduli

Array = NDArray[np.float64]
ACRYLIC = material("acrylic")
SIDE = 40


def hidden_rectangles(seed: int, least: int) -> StitchChart:
    """Overlapping rectangles of the four fabrics."""
    rng = np.random.default_rng(seed)
    fabric = np.full((SIDE, SIDE), rng.integers(4))
    for _ in range(6):
        height, width = rng.integers(least, SIDE // 2, 2)
        row, column = rng.integers(SIDE - height), rng.integers(SIDE - width)
        fabric[row : row + height, column : column + width] = rng.integers(4)
    return _of_fabrics(fabric)


def hidden_blots(seed: int) -> StitchChart:
    """Overlapping discs and slanted halves of the four fabrics."""
    rng = np.random.default_rng(seed)
    row, column = np.indices((SIDE, SIDE))
    fabric = np.full((SIDE, SIDE), rng.integers(4))
    for _ in range(5):
        at, radius = rng.uniform(0, SIDE, 2), rng.uniform(5, 14)
        disc = np.hypot(row - at[0], column - at[1]) < radius
        slope = np.cos(at[0]) * (row - SIDE / 2) + np.sin(at[0]) * (column - SIDE / 2) > radius
        fabric[disc if rng.random() < 0.7 else slope] = rng.integers(4)
    return _of_fabrics(fabric)


def _of_fabrics(fabric: NDArray[np.int_]) -> StitchChart:
    purl = np.zeros(fabric.shape, dtype=bool)
    for code, kind in enumerate(Fabric):
        whole = StitchChart.of_fabric(kind, *fabric.shape).purl
        purl[fabric == code] = whole[fabric == code]
    return StitchChart(purl)


def hidden_repeat(rng: np.random.Generator, small: list[str]) -> StitchChart:
    """A random repeat of 5x5 to 8x8 stitches, or random stripes of two small repeats."""
    if rng.random() < 0.5:
        rows, columns = rng.integers(5, 9, 2)
        odd = rng.beta(0.5, 0.5, 2)
        across = np.logical_xor.accumulate(rng.random(columns) < odd[0])
        up = np.logical_xor.accumulate(rng.random(rows) < odd[1])
        noise = rng.random((rows, columns)) < rng.choice([0, 0.05, 0.2])
        return StitchChart(across[None] ^ up[:, None] ^ noise).repeat()
    first, second = (StitchChart.parse(small[k]) for k in rng.integers(len(small), size=2))
    a, b = (int(w) for w in rng.integers(2, 7, 2))
    if rng.random() < 0.5:
        rows = int(np.lcm(first.rows, second.rows))
        parts = [first.resized(rows, a).purl, second.resized(rows, b).purl]
        return StitchChart(np.concatenate(parts, axis=1)).repeat()
    columns = int(np.lcm(first.columns, second.columns))
    parts = [first.resized(a, columns).purl, second.resized(b, columns).purl]
    return StitchChart(np.concatenate(parts, axis=0)).repeat()


def recovered(atlas: Atlas) -> None:
    """Charts found again from their own maps, exact and rough."""
    kinds = {
        "rectangles >= 5": lambda seed: hidden_rectangles(seed, 5),
        "rectangles >= 8": lambda seed: hidden_rectangles(seed, 8),
        "discs and slopes": hidden_blots,
    }
    for name, make in kinds.items():
        for noise in (0.0, 0.05, 0.10, 0.20):
            shares = []
            for seed in range(24):
                hidden = make(seed)
                local = local_moduli(hidden, ACRYLIC)
                factors = np.exp(np.random.default_rng(seed).normal(0, noise, (2, SIDE, SIDE)))
                field = fill_field(
                    local.modulus_course_n_per_mm * factors[0],
                    local.modulus_wale_n_per_mm * factors[1],
                    ACRYLIC,
                    atlas,
                    check=False,
                )
                moduli = local_moduli(field.chart, ACRYLIC)
                ratio = np.stack(
                    [
                        moduli.modulus_course_n_per_mm / local.modulus_course_n_per_mm,
                        moduli.modulus_wale_n_per_mm / local.modulus_wale_n_per_mm,
                    ]
                )
                shares.append(float((np.abs(ratio - 1) > 0.1).any(axis=0).mean()))
            print(f"{name}, off by {noise:.0%}: largest share {max(shares):.2%}", flush=True)


def uniform(atlas: Atlas, count: int) -> None:
    """Wishes that are the moduli of hidden repeats, none of them known to the search."""
    rng = np.random.default_rng(11)
    small = [key for key in atlas.keys if len(key.replace("/", "")) <= 9]
    met, in_atlas, cpu = 0, 0, 0.0
    have = np.stack([atlas.modulus(d) for d in Direction])
    for _ in range(count):
        hidden = predict_repeat(hidden_repeat(rng, small), ACRYLIC)
        wish = np.array([hidden.modulus_n_per_mm(d) for d in Direction])
        in_atlas += bool((np.abs(have / wish[:, None] - 1).max(axis=0) <= 0.05).any())
        begun = time.process_time()
        course, wale = (np.full((24, 24), w) for w in wish)
        field = fill_field(course, wale, ACRYLIC, atlas, check=False)
        cpu += time.process_time() - begun
        if field.regions:
            off = max(abs(field.regions[0].deviation_course), abs(field.regions[0].deviation_wale))
        else:
            prediction = predict_repeat(field.chart, ACRYLIC)
            off = max(
                abs(prediction.modulus_n_per_mm(d) / w - 1)
                for d, w in zip(Direction, wish, strict=True)
            )
        met += off <= 0.05
    print(
        f"uniform wishes: {met / count:.1%} met within 5 % ({in_atlas / count:.1%} by the atlas "
        f"alone), {cpu / count:.1f} s CPU each",
        flush=True,
    )


def outlines(atlas: Atlas, count: int) -> None:
    """Outlines of hidden bands of the four fabrics under a stretch."""
    rng = np.random.default_rng(7)
    rms: list[float] = []
    largest: list[float] = []
    cpu: list[float] = []
    while len(rms) < count:
        direction, strain = (Direction.WALE, 0.3) if rng.random() < 0.5 else (Direction.COURSE, 0.4)
        course = direction is Direction.COURSE
        rows, columns = (24, 8) if course else (8, 24)
        bands = [
            StitchChart.of_fabric(list(Fabric)[k], rows, columns).purl
            for k in rng.integers(4, size=5)
        ]
        chart = StitchChart(np.concatenate(bands, axis=1 if course else 0))
        test = strip_test(chart, ACRYLIC, direction, strain, steps=4)
        rest, moved = (test.y_mm.T, test.uy_mm[-1].T) if course else (test.x_mm, test.ux_mm[-1])
        size_mm = rest[1::2, -1] - rest[1::2, 0]
        widening = 1 + (moved[1::2, -1] - moved[1::2, 0]) / size_mm
        begun = time.process_time()
        filled = fill_shape(widening, 24, direction, strain, ACRYLIC, atlas)
        cpu.append(time.process_time() - begun)
        rms.append(filled.rms)
        largest.append(filled.largest)
    print(
        f"outlines: rms {np.mean(rms):.2%} of the width in the mean, {max(rms):.2%} at most; "
        f"largest difference {max(largest):.2%}; {np.mean(cpu):.1f} s CPU each"
    )


def main() -> None:
    """Print all numbers."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("atlas", type=Path)
    parser.add_argument("--wishes", type=int, default=200)
    parser.add_argument("--outlines", type=int, default=12)
    chosen = parser.parse_args()
    atlas = load_atlas(chosen.atlas)
    recovered(atlas)
    uniform(atlas, chosen.wishes)
    outlines(atlas, chosen.outlines)


if __name__ == "__main__":
    main()
