"""Three standard tests of a fabric: a strip at any angle, biaxial stretch and a hinged frame."""

import math
from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_range
from knitcore.base.errors import Cancelled, InputError, Progress
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart, as_chart
from knitcore.cloth.cut.conditions import MAX_SHEAR_ANGLE, Framed, Held, frame_rate
from knitcore.cloth.cut.cut_cloth import Cloth, cloth_under
from knitcore.cloth.cut.cut_piece import solve
from knitcore.cloth.cut.cut_results import PieceTest
from knitcore.cloth.cut.cut_uncertainty import force_log_sd
from knitcore.cloth.cut.outline import CutPiece
from knitcore.cloth.flat.strip import LOCK_UP_SHARE, MAX_STRAIN
from knitcore.materials import Material, as_material
from knitcore.prediction.size import RelaxedSize

STRETCH = "a stretch that can be computed"
MIN_STRAIN = 1e-9
"""Smallest strain of a test; the forces of smaller ones are lost in rounding."""


@dataclass(frozen=True, eq=False, repr=False)
class BiasTest(Result):
    """A strip cut at an angle and pulled between clamps, along y.

    Attributes
    ----------
    test : the load steps, with all fields.
    strain : clamp to clamp, per step.
    force_n : on the upper clamp along the pull.
    sideways_n : on the upper clamp across the pull: cloth at an angle shears.
    stress_n_per_mm : force per width at rest.
    waist_strain : change of width half-way between the clamps, over the width at rest.
    force_log_sd : standard deviation of the logarithm of the force.
    """

    test: PieceTest
    strain: Array
    force_n: Array
    sideways_n: Array
    stress_n_per_mm: Array
    waist_strain: Array
    force_log_sd: Array


@dataclass(frozen=True, eq=False, repr=False)
class BiaxialTest(Result):
    """A rectangle whose four edges are pulled outwards and slide along themselves.

    Attributes
    ----------
    test : the load steps, with all fields.
    strain_x, strain_y : per step; x is along the rows if the grain is 0.
    force_x_n, force_y_n : on the right and the upper edge.
    stress_x_n_per_mm, stress_y_n_per_mm : forces per length of the edge at rest.
    force_x_log_sd, force_y_log_sd : standard deviations of their logarithms.
    """

    test: PieceTest
    strain_x: Array
    strain_y: Array
    force_x_n: Array
    force_y_n: Array
    stress_x_n_per_mm: Array
    stress_y_n_per_mm: Array
    force_x_log_sd: Array
    force_y_log_sd: Array


@dataclass(frozen=True, eq=False, repr=False)
class TrellisTest(Result):
    """A square in a hinged frame (picture frame) that is pulled at opposite corners.

    Attributes
    ----------
    test : the load steps, with all fields.
    shear_angle : rad, by which the frame's right angle has closed, per step.
    moment_n_mm : work of the frame per shear angle, dE/d gamma.
    force_n : that pulls two opposite corners of the frame apart.
    shear_stress_n_per_mm : the moment over the area at rest.
    force_log_sd : standard deviation of the logarithm of moment, force and stress.
    """

    test: PieceTest
    shear_angle: Array
    moment_n_mm: Array
    force_n: Array
    shear_stress_n_per_mm: Array
    force_log_sd: Array


def bias_test(
    chart: StitchChart | str,
    material: Material | str,
    strain: float,
    *,
    width_mm: float = 50.0,
    length_mm: float = 100.0,
    angle_deg: float = 45.0,
    steps: int = 10,
    shear_modulus: float | None = None,
    size: RelaxedSize | None = None,
    mesh_mm: float | None = None,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
) -> BiasTest:
    """Pull a strip whose rows lie at an angle to the width.

    Parameters
    ----------
    chart : the stitches, repeated over the strip.
    material : yarn and laws.
    strain : last clamp-to-clamp strain.
    width_mm, length_mm : between the free sides, and between the clamps.
    angle_deg : from the width to the rows: 0 pulls along columns, 90 along rows.
    steps : of the load.
    shear_modulus : N/mm, replaces the laws' own.
    size : relaxed size of the mean stitch, if known.
    mesh_mm : length of an element's side.
    progress, cancelled : as for :func:`knitcore.cloth.cut.cut_piece.solve`.

    Raises
    ------
    InputError
        If yarn that runs straight from clamp to clamp cannot stretch so far.
    CancelledError

    Examples
    --------
    >>> from knitcore.materials import material
    >>> acrylic, k = material("acrylic"), StitchChart.parse("K")
    >>> bias = bias_test(k, acrylic, 0.2, steps=2, mesh_mm=10.0)
    >>> along = bias_test(k, acrylic, 0.2, angle_deg=90.0, steps=2, mesh_mm=10.0)
    >>> bool(bias.waist_strain[-1] < along.waist_strain[-1] < 0)
    True
    """
    piece = CutPiece.rectangle(width_mm, length_mm, grain_deg=angle_deg)
    chart, material = as_chart(chart), as_material(material)
    cloth = cloth_under(piece, chart, material, shear_modulus=shear_modulus, size=size)
    check_range("strain", strain, MIN_STRAIN, MAX_STRAIN, what=STRETCH)
    most = LOCK_UP_SHARE * _largest_strain(cloth, width_mm, length_mm, angle_deg)
    if strain > most:
        raise InputError(
            "strain",
            f"{strain:.3g} is too much: rows or columns that run from clamp to clamp lock up.",
            f"Use at most {math.floor(1000 * most) / 1000:.3f}.",
        )
    conditions = [Held("bottom"), Held("top", y_mm=strain * length_mm)]
    test = solve(
        piece, cloth, conditions, steps=steps, mesh_mm=mesh_mm,
        progress=progress, cancelled=cancelled,
    )  # fmt: skip
    force = test.force_n[:, 1]
    return BiasTest(
        test=test,
        strain=test.share * strain,
        force_n=force[:, 1],
        sideways_n=force[:, 0],
        stress_n_per_mm=force[:, 1] / width_mm,
        waist_strain=_waist_strain(test, width_mm),
        force_log_sd=_force_log_sd(test, material, 1, 1),
    )


def biaxial_test(
    chart: StitchChart | str,
    material: Material | str,
    strain_x: float,
    strain_y: float,
    *,
    width_mm: float = 100.0,
    length_mm: float = 100.0,
    grain_deg: float = 0.0,
    steps: int = 10,
    shear_modulus: float | None = None,
    size: RelaxedSize | None = None,
    mesh_mm: float | None = None,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
) -> BiaxialTest:
    """Pull all four edges of a rectangle outwards; each stays straight and slides along itself.

    Parameters
    ----------
    strain_x, strain_y : last strains, at least 0; other parameters as for :func:`bias_test`.
    width_mm, length_mm : of the piece.
    grain_deg : from the x axis to the rows.

    Raises
    ------
    InputError
        If a strain is negative, both are 0, or the cloth cannot stretch so far.
    CancelledError
    """
    check_range("strain_x", strain_x, 0.0, MAX_STRAIN, what=STRETCH)
    check_range("strain_y", strain_y, 0.0, MAX_STRAIN, what=STRETCH)
    if max(strain_x, strain_y) < MIN_STRAIN:
        remedy = f"Give one of {MIN_STRAIN:g} or more."
        raise InputError("strain_x", "both strains are 0, or nearly.", remedy)
    piece = CutPiece.rectangle(width_mm, length_mm, grain_deg=grain_deg)
    chart, material = as_chart(chart), as_material(material)
    cloth = cloth_under(piece, chart, material, shear_modulus=shear_modulus, size=size)
    stretched = piece.turn * (1 + np.array([[strain_x], [strain_y]]))
    for direction, needed in zip(Direction, np.linalg.norm(stretched, axis=0) - 1, strict=True):
        locked = LOCK_UP_SHARE * _lock_up(cloth, direction)
        if needed > locked:
            raise InputError(
                "strain_x",
                f"with strain_y it needs a strain of {needed:.3g} {direction}-wise, where the "
                "cloth locks up.",
                f"That strain may be {locked:.3f} at most.",
            )
    conditions = [
        Held("left", x_mm=0.0, y_mm=None),
        Held("right", x_mm=strain_x * width_mm, y_mm=None),
        Held("bottom", x_mm=None, y_mm=0.0),
        Held("top", x_mm=None, y_mm=strain_y * length_mm),
    ]
    test = solve(
        piece, cloth, conditions, steps=steps, mesh_mm=mesh_mm,
        progress=progress, cancelled=cancelled,
    )  # fmt: skip
    x, y = test.force_n[:, 1, 0], test.force_n[:, 3, 1]
    return BiaxialTest(
        test=test,
        strain_x=test.share * strain_x,
        strain_y=test.share * strain_y,
        force_x_n=x,
        force_y_n=y,
        stress_x_n_per_mm=x / length_mm,
        stress_y_n_per_mm=y / width_mm,
        force_x_log_sd=_force_log_sd(test, material, 1, 0),
        force_y_log_sd=_force_log_sd(test, material, 3, 1),
    )


def trellis_test(
    chart: StitchChart | str,
    material: Material | str,
    shear_angle: float,
    *,
    side_mm: float = 100.0,
    grain_deg: float = 0.0,
    steps: int = 10,
    shear_modulus: float | None = None,
    size: RelaxedSize | None = None,
    mesh_mm: float | None = None,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
) -> TrellisTest:
    """Shear a square in a hinged frame.

    Parameters
    ----------
    shear_angle : rad, by which the frame's right angle closes in the end.
    side_mm : of the square.
    grain_deg : from a bar of the frame to the rows; other parameters as for :func:`bias_test`.

    Raises
    ------
    InputError
        If the angle is not between 0 and 1.2 rad.
    CancelledError
    """
    check_range("shear_angle", shear_angle, MIN_STRAIN, MAX_SHEAR_ANGLE, "rad")
    piece = CutPiece.rectangle(side_mm, side_mm, grain_deg=grain_deg)
    chart, material = as_chart(chart), as_material(material)
    cloth = cloth_under(piece, chart, material, shear_modulus=shear_modulus, size=size)
    conditions = [Framed(edge, shear_angle) for edge in piece.edges]
    test = solve(
        piece, cloth, conditions, steps=steps, mesh_mm=mesh_mm,
        progress=progress, cancelled=cancelled,
    )  # fmt: skip
    angles = test.share * shear_angle
    held = test.constraints.held

    def work(internal: Array, step: int) -> float:
        rate = frame_rate(angles[step]) @ test.nodes_mm
        return float(np.sum(internal[held] * rate[held]))

    moment = np.array([work(e.internal, step) for step, e in enumerate(test.equilibria)])
    # the corners' distance is 2 side cos((90° - angle) / 2)
    return TrellisTest(
        test=test,
        shear_angle=angles,
        moment_n_mm=moment,
        force_n=moment / (side_mm * np.sin((np.pi / 2 - angles) / 2)),
        shear_stress_n_per_mm=moment / side_mm**2,
        force_log_sd=force_log_sd(test, material, work),
    )


def _lock_up(cloth: Cloth, direction: Direction) -> float:
    """The largest lock-up strain of any of the cloth's laws."""
    return max(law.lock_up_strain(direction) for law in cloth.sheet.laws)


def _largest_strain(cloth: Cloth, width: float, length: float, angle_deg: float) -> float:
    """Clamp-to-clamp strain at which fibres that run straight from clamp to clamp lock up."""
    largest = math.inf
    for direction, angle in ((Direction.COURSE, 90.0 - angle_deg), (Direction.WALE, angle_deg)):
        c, s = (abs(f(math.radians(angle))) for f in (math.cos, math.sin))
        if width * c >= length * s:
            reach = (1 + _lock_up(cloth, direction)) ** 2 - s**2
            largest = min(largest, math.sqrt(reach) / c - 1)
    return largest


def _waist_strain(test: PieceTest, width: float) -> Array:
    """Change of width half-way up, over the width at rest, per step."""
    middle = test.nodes_mm[1].mean()
    moved = []
    for edge in ("left", "right"):
        nodes = test.energy.basis.get_dofs(test.mesh.boundaries[edge]).all()
        nodes = nodes[np.argsort(test.nodes_mm[1, nodes])]
        at = test.nodes_mm[1, nodes]
        moved.append([np.interp(middle, at, u[0, nodes]) for u in test.displacement_mm])
    return np.asarray((np.array(moved[1]) - moved[0]) / width)


def _force_log_sd(test: PieceTest, material: Material, condition: int, axis: int) -> Array:
    """Standard deviation of the logarithm of the force of a condition along an axis, per step."""

    def force(internal: Array, _: int) -> float:
        return float(test.constraints.forces(internal, 0.0)[condition, axis])

    return force_log_sd(test, material, force)
