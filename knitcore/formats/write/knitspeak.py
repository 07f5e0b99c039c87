"""KnitSpeak, the language of stitch patterns that Stitch Maps and others read: a subset.

::

    Row 1 (RS): [K1, p1] 3 times, k1.
    Row 2 (WS): *P1, k1, repeat from * to last st, p1.
    Rows 3 and 5 (RS): Knit.
    Rows 4, 6-8: Knit to last 2 sts, p2.

KnitSpeak does not mention casting on: the number of stitches follows from the rows. So the first
row is written without ``*``. Reference: https://stitch-maps.com/about/knitspeak/
"""

from itertools import pairwise

from knitcore.chart.row_sides import Construction, Side
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.write.written_pattern import in_brackets, row_words
from knitcore.garment.worked_piece import all_rows


def write_knitspeak(
    chart: StitchChart | SymbolChart,
    construction: Construction = Construction.FLAT,
    *,
    first_side: Side = Side.RS,
) -> str:
    """A chart in KnitSpeak; :func:`~knitcore.formats.read.written_reader.read_rows` reads it back.

    Examples
    --------
    >>> print(write_knitspeak(StitchChart.of_fabric("rib", rows=4, columns=5)))
    Row 1 (RS): [K1, p1] twice, k1.
    Rows 2 and 4 (WS): *P1, k1, repeat from * to last st, p1.
    Row 3 (RS): *K1, p1, repeat from * to last st, k1.
    <BLANKLINE>
    """
    flat = construction is Construction.FLAT
    groups: dict[tuple[str, Side], list[int]] = {}
    for index, row in enumerate(all_rows(chart, construction, first_side=first_side)):
        words = row_words(row.stitches).replace("; rep from *", ", repeat from *")
        words = words.removesuffix(" to end")
        if index == 0:
            words = in_brackets(row.stitches).replace("(", "[").replace(")", "]")
        groups.setdefault((words, row.side), []).append(index + 1)
    name = "Row" if flat else "Round"
    lines = []
    for (words, side), numbers in groups.items():
        start = next(i for i, letter in enumerate(words) if letter.isalpha())
        said = f"{words[:start]}{words[start].upper()}{words[start + 1 :]}"
        which = f" ({side})" if flat else ""
        plural = "s" if len(numbers) > 1 else ""
        lines.append(f"{name}{plural} {_listed(numbers)}{which}: {said}.")
    return "\n".join([*lines, ""])


def _listed(numbers: list[int]) -> str:
    """Row numbers in words: ``1-4, 7 and 9``."""
    edges = [0, *(i for i, (a, b) in enumerate(pairwise(numbers), 1) if b != a + 1), len(numbers)]
    parts = []
    for start, stop in pairwise(edges):
        first, last = numbers[start], numbers[stop - 1]
        parts.append(f"{first}-{last}" if last > first else str(first))
    return " and ".join(filter(None, [", ".join(parts[:-1]), parts[-1]]))
