"""Make the files of the API's examples: ``python -m tests.example_files``.

They are small measurements of which the truth is known, made as the tests make theirs.
"""

from pathlib import Path

import numpy as np
from PIL import Image

from app.requests.uploads import EXAMPLES
from knitcore.chart.fabric import Direction, Fabric
from knitcore.cloth.flat import SheetModel
from knitcore.materials import material
from tests.knitcore.cloth.flat.synthetic import camera_arrays
from tests.knitcore.measure.photos.rendered import Scene
from tests.knitcore.measure.synthetic import hanging_yarn, pull, save_photo
from tests.knitcore.measure.test_compression import squeeze, write

WIDTH_MM = 70
BLACK = 120


def stretch_test(direction: Direction) -> str:
    """One pull, as CSV."""
    head = "strain_along,strain_across,force_n,width_mm"
    points = zip(*pull(direction, points=80), strict=True)
    rows = [f"{a:.4f},{t:.4f},{s * WIDTH_MM:.4f},{WIDTH_MM}" for a, t, s in points]
    return "\n".join([head, *rows]) + "\n"


def photo(file: Path) -> None:
    """A hanging yarn, in black and white."""
    save_photo(file, hanging_yarn(80, length_px=400, width_px=16))
    grey = Image.open(file).convert("L")
    grey.point(lambda value: 255 * (value > BLACK)).convert("1").save(file, optimize=True)


def field(file: Path) -> None:
    """A swatch at rest and pulled, with tenths of pixels, which pack well."""
    seen, frame = camera_arrays(material("acrylic").law(Fabric.GARTER), SheetModel())
    tenths = np.round(seen[:2], 1)
    tenths[(tenths == 0) & (seen[:2] != 0)] = 1e-3  # only zeros are outside the fabric
    np.savez_compressed(file, displacement=tenths.astype(np.float16), frame=frame[:2])


def swatch(file: Path, scene: Scene) -> None:
    """A hanging swatch before the sheet of marks."""
    grey = np.uint8(255 * scene.photo())
    Image.fromarray(grey).save(file, quality=60, optimize=True)


def main() -> None:
    """Write them."""
    for direction in Direction:
        (EXAMPLES / f"{direction}.csv").write_text(stretch_test(direction), encoding="utf-8")
    photo(EXAMPLES / "photo.png")
    made = squeeze(1e-3, 2.5)
    write(EXAMPLES / "my-yarn-1.csv", made.depth_mm[::6], made.force_n[::6])
    field(EXAMPLES / "field.npz")
    rest = Scene(px_per_mm=2.6, noise=0.0, blur_px=0.4)
    swatch(EXAMPLES / "swatch-rest.jpg", rest)
    swatch(EXAMPLES / "swatch-500g.jpg", rest.pulled(0.3, -0.12))


if __name__ == "__main__":
    main()
