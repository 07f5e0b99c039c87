"""CPU times of predictions, local moduli and homogenisation."""

import time
from collections.abc import Callable

import numpy as np

from knitcore import StitchChart, predict
from knitcore.materials import material
from knitcore.mechanics.homogenisation import homogenise
from knitcore.mechanics.local_moduli import local_moduli


def main() -> None:
    acrylic = material("acrylic")
    random = np.random.default_rng(0)

    def noise(size: int) -> StitchChart:
        return StitchChart(random.random((size, size)) < 0.5)

    small, repeat, medium, large = noise(4), noise(16), noise(100), noise(400)
    jobs: dict[str, Callable[[], object]] = {
        "local moduli, 400 x 400": lambda: _all_maps(local_moduli(large, acrylic)),
        "homogenise 4 x 4": lambda: homogenise(small, acrylic),
        "homogenise 16 x 16": lambda: homogenise(repeat, acrylic),
        "predict 2x2 rib, 31 x 31": lambda: predict(
            StitchChart.parse("KKPP").resized(31, 31), acrylic
        ),
        "predict noise 100 x 100": lambda: predict(medium, acrylic),
        "predict noise 400 x 400": lambda: predict(large, acrylic),
    }
    print("CPU time, best of 5")
    for name, job in jobs.items():
        print(f"{name:32}{1e3 * min(_cpu_seconds(job) for _ in range(5)):8.1f} ms")


def _all_maps(maps: object) -> None:
    for name in ("modulus_course_n_per_mm", "modulus_wale_n_per_mm", "anisotropy"):
        getattr(maps, name)


def _cpu_seconds(job: Callable[[], object]) -> float:
    start = time.process_time()
    job()
    return time.process_time() - start


if __name__ == "__main__":
    main()
