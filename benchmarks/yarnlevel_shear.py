"""The shear of a repeat at the yarn level at large angles, free of force: ``python -m
benchmarks.yarnlevel_shear [K] [acrylic]`` (chart of a repeat and material; some 30 s of CPU).

The relaxed cell is skewed in small steps, each balanced by Newton's method with the Hessian of the
skewed cell (central differences of its gradient). Printed are the angle, the modulus that gives the
energy stored so far, over that at rest, and the least curvature of the energy (below 0 the state is
not a minimum).
"""

from __future__ import annotations

import sys

import numpy as np
from scipy.linalg import null_space

from knitcore.arrays import Array
from knitcore.chart import StitchChart
from knitcore.errors import ConvergenceError
from knitcore.materials import material
from knitcore.yarnlevel.bent_cell import BentCell, Deformation, Lagrangian, settled
from knitcore.yarnlevel.energy import CellEnergy
from knitcore.yarnlevel.relax import relax
from knitcore.yarnlibrary.yarns import yarn_for

STEP, MOST = 0.02, 0.42
DIFFERENCE_MM = 1e-6
REACH = 1.6
"""Pairs are listed to this many diameters: a skew brings samples nearer than they are listed."""
STRIDE = 0.15
"""Longest Newton step, in radii."""
MAX_STEPS = 25


class SkewedCell(BentCell):
    """A cell at a state, without factors of the flat one."""

    def __init__(self, energy: CellEnergy, state: Array, tension: Array) -> None:
        self.energy, self.state, self.tension = energy, state, tension
        self.curve = energy.curve(state)
        reach = REACH * 2.0 * energy.yarn.radius_mm
        self._pairs, self._start = energy.pairs(self.curve, state, reach)

    def at(self, skew: float) -> Lagrangian:
        """Energy and gradient at a skew."""
        return self.lagrangian(Deformation(skew=skew))

    def hessian(self, skew: float) -> Array:
        """Second derivatives of the energy by the unknowns."""
        changed = []
        for unit in DIFFERENCE_MM * np.eye(len(self.state)):
            ends = [SkewedCell(self.energy, self.state + d, self.tension) for d in (unit, -unit)]
            up, down = (end.at(skew).gradient for end in ends)
            changed.append((up - down) / (2 * DIFFERENCE_MM))
        return (np.array(changed) + np.transpose(changed)) / 2

    def held(self) -> Array:
        """Derivatives of what is held: lengths, the place of the cell, samples along the yarn."""
        slope = self.energy.derivatives(
            self.state, self.curve, self._pairs, self._start, self.tension
        )
        return np.concatenate([slope.lengths, self._rules()])


def balanced(cell: SkewedCell, skew: float) -> tuple[SkewedCell, float, float]:
    """The cell in balance at a skew, its energy, and the least curvature of that."""
    for _ in range(MAX_STEPS):
        here, hessian, held = cell.at(skew), cell.hessian(skew), cell.held()
        unknowns, lengths = len(cell.state), len(here.excess_mm)
        off = np.zeros(len(held))
        off[:lengths] = here.excess_mm
        system = np.block([[hessian, held.T], [held, np.zeros((len(held), len(held)))]])
        change = np.linalg.solve(system, -np.concatenate([here.gradient, off]))
        step, pull = change[:unknowns], change[unknowns : unknowns + lengths]
        longest = float(np.abs(step).max()) / cell.energy.yarn.radius_mm
        share = min(1.0, STRIDE / longest)
        cell = SkewedCell(cell.energy, cell.state + share * step, cell.tension + share * pull)
        if longest < 1e-7:
            free = null_space(held)
            return cell, here.value, float(np.linalg.eigvalsh(free.T @ hessian @ free)[0])
    raise ConvergenceError(f"The cell finds no balance at a skew of {skew:.3f}.")


def main() -> None:
    text, name = (sys.argv[1:] + ["K", "acrylic"][len(sys.argv) - 1 :])[:2]
    chart = StitchChart.parse(text)
    used = yarn_for(material(name), chart)
    rest = settled(relax(chart, used.yarn, used.loop_length_mm, branch="mirrored"))
    modulus = rest.sheared()
    print(f"at rest {modulus:.4f} N/mm")
    cell, least, _ = balanced(SkewedCell(rest.energy, rest.state, rest.tension), 0.0)
    for skew in np.arange(STEP, MOST, STEP):
        cell, energy, curvature = balanced(cell, float(skew))
        angle = float(np.arctan(skew))
        secant = 2 * (energy - least) / rest.area_mm2 / angle**2
        print(
            f"angle {angle:.3f}  secant over that at rest {secant / modulus:.3f}  {curvature:.1e}"
        )


if __name__ == "__main__":
    main()
