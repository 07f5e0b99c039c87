"""The cost of knitting a repeat: transfers, crossings and curl."""

from dataclasses import dataclass

from knitcore.chart.segments import segment_map
from knitcore.chart.stitch_chart import StitchChart


@dataclass(frozen=True)
class KnittingCost:
    """The cost of knitting a repeat.

    Attributes
    ----------
    transfers_per_stitch : loops that a V-bed machine transfers between its beds.
    crossings_per_stitch : passes of the yarn between face and back, from bed to bed on a machine.
        Every stitch is knitted with the one yarn, so there are no floats.
    curl : knits minus purls on the face, over all stitches; far from 0 the cloth curls.
    """

    transfers_per_stitch: float
    crossings_per_stitch: float
    curl: float


@dataclass(frozen=True)
class CostLimits:
    """Limits on the cost of a fabric; None for no limit.

    Attributes
    ----------
    transfers_per_stitch, crossings_per_stitch : see :class:`KnittingCost`.
    curl : of its absolute value.
    """

    transfers_per_stitch: float | None = None
    crossings_per_stitch: float | None = None
    curl: float | None = None

    def allow(self, cost: KnittingCost) -> bool:
        """Say whether a repeat keeps within all limits."""
        pairs = (
            (cost.transfers_per_stitch, self.transfers_per_stitch),
            (cost.crossings_per_stitch, self.crossings_per_stitch),
            (abs(cost.curl), self.curl),
        )
        return all(limit is None or value <= limit + 1e-9 for value, limit in pairs)


def knitting_cost(repeat: StitchChart) -> KnittingCost:
    """The cost of a repeat.

    Examples
    --------
    >>> knitting_cost(StitchChart.parse("KP")).transfers_per_stitch
    0.0
    """
    segments = segment_map(repeat, periodic=True)
    course, wale = float(segments.course_odd.mean()), float(segments.wale_odd.mean())
    return KnittingCost(
        transfers_per_stitch=wale,
        crossings_per_stitch=course,
        curl=1.0 - 2.0 * float(repeat.purl.mean()),
    )
