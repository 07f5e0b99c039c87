"""Checks of the input of a relaxation or a stretch."""

from collections.abc import Callable
from math import inf

from knitcore.base.bounds import check_count, check_positive
from knitcore.base.errors import InputError
from knitcore.yarn.model.relaxed_cell import RelaxedCell
from knitcore.yarn.model.yarn_model import YarnModel

MAX_POINTS = 1000
"""Most points of a sweep."""
MIN_LENGTH_PER_RADIUS = 10.0
MIN_LENGTH_PER_CORE = 27.0
"""Shortest loop: a shorter stitch has no room for its own yarn (paper: 13 radii, 34 core radii)."""
MAX_LENGTH_PER_RADIUS = 120.0
_AT_REST = 5e-2
"""Force times size, as a part of the energy, up to which a state counts as free of force (published
garter rests on a constraint of its curves)."""


def check_loop(yarn: YarnModel, loop_length_mm: float) -> None:
    """Refuse a loop length that the yarn cannot have.

    Raises
    ------
    InputError
        Naming a usable bound.
    """
    check_positive("loop_length_mm", loop_length_mm, "mm", "a length")
    least = max(MIN_LENGTH_PER_RADIUS * yarn.radius_mm, MIN_LENGTH_PER_CORE * yarn.core_radius_mm)
    if loop_length_mm < least:
        raise InputError(
            "loop_length_mm",
            f"{loop_length_mm:g} mm of yarn is too short for a stitch of its thickness.",
            f"Give at least {least:.2f} mm, or a thinner yarn.",
        )
    most = MAX_LENGTH_PER_RADIUS * yarn.radius_mm
    if loop_length_mm > most:
        raise InputError(
            "loop_length_mm",
            f"{loop_length_mm:g} mm is too long: the loops would not touch.",
            f"Give at most {most:.2f} mm, or a thicker yarn.",
        )


def check_stitch_size(name: str, size_mm: float | None, loop_length_mm: float) -> None:
    """Refuse a size of the stitch that its yarn cannot span.

    Raises
    ------
    InputError
        Naming a usable range.
    """
    if size_mm is None:
        return
    low, high = 0.05 * loop_length_mm, 0.9 * loop_length_mm
    check_positive(name, size_mm, "mm", "a size of a stitch")
    if not low <= size_mm <= high:
        raise InputError(
            name,
            f"{size_mm:g} mm cannot be reached with {loop_length_mm:g} mm of yarn.",
            f"Give a size from {low:.2f} to {high:.2f} mm.",
        )


def check_stretch(max_strain: float, points: int, max_stress_n_per_mm: float | None) -> None:
    """Refuse a stretch whose strain, points or largest stress cannot be used (inf: no limit).

    Raises
    ------
    InputError
        Naming the value that cannot be used.
    """
    check_positive("max_strain", max_strain, what="a stretch")
    check_count("points", points, 2, MAX_POINTS)
    if max_stress_n_per_mm is not None and max_stress_n_per_mm != inf:
        check_positive("max_stress_n_per_mm", max_stress_n_per_mm, "N/mm", "a limit")


def is_at_rest(relaxed: RelaxedCell) -> bool:
    """Tell whether no force holds its size."""
    sizes = relaxed.cell_course_mm, relaxed.cell_wale_mm
    work = max(abs(f) * size for f, size in zip(relaxed.force_n, sizes, strict=True))
    return work <= _AT_REST * relaxed.energy_n_mm


def check_at_rest(relaxed: RelaxedCell, field: str) -> None:
    """Refuse a state whose size is held: strain and stress would not start from rest.

    Raises
    ------
    InputError
    """
    if not is_at_rest(relaxed):
        raise InputError(
            field,
            f"its size is held by {relaxed.force_n[0]:.3g} and {relaxed.force_n[1]:.3g} N.",
            "Relax it without a prescribed size.",
        )


def check_time(
    stitches: int, seconds_of: Callable[[int], float], time_limit_s: float | None
) -> None:
    """Refuse a cell that would probably take more CPU time than allowed.

    Raises
    ------
    InputError
        Naming a size that would not.
    """
    if time_limit_s is None:
        return
    check_positive("time_limit_s", time_limit_s, "s", "a time")
    if seconds_of(stitches) > time_limit_s:
        fitting = next((n for n in range(stitches, 1, -1) if seconds_of(n) <= time_limit_s), 1)
        raise InputError(
            "chart",
            f"its cell of {stitches} stitches would take about {seconds_of(stitches):.0f} s, more "
            f"than the limit of {time_limit_s:g} s.",
            f"Use a repeat of at most {fitting} stitches, or allow more time.",
        )
