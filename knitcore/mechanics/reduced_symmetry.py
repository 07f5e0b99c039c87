"""The reduced-symmetry (RS) model: moduli of the pure fabrics from the shape of their yarn.

Each connecting segment is a spring (:mod:`knitcore.mechanics.elastica`). An even one stretches
along itself,

    Y_even = 180 B / (v² L lambda²) = 180 B / (v² lambda³ (1 - delta)),   delta = 1 - L / lambda,

an odd one rotates into the plane of the fabric,

    Y_odd = 12 B / (L lambda² sin² phi) (1 + v cot phi)
          = 12 B / (lambda³ (1 - delta)) (1 + v cot phi),   delta = 1 - L sin² phi / lambda.

A stitch has two segments in series course-wise and two pairs side by side wale-wise:

    course, like stitches     Y_even / 2
    course, unlike stitches   1 / (1 / Y_even + 1 / Y_odd), about Y_odd
    wale, like or unlike      2 Y_even, 2 Y_odd

These formulas reproduce all eight published even values. The paper's text has a factor 1 wale-wise
and delta_odd = 1 - L sin phi / lambda; its published values contradict the first, its own formula
for Y_odd the second. No formula reproduces its eight odd values: the results are within a factor of
1.6 of them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.bounds import check_positive
from knitcore.base.errors import InputError
from knitcore.base.kinds import as_numbers
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.result import Result
from knitcore.materials import paper_figures
from knitcore.mechanics.elastica import Parity

_MIN_POINTS = 5

MATERIALS = ("acrylic", "cotton")
"""Yarns whose RS geometry the paper gives (tables 15 and 16)."""


@dataclass(frozen=True)
class SegmentGeometry:
    """Shape of a connecting segment at rest.

    Attributes
    ----------
    parity : even or odd.
    separation_mm : lambda, distance of its ends.
    length_mm : L, yarn between them.
    slope : v, the tangent's component out of the plane of the fabric at the first end, as listed in
        tables 15 and 16; the derivation means the component across the line between the ends, which
        is the same for an even segment only.
    angle_rad : phi, tilt of that line out of the plane of the fabric; None for an even segment.

    Raises
    ------
    InputError
        If a length is not positive, the slope is 0 for an even segment, or an odd segment has no
        angle between 0 and pi / 2.
    """

    parity: Parity
    separation_mm: float
    length_mm: float
    slope: float
    angle_rad: float | None = None

    def __post_init__(self) -> None:
        for name in ("separation_mm", "length_mm"):
            check_positive(name, getattr(self, name), "mm", "a length")
        if not math.isfinite(self.slope) or (self.parity is Parity.EVEN and self.slope == 0):
            raise InputError(
                "slope", f"{self.slope} leaves it rigid.", "Give a slope other than 0."
            )
        if self.parity is Parity.ODD and not (
            self.angle_rad is not None and 0 < self.angle_rad <= math.pi / 2
        ):
            raise InputError(
                "angle_rad",
                f"{self.angle_rad} cannot be used.",
                "Give an angle above 0, up to pi / 2.",
            )

    @classmethod
    def from_curve(cls, parity: Parity, curve_mm: ArrayLike) -> SegmentGeometry:
        """Take the shape from a segment's centre line, such as that of a relaxed yarn-level stitch.

        Parameters
        ----------
        curve_mm : (points, 2) along the pull and out of the plane of the fabric, from one entangled
            region to the next, or (points, 3) with the coordinate across the pull as the third. The
            length is that of all coordinates; everything else is of the first two, as in the paper.

        Raises
        ------
        InputError
            If there are fewer than 5 points or they do not describe a segment.
        """
        remedy = f"Give at least {_MIN_POINTS} points of 2 or 3 coordinates."
        curve = as_numbers("curve_mm", curve_mm, remedy)
        if curve.ndim != 2 or curve.shape[1] not in (2, 3) or len(curve) < _MIN_POINTS:
            raise InputError("curve_mm", f"has the shape {curve.shape}.", remedy)
        length = float(np.linalg.norm(np.diff(curve, axis=0), axis=1).sum())
        points = curve[:, :2]
        chord = points[-1] - points[0]
        separation = float(np.linalg.norm(chord))
        if not (np.isfinite(length) and 0 < separation < length):
            raise InputError(
                "curve_mm", "does not describe a segment.", "Give a curved centre line."
            )
        tangent = -1.5 * points[0] + 2 * points[1] - 0.5 * points[2]  # of second order
        slope = abs(float((tangent / np.linalg.norm(tangent))[1]))
        if parity is Parity.EVEN:
            return cls(parity, separation, length, slope)
        return cls(parity, separation, length, slope, math.atan2(abs(chord[1]), abs(chord[0])))

    @property
    def delta(self) -> float:
        """The dimensionless slack of the rigidity formulas."""
        if self.angle_rad is None:
            return 1 - self.length_mm / self.separation_mm
        return 1 - self.length_mm * math.sin(self.angle_rad) ** 2 / self.separation_mm

    def rigidity_n_per_mm(self, bending_modulus_n_mm2: float) -> float:
        """Spring constant of the segment in the plane, N/mm."""
        check_positive("bending_modulus_n_mm2", bending_modulus_n_mm2, "N·mm²")
        scale = bending_modulus_n_mm2 / (self.separation_mm**3 * (1 - self.delta))
        if self.angle_rad is None:
            return 180 * scale / self.slope**2
        return 12 * scale * (1 + self.slope / math.tan(self.angle_rad))


def stitch_modulus_n_per_mm(
    direction: Direction, parity: Parity, rigidity: float, even_neighbour: float | None = None
) -> float:
    """Modulus of a stitch from the rigidity (N/mm) of its segments, by the assembly above.

    Parameters
    ----------
    even_neighbour : rigidity of the even segment in series with an odd one course-wise; None
        takes it as rigid.
    """
    if direction is Direction.WALE:
        return 2 * rigidity
    if parity is Parity.EVEN:
        return rigidity / 2
    return rigidity if even_neighbour is None else 1 / (1 / rigidity + 1 / even_neighbour)


@dataclass(frozen=True)
class SegmentResult:
    """One direction of a fabric in the RS model.

    Attributes
    ----------
    geometry, rigidity_n_per_mm : the segment and its spring constant.
    modulus_n_per_mm : of the stitch.
    published_n_per_mm : the paper's value, None for your own geometry.
    """

    geometry: SegmentGeometry
    rigidity_n_per_mm: float
    modulus_n_per_mm: float
    published_n_per_mm: float | None = None


@dataclass(frozen=True)
class RSFabric(Result):
    """A pure fabric in the RS model."""

    fabric: Fabric
    course: SegmentResult
    wale: SegmentResult

    @property
    def modulus_course_n_per_mm(self) -> float:
        """Y_x."""
        return self.course.modulus_n_per_mm

    @property
    def modulus_wale_n_per_mm(self) -> float:
        """Y_y."""
        return self.wale.modulus_n_per_mm

    def segment(self, direction: Direction) -> SegmentResult:
        """The segments of a direction."""
        return direction.of(self.course, self.wale)


def rs_fabric(
    fabric: Fabric, course: SegmentGeometry, wale: SegmentGeometry, bending_modulus_n_mm2: float
) -> RSFabric:
    """A pure fabric from the geometry of its segments.

    Raises
    ------
    InputError
        If a segment's parity is not the fabric's.
    """
    for name, odd, segment in (
        ("course", fabric.course_odd, course),
        ("wale", fabric.wale_odd, wale),
    ):
        expected = Parity.ODD if odd else Parity.EVEN
        if segment.parity is not expected:
            raise InputError(
                name,
                f"is {segment.parity}, but {fabric} has {expected} segments.",
                "Exchange the segments along the course and along the wale.",
            )
    return RSFabric(
        fabric,
        _result(Direction.COURSE, course, bending_modulus_n_mm2),
        _result(Direction.WALE, wale, bending_modulus_n_mm2),
    )


def rs_fabrics(material: str) -> Mapping[Fabric, RSFabric]:
    """The four fabrics of a yarn from the paper's geometry (tables 15, 16; B of table 7).

    Raises
    ------
    InputError
        If the paper has no geometry for this yarn.

    Examples
    --------
    >>> round(rs_fabrics("acrylic")[Fabric.STOCKINETTE].modulus_wale_n_per_mm, 3)
    0.528
    """
    key = material.strip().lower()
    if key not in MATERIALS:
        raise InputError(
            "material",
            f"the paper has no RS geometry for {material!r}.",
            f"Use {' or '.join(MATERIALS)}.",
        )
    return {fabric: _published_fabric(key, fabric) for fabric in Fabric}


def _result(
    direction: Direction, segment: SegmentGeometry, bending: float, published: float | None = None
) -> SegmentResult:
    rigidity = segment.rigidity_n_per_mm(bending)
    modulus = stitch_modulus_n_per_mm(direction, segment.parity, rigidity)
    return SegmentResult(segment, rigidity, modulus, published)


def _published_fabric(material: str, fabric: Fabric) -> RSFabric:
    figures = paper_figures()
    bending = figures.get(material, "B", variant="simulation", fabric=fabric).corrected / 1000
    results = {}
    for direction, name in ((Direction.COURSE, "Y_x"), (Direction.WALE, "Y_y")):
        published = figures.get(material, name, variant="rs", fabric=fabric).corrected
        geometry = _published_geometry(material, fabric, direction)
        results[direction] = _result(direction, geometry, bending, published)
    return RSFabric(fabric, results[Direction.COURSE], results[Direction.WALE])


def _published_geometry(material: str, fabric: Fabric, direction: Direction) -> SegmentGeometry:
    figures = paper_figures()

    def value(quantity: str) -> float:
        return figures.get(
            material, quantity, variant="rs", fabric=fabric, direction=direction
        ).corrected

    separation, delta, slope = value("lambda"), value("delta"), value("v")
    odd = direction.of(fabric.course_odd, fabric.wale_odd)
    if not odd:
        return SegmentGeometry(Parity.EVEN, separation, separation * (1 - delta), slope)
    angle = value("phi")
    # The table's delta is the paper's 1 - L sin(phi) / lambda: that gives plausible lengths.
    length = separation * (1 - delta) / math.sin(angle)
    return SegmentGeometry(Parity.ODD, separation, length, slope, angle)
