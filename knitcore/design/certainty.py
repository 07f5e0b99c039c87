"""Sources of the intervals of predicted numbers, and what would narrow them.

The interval that an act would leave is that of the same prediction, made with what the act tells:
the gauge as it is expected, the yarn in a stitch as it is expected, or a strip that stretches as it
is expected to.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache, lru_cache, partial
from operator import attrgetter

import numpy as np

from knitcore.base.choice import Choice
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.phases import pure_fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.materials import Interval, Material
from knitcore.materials.estimate.pulled import if_pulled
from knitcore.materials.interval_parts import Part, Variances, deviation
from knitcore.materials.yarn_per_stitch import MeasuredYarn, has_loop_length, mean_yarn
from knitcore.measure.stretch_points import StretchPoint
from knitcore.prediction.densities import densities
from knitcore.prediction.hand import PULLS_N_PER_MM
from knitcore.prediction.mixture import Mixture
from knitcore.prediction.patches import is_large
from knitcore.prediction.predict import predict
from knitcore.prediction.prediction import Along, Prediction
from knitcore.prediction.pure import predict_pure
from knitcore.prediction.size import KnownBy, RelaxedSize

LEAST_SHARE = 0.1
"""Share of the variance below which a part is not worth an act."""
WORTH = 0.9
"""Width of the interval that an act leaves, over that of now, above which it is not worth it."""
SURPRISING = 1.57
"""Half widths of a 90 % interval, in logarithms, beyond which 1 % of all pulls lie."""
LINES = {Direction.COURSE: "rows", Direction.WALE: "columns"}


class Remedy(Choice):
    """An act by which a knitter learns more about cloth."""

    COUNT = "count"
    WEIGH = "weigh"
    PULL = "pull"


@dataclass(frozen=True)
class Narrowing:
    """Where the interval of a number comes from, and what would narrow it.

    Attributes
    ----------
    quantity : field of the number in the results of a prediction, or strain_course, strain_wale.
    n_per_mm : force per width, N/mm, under which a strain is meant; None for other numbers.
    shares : of the variance of the logarithm by part, the largest first; they add up to 1. Of a
        Poisson's ratio they are those of its own variance.
    now : 90 % interval, in the unit of the number.
    act : what would remove the largest part that can be removed; None if nothing helps.
    how : the same in words; empty if nothing helps.
    left : the 90 % interval after it; None if nothing helps.
    fabric, direction : of the strip to pull; None for other acts.
    """

    quantity: str
    n_per_mm: float | None
    shares: Mapping[Part, float]
    now: Interval
    act: Remedy | None
    how: str
    left: Interval | None
    fabric: Fabric | None = None
    direction: Direction | None = None


_Help = tuple[Remedy, str, Interval] | tuple[Remedy, str, Interval, Fabric, Direction]


@dataclass(frozen=True, eq=False)
class _Number:
    """A predicted number: its parts, and its interval in another prediction."""

    quantity: str
    direction: Direction
    parts: Variances
    interval_of: Callable[[Along], Interval]
    n_per_mm: float | None = None

    def interval_in(self, prediction: Prediction) -> Interval:
        return self.interval_of(prediction.along(self.direction))


def narrowings(
    chart: StitchChart | SymbolChart, material: Material, prediction: Prediction
) -> tuple[Narrowing, ...]:
    """Say for each number of a prediction what its interval comes from and what would narrow it.

    Of a chart that is predicted in patches a strip would not be of one fabric, and a gauge narrows
    its size only.

    Parameters
    ----------
    chart, material : of the prediction.
    """
    plain = chart if isinstance(chart, StitchChart) else chart.plain
    repeat = plain.repeat_cut()
    large = pure_fabric(plain) is None and is_large(repeat)
    size = RelaxedSize(prediction.relaxed_course_mm, prediction.relaxed_wale_mm)
    known = None
    if prediction.size_is_known:
        known_by = KnownBy(prediction.relaxed_source)
        known = replace(size, log_sd=prediction.course.relaxed_log_sd, known_by=known_by)

    @cache
    def counted() -> Prediction:
        return prediction.with_size(size) if large else predict(chart, material, size)

    @cache
    def after_pull(fabric: Fabric, direction: Direction) -> Prediction:
        return predict(chart, if_pulled(material, fabric, direction), known)

    @cache
    def least_known(direction: Direction) -> Fabric:
        mixture = Mixture.of(densities(repeat).shares, material)
        spread = mixture.variances(direction, PULLS_N_PER_MM["hand"])
        worst = int(np.argmax([deviation(each) for each in spread]))
        return mixture.parts[worst][1].fabric

    def helped(number: _Number, part: Part) -> _Help | None:
        is_size = number.quantity.startswith("relaxed")
        if part is Part.SIZE or (part is Part.OTHER_STITCHES and is_size):
            if known is not None and known.known_by is KnownBy.GAUGE:
                return None
            return Remedy.COUNT, "count the gauge of your swatch", number.interval_in(counted())
        if part in (Part.LAW, Part.YARN) and not large:
            fabric = least_known(number.direction)
            how = f"pull one strip of {fabric} along its {LINES[number.direction]}"
            left = number.interval_in(after_pull(fabric, number.direction))
            return Remedy.PULL, how, left, fabric, number.direction
        return None

    made = [_narrowing(number, prediction, helped) for number in _numbers(prediction)]
    return (*made, *_yarn(chart, material))


def _narrowing(
    number: _Number, prediction: Prediction, helped: Callable[[_Number, Part], _Help | None]
) -> Narrowing:
    shares, now = shares_of(number.parts), number.interval_in(prediction)
    for part, share in shares.items():
        help_by = helped(number, part) if share >= LEAST_SHARE else None
        if help_by is not None and _width(help_by[2]) <= WORTH * _width(now):
            return Narrowing(number.quantity, number.n_per_mm, shares, now, *help_by)
    return Narrowing(number.quantity, number.n_per_mm, shares, now, None, "", None)


def shares_of(parts: Variances) -> dict[Part, float]:
    """Shares of the parts in the variance, the largest first; parts without any are left out.

    Examples
    --------
    >>> {str(p): s for p, s in shares_of({Part.LAW: np.array(1), Part.SIZE: np.array(3)}).items()}
    {'size at rest': 0.75, 'stretch tests of the pure fabrics': 0.25}
    """
    total = float(sum(parts.values()))
    shares = {part: float(of) / total for part, of in parts.items() if of > 0}
    return dict(sorted(shares.items(), key=lambda item: -item[1]))


def _numbers(prediction: Prediction) -> Iterator[_Number]:
    for direction, ratio in zip(Direction, ("yx", "xy"), strict=True):
        along = prediction.along(direction)
        size, modulus = f"relaxed_{direction}_mm", f"modulus_{direction}_n_per_mm"
        yield _Number(size, direction, along.relaxed_parts, attrgetter("relaxed_interval_mm"))
        first = along.strain_parts(0.0)
        yield _Number(modulus, direction, first, attrgetter("modulus_interval_n_per_mm"))
        across = along.poisson_parts
        yield _Number(f"poisson_{ratio}", direction, across, attrgetter("poisson_interval"))
        for force in PULLS_N_PER_MM.values():
            parts, interval_of = along.strain_parts(force), partial(_strains, force)
            yield _Number(f"strain_{direction}", direction, parts, interval_of, force)


def unexpected(points: Iterable[StretchPoint], material: Material) -> str:
    """Where a pull lies farthest from what its fabric was expected to do, and what to check.

    Parameters
    ----------
    points : of a pull, of fabrics that the material has.

    Returns
    -------
    A sentence; empty if no point lies outside of its 99 % interval.
    """
    farthest, text = SURPRISING, ""
    for point in points:
        along = predict_pure(point.fabric, material).along(point.direction)
        low, high = map(float, along.strain_interval(point.force_n_per_mm))
        off = abs(math.log(point.strain_along**2 / (low * high))) / math.log(high / low)
        if off > farthest:
            farthest = off
            text = (
                f"At {point.force_n_per_mm:g} N/mm the strip stretched {point.strain_along:.0%} "
                f"along its {LINES[point.direction]}; {low:.0%} to {high:.0%} was expected. Check "
                "yarn, fabric, direction, width and length; if they are right, pull a second strip "
                "before you rely on this one."
            )
    return text


def _strains(n_per_mm: float, along: Along) -> Interval:
    return _pulled(along)[n_per_mm]


@lru_cache(maxsize=16)
def _pulled(along: Along) -> dict[float, Interval]:
    """Intervals of the strain at all pulls of a hand, which are computed together."""
    pulls = list(PULLS_N_PER_MM.values())
    ends = zip(*along.strain_interval(pulls), strict=True)
    return {
        pull: Interval(float(low), float(high))
        for pull, (low, high) in zip(pulls, ends, strict=True)
    }


def _yarn(chart: StitchChart | SymbolChart, material: Material) -> Iterator[Narrowing]:
    """The yarn in a stitch, which a scale tells, or ten stitches unravelled."""
    if not has_loop_length(material):
        return
    mean, now = mean_yarn(chart, material)
    left = mean_yarn(chart, material, MeasuredYarn(mean))[1]
    how = "weigh your swatch, or unravel ten stitches"
    shares = {Part.YARN_PER_STITCH: 1.0}
    yield Narrowing("yarn_per_stitch_mm", None, shares, now, Remedy.WEIGH, how, left)


def _width(interval: Interval) -> float:
    return interval.high - interval.low
