"""Models of the yarn against knitted fabric: ``python -m studies.against_knitted``.

Yarn level and reduced symmetry, for the four pure fabrics of acrylic and cotton as measured:
relaxed width and height, strain at four stresses, and moduli. Prints rms factors; the logarithms
are the deviations that :mod:`knitcore.materials.law_uncertainty` gives these models.
"""

import numpy as np

from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials import material
from knitcore.mechanics.reduced_symmetry import rs_fabrics
from knitcore.yarn.library.store import stored_stitch

STRESSES = np.array([0.05, 0.1, 0.2, 0.3])
YARNS = ("acrylic", "cotton")


def errors() -> dict[str, np.ndarray]:
    """Logarithms of simulated over measured values: sizes (16,), strains (16, stresses), moduli."""
    sizes: list[float] = []
    free_sizes: list[float] = []
    strains, moduli = [], []
    for yarn in YARNS:
        knitted, model = material(yarn), rs_fabrics(yarn)
        for fabric in Fabric:
            stored = stored_stitch(StitchChart.of_fabric(fabric, 2, 2), yarn)
            assert stored is not None
            assert stored.law is not None
            assert stored.unmirrored is not None
            record = knitted.record(fabric)
            for direction in Direction:
                knitted_mm = record.stitch_size_mm(direction)
                for shape, ratios in ((stored, sizes), (stored.unmirrored, free_sizes)):
                    size = direction.of(shape.cell_course_mm, shape.cell_wale_mm)
                    ratios.append(size / knitted_mm)
                strains.append(
                    free_strains_at_stress(stored.law, direction, STRESSES)
                    / free_strains_at_stress(record.law, direction, STRESSES)
                )
                modulus = model[fabric].segment(direction).modulus_n_per_mm
                moduli.append(modulus / record.law.modulus(direction))
    return {
        "yarn level, relaxed sizes": np.log(sizes),
        "yarn level, sizes without mirrors": np.log(free_sizes),
        "yarn level, strains": np.log(strains),
        "reduced symmetry, moduli": np.log(moduli),
    }


def rms(logs: np.ndarray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(logs**2)))


def main() -> None:
    for name, logs in errors().items():
        print(f"{name:33} rms {rms(logs):.3f}, factor {np.exp(rms(logs)):.2f}, {logs.size} values")


if __name__ == "__main__":
    main()
