"""Computed against published values for all rows of the tables, and CPU times of the mechanics."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from knitcore import StitchChart, predict
from knitcore.chart.fabric import Direction
from knitcore.materials import load_library, load_variants, material
from knitcore.mechanics.homogenisation import homogenise
from knitcore.mechanics.local_moduli import local_moduli
from knitcore.mechanics.reduced_symmetry import MATERIALS, rs_fabrics


def main() -> None:
    print_rows()
    print_reduced_symmetry()
    print_wide_ribs()
    print_times()


def print_rows() -> None:
    print("Predicted swatches of 31 x 31 against the corrected tables (N/mm)")
    worst = 0.0
    rows = 0
    for yarn in [*load_library().values(), *load_variants().values()]:
        for fabric, record in yarn.fabrics.items():
            if yarn.identifier == "glove-wool:glove":
                continue  # repeats other rows
            prediction = predict(StitchChart.of_fabric(fabric, 31, 31), yarn)
            pairs = [
                (prediction.modulus_course_n_per_mm, record.printed["Y_x"].corrected),
                (prediction.modulus_wale_n_per_mm, record.printed["Y_y"].corrected),
                (prediction.poisson_yx, record.printed["nu_yx"].corrected),
                (prediction.poisson_xy, record.printed["nu_xy"].corrected),
            ]
            worst = max(worst, *(abs(a / b - 1) for a, b in pairs[:2]))
            rows += 1
            cells = "  ".join(f"{a:7.4f} {b:6.3f}" for a, b in pairs)
            print(f"{yarn.identifier:24}{fabric:12}{cells}")
    print(f"{rows} rows, largest deviation of a modulus {100 * worst:.2f} %\n")


def print_reduced_symmetry() -> None:
    print("Reduced symmetry: computed, published, ratio")
    for yarn in MATERIALS:
        for fabric, reduced in rs_fabrics(yarn).items():
            for direction in Direction:
                part = reduced.segment(direction)
                published = part.published_n_per_mm or float("nan")
                print(
                    f"{yarn:8}{fabric:12}{direction:8}{part.geometry.parity:5}"
                    f"{part.modulus_n_per_mm:8.4f}{published:8.3f}"
                    f"{part.modulus_n_per_mm / published:8.3f}"
                )
    print()


def print_wide_ribs() -> None:
    print("2x2 against 1x1 rib: width and extensibility course-wise")
    for yarn in load_library().values():
        wide, narrow = (predict(StitchChart.parse(text), yarn) for text in ("KKPP", "KP"))
        width = (wide.relaxed_course_mm or 0) / (narrow.relaxed_course_mm or 1)
        stretch = wide.extensibility_course_mm_per_n / narrow.extensibility_course_mm_per_n
        print(f"{yarn.identifier:24}{width:6.2f}{stretch:6.2f}")
    print()


def print_times() -> None:
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
