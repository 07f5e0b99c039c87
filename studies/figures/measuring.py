"""Draw the figures of the pages on fitting, measuring, estimating and pressure.

    python -m studies.figures.measuring

Everything is computed from the library or from made measurements; no measured data is needed.
"""

import numpy as np

from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.least_squares import fit_direction
from knitcore.law.uniaxial import uniaxial_response
from knitcore.materials import material
from knitcore.materials.estimate.mixed_model import leave_one_out
from knitcore.materials.estimate.yarn_statistics import library_table, mask_of
from knitcore.measure.heavy_elastica import heavy_elastica
from knitcore.mechanics.pressure import MMHG_PER_KPA, limb_pressure
from studies.figures.plot import FABRICS, INKS, MUTED, chart, diagonal, logarithmic, save

LIMB_MM = 180.0


def fit() -> None:
    """A made test of acrylic garter with the noise of real ones (1.5 % of the peak)."""
    law = material("acrylic").law(Fabric.GARTER)
    random = np.random.default_rng(1)
    axes = chart("strain", "stress, N/mm", xlim=(0, 0.75), ylim=(0, 0.2))
    for direction, colour in zip(Direction, INKS, strict=False):
        curve = uniaxial_response(
            law, direction, np.linspace(0, 0.7 * law.lock_up_strain(direction), 150)
        )
        stress = curve.stress + 0.015 * curve.stress.max() * random.normal(size=150)
        ratio = law.poisson_xy if direction is Direction.COURSE else law.poisson_yx
        fitted = fit_direction(curve.strain, curve.transverse_strain, stress, np.ones(150), ratio)
        stress_of_fit = fitted.stress(curve.strain, curve.transverse_strain, ratio)
        axes.plot(curve.strain, stress, ".", color=colour, alpha=0.5)
        axes.plot(curve.strain, stress_of_fit, color=colour, label=f"{direction}-wise")
        axes.axline((0, 0), slope=law.modulus(direction), color=colour, linestyle=":")
    axes.plot([], [], ":", color=MUTED, label="initial modulus")
    axes.legend()
    save(axes, "fit")


def hanging_yarn() -> None:
    """Shapes of a yarn that hangs over an edge, by its weight against its stiffness."""
    axes = chart("distance from the clamp / L", "depth / L", xlim=(0, 1.1), ylim=(-1, 0.02))
    for load in (3, 10, 30, 100, 1000):
        _, x, y = heavy_elastica(load)
        axes.plot(x[::8], -y[::8], color=INKS[0])
        axes.annotate(f"{load}", (x[-1], -y[-1]), (4, 4), textcoords="offset points", color=MUTED)
    axes.text(0.98, 0.95, "at the tip: Γ = w L³ / B", transform=axes.transAxes, ha="right")
    save(axes, "hanging-yarn")


def left_out_moduli() -> None:
    """Predicted from one stockinette swatch against measured, all yarns left out in turn."""
    table = library_table()
    predicted, _ = leave_one_out(table.modulus, mask_of((Fabric.STOCKINETTE,)))
    axes = chart("measured modulus, N/mm", "predicted modulus, N/mm")
    logarithmic(axes, (0.001, 0.01, 0.1, 1), (0.001, 0.01, 0.1, 1))
    diagonal(axes)
    for factor in (0.5, 2):
        axes.axline((1, factor), (2, 2 * factor), color=MUTED, linestyle=":", linewidth=1)
    for place, fabric in enumerate(Fabric):
        if fabric is Fabric.STOCKINETTE:
            continue
        measured, estimated = (
            np.exp((logs + table.scale)[:, place]).ravel() for logs in (table.modulus, predicted)
        )
        axes.plot(measured, estimated, "o", color=FABRICS[fabric], label=fabric)
    axes.plot([], [], ":", color=MUTED, label="twice and half")
    axes.legend()
    save(axes, "left-out")


def pressure() -> None:
    """Pressure of a tube on a limb over its strain."""
    law = material("glove-wool:glove").law(Fabric.STOCKINETTE)
    strains = np.linspace(0.005, 0.3, 60)
    pressures = [
        limb_pressure(law, Direction.WALE, LIMB_MM / (1 + strain), LIMB_MM).mmhg
        for strain in strains
    ]
    stress = uniaxial_response(law, Direction.WALE, strains).stress
    axes = chart("strain around the limb", "mmHg at C = 180 mm", xlim=(0, 0.3), ylim=(0, 300))
    axes.plot(strains, [p.high for p in pressures], color=INKS[0], label="axially fixed")
    axes.plot(strains, [p.low for p in pressures], "--", color=INKS[0], label="axially free")
    force_over_area = stress / LIMB_MM * 1000 * MMHG_PER_KPA
    axes.plot(strains, force_over_area, ":", color=INKS[4], label="force over area")
    axes.legend()
    save(axes, "pressure")


if __name__ == "__main__":
    fit()
    hanging_yarn()
    left_out_moduli()
    pressure()
