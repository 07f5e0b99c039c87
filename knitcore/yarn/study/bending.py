"""Bending, shear and curl of a relaxed repeat, by linear response of its cell.

:mod:`knitcore.yarn.study.bent_cell` has the derivation. Friction is not modelled; fabric that has
not been shaken out is stiffer.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from knitcore.base.choice import Choice
from knitcore.base.errors import Cancelled, ConvergenceError, UnravelledError
from knitcore.base.gravity import STANDARD_GRAVITY_M_PER_S2
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import check_stitches
from knitcore.yarn.solve.splines import RelaxedRepeat
from knitcore.yarn.study.bent_cell import BendingResponse, settled
from knitcore.yarn.study.lowest import FOLLOWED_UP_TO, can_be_followed, without_mirrors

FAR_APART = 1.5
"""Factor between the two states' rigidities from which on a rigidity is a range."""
MAX_STITCHES = 36
"""Largest repeat; the unknowns fill a dense matrix."""
ROLLS_FROM = 0.5
"""Half thickness times natural curvature from which free edges roll up."""
OBLIQUE = np.pi / 4.0
"""Angle from the course of the diagonals along which a repeat is bent too, rad."""


class Curl(Choice):
    """How the free edges across a direction curl."""

    FLAT = "flat"
    FRONT = "front"
    BACK = "back"


@dataclass(frozen=True)
class FabricBending:
    """Bending and shear of a relaxed repeat, without friction.

    Parameters
    ----------
    course, wale : bent along the rows, and along the columns.
    oblique : bent along the diagonals that rise and fall to the right, at 45°.
    twist_n_mm : rigidity of twist D₆₆, N·mm: twisting by κ_xy costs 2 D₆₆ κ_xy² per area, both
        sizes free.
    coupling_n_mm : D₁, N·mm: curvatures along both directions at once cost D₁ κ_x κ_y more per area
        than the two one by one.
    shear_modulus_n_per_mm : resistance to moving the courses sideways, both sizes free, N/mm.
    thickness_mm : extent of the yarn across the fabric.
    minimum : whether the state is a minimum without the symmetries that were imposed on it. Where
        it is not, oblique bending, twist, coupling and shear are None; bending along rows and
        columns keeps these symmetries and is still given.
    """

    course: BendingResponse
    wale: BendingResponse
    oblique: tuple[BendingResponse, BendingResponse] | None
    twist_n_mm: float | None
    coupling_n_mm: float | None
    shear_modulus_n_per_mm: float | None
    thickness_mm: float
    minimum: bool

    @property
    def curl_course(self) -> Curl:
        """How the sides curl."""
        return self._curl(self.course)

    @property
    def curl_wale(self) -> Curl:
        """How the top and bottom curl."""
        return self._curl(self.wale)

    @property
    def curl(self) -> str:
        """Curling of the free edges, in words."""
        edges = (("the sides roll", self.curl_course), ("top and bottom roll", self.curl_wale))
        rolling = [f"{edge} to the {where}" for edge, where in edges if where is not Curl.FLAT]
        return ", ".join(rolling) or "lies flat"

    def _curl(self, response: BendingResponse) -> Curl:
        """Fabric rolls up where its curvature would bring its surfaces together: κ t / 2 ~ 1."""
        tightness = 0.5 * self.thickness_mm * response.curvature_per_mm
        if abs(tightness) < ROLLS_FROM:
            return Curl.FLAT
        return Curl.BACK if tightness > 0.0 else Curl.FRONT

    def unstable(self) -> FabricBending:
        """Bending of a state that is a minimum in its repeat, but not in a larger cell."""
        return replace(
            self, oblique=None, twist_n_mm=None, coupling_n_mm=None, shear_modulus_n_per_mm=None,
            minimum=False,
        )  # fmt: skip

    def mirror_image(self) -> FabricBending:
        """Exchange left and right."""
        return self if self.oblique is None else replace(self, oblique=self.oblique[::-1])

    def swapped(self) -> FabricBending:
        """Exchange knits and purls: front and back."""
        oblique = self.oblique
        return replace(
            self,
            course=self.course.swapped(),
            wale=self.wale.swapped(),
            oblique=None if oblique is None else (oblique[0].swapped(), oblique[1].swapped()),
        )


@dataclass(frozen=True)
class RepeatBending:
    """Bending of a repeat with its symmetries, and without them where it has a lower shape.

    Parameters
    ----------
    mirrored : with the symmetries of the chart; None where it was refused, for the reason in
        ``failure``.
    unmirrored : of the minimum that the instability leads to; None where there is no instability,
        where it was not followed, or where it was refused (``unmirrored_failure``).
    """

    mirrored: FabricBending | None
    unmirrored: FabricBending | None = None
    failure: str = ""
    unmirrored_failure: str = ""

    def mirror_image(self) -> RepeatBending:
        """Exchange left and right."""
        return self._changed(FabricBending.mirror_image)

    def swapped(self) -> RepeatBending:
        """Exchange knits and purls: front and back."""
        return self._changed(FabricBending.swapped)

    def _changed(self, change: Callable[[FabricBending], FabricBending]) -> RepeatBending:
        states = [state and change(state) for state in (self.mirrored, self.unmirrored)]
        return replace(self, mirrored=states[0], unmirrored=states[1])

    @property
    def shown(self) -> FabricBending:
        """The bending to report: with symmetries if possible.

        Raises
        ------
        ConvergenceError
            If no state has positive rigidities.
        """
        bending = self.mirrored or self.unmirrored
        if bending is None:
            raise ConvergenceError(" ".join(filter(None, (self.failure, self.unmirrored_failure))))
        return bending

    @property
    def stable(self) -> FabricBending:
        """``shown`` if its state is a minimum, else of the minimum that it leads to, if known."""
        shown = self.shown
        return shown if shown.minimum else self.unmirrored or shown

    @property
    def ratios(self) -> tuple[float, float] | None:
        """Rigidities without symmetries over those with them, along the rows and the columns; None
        unless both are known."""
        if self.mirrored is None or self.unmirrored is None:
            return None
        return (
            self.unmirrored.course.rigidity_n_mm / self.mirrored.course.rigidity_n_mm,
            self.unmirrored.wale.rigidity_n_mm / self.mirrored.wale.rigidity_n_mm,
        )

    @property
    def far_apart(self) -> dict[Direction, float]:
        """Directions in which the two states' rigidities differ much, and by which factor.

        There the rigidity is a range rather than a value.
        """
        apart = {d: max(r, 1.0 / r) for d, r in zip(Direction, self.ratios or (), strict=False)}
        return {d: factor for d, factor in apart.items() if factor > FAR_APART}


def weight_n_per_mm2(
    linear_density_g_per_m: float, loop_length_mm: float, stitch_area_mm2: float
) -> float:
    """Return the weight per area, N/mm², of cloth with so much yarn in a stitch."""
    return (
        1e-6 * STANDARD_GRAVITY_M_PER_S2 * linear_density_g_per_m * loop_length_mm / stitch_area_mm2
    )


def bending_length_mm(rigidity_n_mm: float, weight_n_per_mm2: float) -> float:
    """Peirce's bending length, (D / w)^(1/3): half the length that hangs over an edge at 41.5°.

    Parameters
    ----------
    rigidity_n_mm : bending rigidity D, a moment per width over a curvature.
    weight_n_per_mm2 : weight w per area.

    Peirce, "The handle of cloth as a measurable quantity", J. Text. Inst. 21 (1930) T377.

    Examples
    --------
    >>> round(bending_length_mm(0.033, 250e-6 * 9.81e-3))  # 250 g/m²
    24
    """
    return math.cbrt(rigidity_n_mm / weight_n_per_mm2)


def bending_response(relaxed: RelaxedRepeat) -> FabricBending:
    """Moments, bending rigidities and shear modulus of a relaxed repeat.

    Parameters
    ----------
    relaxed : a repeat free of force, of either branch; symmetries imposed on it are dropped.

    Raises
    ------
    InputError
        If the repeat is held, or too large.
    ConvergenceError, UnravelledError
        If the repeat is not in equilibrium without its symmetries, or folds spontaneously: a
        rigidity along rows or columns is not positive. :func:`repeat_bending` also follows it to
        the minimum that it then goes to.
    """
    check_stitches(relaxed.chart.stitches, MAX_STITCHES, "its repeat")
    cell = settled(relaxed)
    course, wale = cell.bent(0.0), cell.bent(0.5 * np.pi)
    if min(course.rigidity_n_mm, course.held_n_mm, wale.rigidity_n_mm, wale.held_n_mm) <= 0.0:
        raise ConvergenceError(
            "The relaxed repeat folds spontaneously: a bending rigidity is not positive."
        )
    minimum = cell.is_minimum()
    extent = np.ptp(cell.curve[:, 0, 2]) + 2.0 * relaxed.yarn.radius_mm
    return FabricBending(
        course=course,
        wale=wale,
        oblique=(cell.bent(OBLIQUE), cell.bent(-OBLIQUE)) if minimum else None,
        twist_n_mm=cell.twisted() if minimum else None,
        coupling_n_mm=cell.coupled() if minimum else None,
        shear_modulus_n_per_mm=cell.sheared() if minimum else None,
        thickness_mm=float(extent),
        minimum=minimum,
    )


def repeat_bending(relaxed: RelaxedRepeat, *, cancelled: Cancelled | None = None) -> RepeatBending:
    """Bending of a mirrored repeat, and of the minimum that its instability leads to.

    Parameters
    ----------
    relaxed : free of force. Its instability is followed in free cells of up to ``MAX_STITCHES``
        stitches, or up to ``FOLLOWED_UP_TO`` if it can be bent as it is.

    Raises
    ------
    InputError
        If the repeat is held, or too large.
    CancelledError
        If ``cancelled`` says so.
    """
    mirrored = unmirrored = None
    failure = unmirrored_failure = ""
    try:
        mirrored = bending_response(relaxed)
    except (ConvergenceError, UnravelledError) as error:
        failure = str(error)
    if can_be_followed(relaxed, MAX_STITCHES if mirrored is None else FOLLOWED_UP_TO):
        try:
            followed = without_mirrors(relaxed, cancelled=cancelled)
            if not followed.minimum:
                if mirrored is not None:
                    mirrored = mirrored.unstable()
                unmirrored = bending_response(followed.state)
        except (ConvergenceError, UnravelledError) as error:
            unmirrored_failure = str(error)
    return RepeatBending(mirrored, unmirrored, failure, unmirrored_failure)
