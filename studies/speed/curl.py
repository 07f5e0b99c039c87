"""Times to rest of pieces that curl and fold.

    python -m studies.speed.curl [SIDE…] [--only NAME]

CPU seconds in one thread, after a first piece that compiles the code. To be reached: 2 s for
30 x 30 stitches, 8 s for 60 x 60, 30 s for 100 x 100.
"""

import argparse
import time
from collections.abc import Callable

import numpy as np

from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.space.curl import curl
from knitcore.materials import material

GOALS_S = {30: 2.0, 60: 8.0, 100: 30.0}
BORDER = 4


def tiled(repeat: str, side: int) -> StitchChart:
    """A square piece of a repeat."""
    unit = StitchChart.parse(repeat)
    whole = unit.tile(-(-side // unit.rows), -(-side // unit.columns))
    return StitchChart(whole.purl[:side, :side])


def framed(side: int) -> StitchChart:
    """Stockinette in a frame of garter."""
    purl = tiled("P\nK", side).purl.copy()
    purl[BORDER:-BORDER, BORDER:-BORDER] = False
    return StitchChart(purl)


def squares(stitches: int) -> str:
    """A basket of squares of knits and purls."""
    first, second = "K" * stitches + "P" * stitches, "P" * stitches + "K" * stitches
    return "\n".join([first] * stitches + [second] * stitches)


PIECES: dict[str, Callable[[int], StitchChart]] = {
    "stockinette": lambda side: tiled("K", side),
    "stockinette in garter": framed,
    "garter": lambda side: tiled("K\nP", side),
    "2x2 rib": lambda side: tiled("KKPP", side),
    "5x5 rib": lambda side: tiled("KKKKKPPPPP", side),
    "5x5 basket": lambda side: tiled(squares(5), side),
    "squares of 10": lambda side: tiled(squares(10), side),
    "at random": lambda side: StitchChart(np.random.default_rng(1).random((side, side)) < 0.5),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sides", nargs="*", type=int, default=list(GOALS_S), metavar="SIDE")
    parser.add_argument("--only", choices=PIECES, action="append")
    options = parser.parse_args()
    yarn = material("acrylic")
    curl(tiled(squares(5), 20), yarn)
    for side in options.sides:
        for name in options.only or PIECES:
            chart = PIECES[name](side)
            wall = time.perf_counter()
            piece = curl(chart, yarn)
            wall = time.perf_counter() - wall
            state = "" if piece.converged else "  NOT converged"
            goal = f"  goal {GOALS_S[side]:.0f}" if side in GOALS_S else ""
            print(
                f"{side:4}  {name:22} {piece.seconds:6.2f} s CPU, {wall:6.2f} s in all"
                f"{goal}{state}",
                flush=True,
            )


if __name__ == "__main__":
    main()
