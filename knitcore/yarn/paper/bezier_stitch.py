"""The energy of one stitch as a function of its fabric's unknowns."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.kernels.structures import ContactLaw
from knitcore.yarn.model.conventions import REGULARISATION_N_MM4, Convention
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.paper import bezier_contact as contact
from knitcore.yarn.paper import bezier_shape as shape
from knitcore.yarn.paper import elastic


def shown_chart(fabric: Fabric) -> StitchChart:
    """The repeat as its centre lines show it: the ansatz is seen from the back."""
    return StitchChart.of_fabric(fabric).repeat().swap()


def published_fabric(chart: StitchChart) -> Fabric:
    """The pure fabric that a chart repeats.

    Raises
    ------
    InputError
        If it is a mixed one, for which there is no published ansatz.
    """
    for fabric in Fabric:
        if chart.canonical() == shown_chart(fabric).canonical():
            return fabric
    raise InputError(
        "branch",
        "the published branch covers the four pure fabrics only.",
        "Use mirrored or free for this chart.",
    )


@dataclass(frozen=True, eq=False)
class Evaluation:
    """Energy terms of a stitch and their derivatives by its unknowns.

    Parameters
    ----------
    bending_n_mm : bending with regularisation, N·mm.
    contact_n_mm : contact, N·mm.
    gradient : derivative of the sum, N or N·mm by unknown, shape (unknowns,).
    lengths_mm : lengths of the eight curves in yarn order, mm.
    length_gradient : their derivatives, shape (8, unknowns).
    closest_mm : smallest distance of two points of yarn that interact, mm (huge if none do).
    """

    bending_n_mm: float
    contact_n_mm: float
    gradient: Array
    lengths_mm: Array
    length_gradient: Array
    closest_mm: float

    @property
    def energy_n_mm(self) -> float:
        """Energy of the stitch, N·mm."""
        return self.bending_n_mm + self.contact_n_mm


@dataclass(frozen=True, eq=False)
class Stitch:
    """One stitch of a pure fabric in the published description.

    Parameters
    ----------
    fabric : the fabric.
    yarn : its yarn.
    convention : factors of the energy.
    """

    fabric: Fabric
    yarn: YarnModel
    convention: Convention = Convention.PUBLISHED
    ties: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "ties", shape.ties(self.fabric))

    @property
    def size(self) -> int:
        """Number of unknowns; the last two are the cell's sizes, mm."""
        return int(self.ties.shape[1])

    @cached_property
    def contact_law(self) -> ContactLaw:
        """Constants of the contact for its kernel."""
        yarn = self.yarn
        return ContactLaw(
            self.convention.unordered_pair_factor, yarn.contact_stiffness_n_per_mm3,
            yarn.contact_exponent, yarn.radius_mm, yarn.core_radius_mm,
        )  # fmt: skip

    def controls(self, unknowns: Array) -> Array:
        """Control points, mm, shape (8, 6, 3), in yarn order."""
        p = (self.ties @ unknowns).astype(np.complex128)
        points = shape.control_points(p, self.fabric.course_odd, self.fabric.wale_odd)
        return np.ascontiguousarray(points.real)

    def centre_line(self, unknowns: Array, points_a_curve: int = 12) -> Array:
        """Centre line of the stitch, mm, shape (8 * points_a_curve + 1, 3)."""
        t = np.arange(points_a_curve) / points_a_curve
        controls = self.controls(unknowns)
        line = np.einsum("tk,ckd->ctd", elastic.bernstein(t), controls).reshape(-1, 3)
        return np.vstack([line, controls[-1, -1]])

    def centre_lines(self, unknowns: Array) -> Array:
        """Centre lines of the fabric's repeat, mm, shape (courses, points, 3), bottom first."""
        course_odd, wale_odd = self.fabric.course_odd, self.fabric.wale_odd
        line = self.centre_line(unknowns)
        course = line
        if course_odd:
            course = np.vstack([line[:-1], line * (1.0, 1.0, -1.0) + (unknowns[-2], 0.0, 0.0)])
        if not wale_odd:
            return course[None]
        return np.stack([course, course * (1.0, 1.0, -1.0) + (0.0, unknowns[-1], 0.0)])

    def evaluate(self, unknowns: Array) -> Evaluation:
        """Energy, lengths and their gradients."""
        course_odd, wale_odd = self.fabric.course_odd, self.fabric.wale_odd
        parameters = self.ties @ unknowns
        controls, jacobian = shape.control_points_and_jacobian(parameters, course_odd, wale_odd)
        gradient = np.zeros_like(controls)
        lengths, length_gradient = np.empty(len(controls)), np.empty_like(controls)
        yarn, convention = self.yarn, self.convention
        bending = elastic.elastic_energy(
            controls,
            convention.bending_factor * yarn.bending_modulus_n_mm2,
            convention.regularisation_factor * REGULARISATION_N_MM4,
            *elastic.gauss_tables(),
            gradient,
            lengths,
            length_gradient,
        )
        cell_gradient = np.zeros(2)
        touch, closest = contact.curve_contact_energy(
            controls,
            (parameters[shape.CELL_COURSE], parameters[shape.CELL_WALE]),
            (course_odd, wale_odd),
            contact.course_images(self.fabric),
            self.contact_law,
            *contact.midpoint_tables(),
            gradient,
            cell_gradient,
        )
        by_parameter = jacobian.reshape(shape.COUNT, -1) @ gradient.ravel()
        by_parameter[shape.CELL_COURSE :] += cell_gradient
        lengths_by_parameter = np.einsum("pckd,ckd->cp", jacobian, length_gradient)
        return Evaluation(
            bending,
            touch,
            by_parameter @ self.ties,
            lengths,
            lengths_by_parameter @ self.ties,
            closest,
        )
