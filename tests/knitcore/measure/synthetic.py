"""Made measurements of which the truth is known."""

import csv
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import openpyxl
from numpy.typing import NDArray
from PIL import Image
from scipy.ndimage import gaussian_filter

from knitcore import Direction
from knitcore.base.arrays import Array
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import uniaxial_response
from knitcore.measure.heavy_elastica import heavy_elastica

LAW = ConstitutiveLaw(0.241, 0.060, 0.036, 0.029, 1.17, 0.802, 0.022, 0.022)
"""Acrylic garter, table 9."""
WIDTH_MM, LENGTH_MM, PX_PER_MM = 70.0, 90.0, 4.0


def pull(direction: Direction, *, points: int = 400) -> tuple[Array, Array, Array]:
    """(strain along, strain across, stress) of an ideal test up to 0.7 of the lock-up strain."""
    strain = np.linspace(0.0, 0.7 * LAW.lock_up_strain(direction), points)
    curve = uniaxial_response(LAW, direction, strain)
    return curve.strain, curve.transverse_strain, curve.stress


def write_csv(
    path: Path, direction: Direction, *, runs: int = 4, noise: float = 0.0, seed: int = 0
) -> Path:
    random = np.random.default_rng(seed)
    lines = ["run,strain_along,strain_across,force_n,width_mm"]
    for run in range(runs):
        along, across, stress = pull(direction)
        stress = stress * (1 + noise * random.normal()) + noise * stress.max() * random.normal(
            size=len(stress)
        ).clip(-3, 3)
        lines += [
            f"{run},{a:.6f},{t:.6f},{s * WIDTH_MM:.6f},{WIDTH_MM}"
            for a, t, s in zip(along, across, stress, strict=True)
        ]
    path.write_text("\n".join(lines) + "\n")
    return path


def csv_pair(folder: Path, **options: Any) -> list[Path]:
    """A course-wise and a wale-wise test as CSV files."""
    return [write_csv(folder / f"{direction}.csv", direction, **options) for direction in Direction]


def save_workbook(path: Path, sheets: dict[str, list[list[Any]]]) -> Path:
    """Rows of cells by the names of their sheets, as people save them in a workbook."""
    book = openpyxl.Workbook()
    book.remove(book.worksheets[0])
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    book.save(path)
    return path


def save_as_xlsx(csv_file: Path) -> Path:
    """The table of a CSV file as a workbook."""
    head, *rows = csv.reader(csv_file.read_text().splitlines())
    cells = [head, *([float(cell) for cell in row] for row in rows)]
    return save_workbook(csv_file.with_suffix(".xlsx"), {"Sheet": cells})


def write_h5(path: Path, direction: Direction, *, videos: int = 5) -> Path:
    """The authors' layout; the sample strains evenly, so both gauges see the same strain."""
    along, across, stress = pull(direction)
    with h5py.File(path, "w") as file:
        file["clampSize"] = [35.5 * PX_PER_MM]
        file["fabricSize"] = [WIDTH_MM * PX_PER_MM]
        file.attrs["description"] = f"Made Yarn Garter {direction.of('X', 'Y')}"
        for video in range(1, videos + 1):
            half_long = 0.5 * LENGTH_MM * (1 + along) * PX_PER_MM
            half_wide = 0.4 * WIDTH_MM * (1 + across) * PX_PER_MM
            middle = np.full(len(along), 600.0)
            points = np.array(
                [
                    [middle + half_wide, middle],
                    [middle - half_wide, middle],
                    [middle, middle + 0.9 * half_long],
                    [middle, middle - 0.9 * half_long],
                    [middle, middle],
                    [middle, middle + half_long],
                    [middle, middle - half_long],
                ]
            )
            group = file.create_group(f"video{video}")
            group["traj"] = points
            group["forces"] = stress * WIDTH_MM
            group["frames"] = np.arange(len(along), dtype=float)
    return path


def h5_pair(folder: Path, **options: Any) -> list[Path]:
    """A course-wise and a wale-wise test in the authors' layout."""
    return [write_h5(folder / f"{direction}.h5", direction, **options) for direction in Direction]


def hanging_yarn(
    load: float, *, length_px: float = 1200.0, width_px: float = 30.0, fibres: int = 0
) -> NDArray[np.uint8]:
    """A grey photo of a yarn of this dimensionless load, clamped at the left border."""
    s, x, y = heavy_elastica(load)
    even = np.linspace(0, 1, 4000)
    px, py = np.interp(even, s, x) * length_px, np.interp(even, s, y) * length_px + 2 * width_px
    rows, columns = int(py.max() + 3 * width_px), int(px.max() + 4 * width_px)
    image = np.zeros((rows, columns))
    across = np.linspace(-width_px / 2, width_px / 2, int(2 * width_px))
    tx, ty = np.gradient(px), np.gradient(py)
    norm = np.hypot(tx, ty)
    for offset in across:
        r = np.clip(np.rint(py + offset * tx / norm).astype(int), 0, rows - 1)
        c = np.clip(np.rint(px - offset * ty / norm).astype(int), 0, columns - 1)
        image[r, c] = 0.8
    random = np.random.default_rng(0)
    for _ in range(fibres):
        start = random.integers(400, 3600)
        walk = np.cumsum(random.normal(size=(80, 2)), axis=0)
        r = np.clip((py[start] + walk[:, 0]).astype(int), 0, rows - 1)
        c = np.clip((px[start] + walk[:, 1] + np.arange(80)).astype(int), 0, columns - 1)
        image[r, c] = 0.7
    image = gaussian_filter(image, 1.0) + 0.08 + 0.01 * random.normal(size=image.shape)
    return np.asarray(np.clip(image, 0, 1) * 255, dtype=np.uint8)


def save_photo(path: Path, image: NDArray[np.uint8]) -> Path:
    Image.fromarray(image).save(path)
    return path
