"""A strip of graded jersey on the bias against its measured force.

The data are force bands of Do, Tan, Ramos, Kiendl and Weeger, Composites Part B 2020 (CC BY 4.0):
single jersey of loop length 4.5 and 6.5 mm pulled along the wales, cloth with one half of each
pulled along and across, and the same cloth cut at 45°. The uniform cloth pulled along and the
halves pulled across give the laws; the shear modulus is the one at which the bias strip has its
measured force at 10 %. On the bias both directions stretch at once, which straight pulls do not
show; how each then stiffens the other (kappa) is that of the library's acrylic stockinette, found
in its own tests. Shear that stiffens (``SHEAR_STIFFENING``) was chosen on this strip. The files
tell neither width nor length: 50 mm, and 50 to 200 mm, are assumed. Nor do they tell Poisson's
ratios.
"""

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, least_squares, nnls

from knitcore.chart.fabric import Direction, Fabric
from knitcore.cloth.cut import Cloth, CutPiece, Held, solve
from knitcore.cloth.flat import QuarterGrid, Sheet, SheetModel, pull
from knitcore.cloth.flat.strip import Clamps
from knitcore.fit.strip_fit import ALPHA_SHARE, SHEAR_STIFFENING
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.stiffening import stiffening
from knitcore.law.uniaxial import free_transverse_strains
from knitcore.materials import material

Array = NDArray[np.float64]
Ends = tuple[str, ...]
"""Ends of a measured band that count; their geometric mean is taken."""

WIDTH_MM = 50.0
LENGTHS_MM = (50.0, 100.0, 200.0)
POISSON = (0.2, 0.3, 0.45)
STRAINS = np.array([0.05, 0.1, 0.2, 0.3])
MATCHED = 0.1
"""Strain at which the shear modulus is fitted."""
FITTED = np.linspace(0.02, 0.3, 15)
"""Strains at which laws are fitted to the straight pulls."""
LAWS: dict[str, tuple[bool, float]] = {
    "κ = 0": (False, 0.0),
    "with κ": (True, 0.0),
    "with κ, shear stiffens": (True, SHEAR_STIFFENING),
}
"""By name: whether directions are coupled, and the growth of the shear stiffness, 1/rad²."""
BOTH: Ends = ("low", "high")
FAR_MM = 1000.0
CELLS = 20
"""Cells along each side of a straight strip."""


@dataclass(frozen=True)
class Graded:
    """Laws of the two halves, and the measured force of the bias strip at ``STRAINS``, N."""

    laws: tuple[ConstitutiveLaw, ConstitutiveLaw]
    force_n: Array

    def sheared(self, ratio: float) -> tuple[ConstitutiveLaw, ...]:
        """Laws with a shear modulus of ``ratio`` times the geometric mean of Young's moduli."""
        return tuple(
            replace(law, shear_modulus=ratio * math.sqrt(law.modulus_course * law.modulus_wale))
            for law in self.laws
        )

    def bias_force(self, ratio: float, length_mm: float, strains: Array) -> list[float]:
        """Simulated force, N; the halves meet along a wale through the middle."""
        lines = np.array([-FAR_MM, 0.0, FAR_MM])
        grid = QuarterGrid.between(lines, lines[::2], np.array([[0, 1]], dtype=np.uint8))
        cloth = Cloth(Sheet(grid, self.sheared(ratio), SheetModel()), (-FAR_MM, -FAR_MM))
        piece = CutPiece.rectangle(WIDTH_MM, length_mm, grain_deg=45.0)
        forces = []
        for strain in strains:
            conditions = [Held("bottom"), Held("top", y_mm=strain * length_mm)]
            steps = max(1, round(strain / 0.1))
            test = solve(piece, cloth, conditions, steps=steps, mesh_mm=WIDTH_MM / 4)
            assert test.converged, test.problem
            forces.append(float(test.force_n[-1, 1, 1]))
        return forces

    def matching_ratio(self, length_mm: float) -> float:
        """Shear modulus over the geometric mean of Young's moduli that has the force at 10 %."""
        target = float(np.interp(MATCHED, STRAINS, self.force_n))

        def off(log_ratio: float) -> float:
            (force,) = self.bias_force(math.exp(log_ratio), length_mm, np.array([MATCHED]))
            return math.log(force / target)

        return math.exp(brentq(off, math.log(0.02), math.log(5.0), xtol=0.02))

    def side_by_side_force(self, strains: Array) -> Array:
        """Simulated force, N, with the halves side by side, pulled wale-wise.

        Its ends slide along the clamps: the laws too are those of a strip that strains evenly.
        """
        lines = np.linspace(0.0, WIDTH_MM, CELLS + 1)
        half = np.arange(CELLS) * 2 // CELLS
        grid = QuarterGrid.between(lines, lines, np.tile(half.astype(np.uint8), (CELLS, 1)))
        sheet = Sheet(grid, self.laws, SheetModel())
        test = pull(sheet, Direction.WALE, strains, clamps=Clamps.SLIDING)
        assert test.converged, test.problem
        return test.force_n


def band(folder: Path, name: str, strain: Array, ends: Ends = BOTH) -> Array:
    """Geometric mean of the measured force, N, at the ends of its band."""
    tables = [np.loadtxt(folder / f"test_{name}_{end}.txt") for end in ends]
    logs = [np.log(np.interp(strain, *table.T)) for table in tables]
    return np.asarray(np.exp(np.mean(logs, axis=0)))


def graded(
    folder: Path,
    poisson: float,
    *,
    coupled: bool = True,
    shear_stiffening: float = 0.0,
    ends: Ends = BOTH,
) -> Graded:
    """Laws from the straight tests.

    Parameters
    ----------
    folder : of the force bands.
    poisson : geometric mean of both ratios.
    coupled : whether each direction stiffens the other, as in acrylic stockinette.
    shear_stiffening : growth of the shear stiffness, 1/rad².
    ends : of the measured bands.
    """
    wale = [band(folder, f"const{loop}_ww", FITTED, ends) / WIDTH_MM for loop in (4.5, 6.5)]
    straight = [_fitted(FITTED, stress) for stress in wale]
    # across the halves are in series; their stiffness differs as it does along the wales
    pulled = band(folder, "discont4.5to6.5_cw", FITTED, ends) / WIDTH_MM
    series = float(pulled @ FITTED / (FITTED @ FITTED))
    ratio = straight[0][0] / straight[1][0]
    course = series * (1 + ratio) / 2, series * (1 + ratio) / (2 * ratio)
    laws = [_law(x, poisson, *fit) for x, fit in zip(course, straight, strict=True)]
    if coupled:
        laws = [
            _coupled(law, x, poisson, stress)
            for law, x, stress in zip(laws, course, wale, strict=True)
        ]
    laws = [replace(law, shear_stiffening=shear_stiffening) for law in laws]
    return Graded((laws[0], laws[1]), band(folder, "45deg", STRAINS, ends))


def _law(
    modulus_x: float, poisson: float, modulus_y: float, alpha: float, beta: float
) -> ConstitutiveLaw:
    """A law that stiffens along the wales."""
    held = 1 - poisson**2
    coupling = poisson * math.sqrt(modulus_x * modulus_y) / held
    stiffness = modulus_x / held, modulus_y / held, coupling, coupling
    return ConstitutiveLaw(*stiffness, 0.0, alpha, 0.0, beta)


def _fitted(strain: Array, stress: Array) -> tuple[float, float, float]:
    """Young's modulus (N/mm), alpha and beta (N/mm) of least relative error."""
    best = math.inf, 0.0, 0.0, 0.0
    for alpha in np.linspace(0.05, ALPHA_SHARE, 60) / strain[-1]:
        design = np.column_stack([strain, stiffening(alpha * strain)[1]]) / stress[:, None]
        (modulus, beta), off = nnls(design, np.ones(len(strain)))
        best = min(best, (float(off), float(modulus), float(alpha), float(beta)))
    return best[1:]


def _coupled(
    start: ConstitutiveLaw, modulus_x: float, poisson: float, stress: Array
) -> ConstitutiveLaw:
    """The law fitted anew to a wale-wise pull, now with acrylic stockinette's couplings."""
    jersey = material("acrylic").law(Fabric.STOCKINETTE)

    def law(logs: Array) -> ConstitutiveLaw:
        plain = _law(modulus_x, poisson, *np.exp(logs).tolist())
        return replace(plain, kappa_xx=jersey.kappa_xx, kappa_yy=jersey.kappa_yy)

    def off(logs: Array) -> Array:
        coupled = law(logs)
        across = free_transverse_strains(coupled, Direction.WALE, FITTED)
        return coupled.stress(across, FITTED)[1] / stress - 1

    logs = np.log([start.modulus_wale, start.alpha_yy, start.beta_yy])
    most = np.array([np.inf, math.log(ALPHA_SHARE / FITTED[-1]), np.inf])
    return law(least_squares(off, np.minimum(logs, most - 1e-6), bounds=(-np.inf, most)).x)
