"""Buckling along a stretch, as the paper shows it for acrylic seed (Supplementary Fig. 8).

Stitches leave the plane to escape compression: the shape jumps, and against the general trend of a
stretch the share of contact and the stress fall.
"""

from __future__ import annotations

from dataclasses import dataclass

from knitcore.yarnlevel.results import FloatArray, RelaxedCell, Sweep


@dataclass(frozen=True)
class Buckling:
    """One buckling event; each pair of numbers holds the points before and after it.

    Parameters
    ----------
    index : number of the first point after it.
    strain, stress_n_per_mm, transverse_strain, contact_share : the curve around it.
    thickness_mm : extent of the centre line across the fabric, mm.
    """

    index: int
    strain: tuple[float, float]
    stress_n_per_mm: tuple[float, float]
    transverse_strain: tuple[float, float]
    contact_share: tuple[float, float]
    thickness_mm: tuple[float, float]


def find_buckling(sweep: Sweep) -> tuple[Buckling, ...]:
    """Jumps of a sweep at which stress and contact share both fall."""
    found = []
    for i in sweep.jumps:
        pair = slice(i - 1, i + 1)
        stress, share = sweep.stress_n_per_mm[pair], sweep.contact_share[pair]
        if stress[1] < stress[0] and share[1] < share[0]:
            found.append(
                Buckling(
                    i,
                    _two(sweep.strain[pair]),
                    _two(stress),
                    _two(sweep.transverse_strain[pair]),
                    _two(share),
                    (_thickness(sweep.cells[i - 1]), _thickness(sweep.cells[i])),
                )
            )
    return tuple(found)


def _two(values: FloatArray) -> tuple[float, float]:
    return float(values[0]), float(values[1])


def _thickness(cell: RelaxedCell) -> float:
    return float(cell.centre_lines[..., 2].max() - cell.centre_lines[..., 2].min())
