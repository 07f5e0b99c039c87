"""Print errors of rendered photos: ``python -m tests.knitcore.measure.photos.error_table``.

The table is that of docs/measure-your-yarn.md: a swatch as the product draws it, before the
sheet or beside a coin, at rest and pulled down by 30 %; the largest errors of four scatters.
"""

from dataclasses import replace

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.measure.photos.hanging_swatch import Swatch, SwatchPhoto, read_photo
from tests.knitcore.measure.photos.rendered import STITCH_MM, Scene

ALONG, ACROSS = 0.3, -0.12
COIN_MM = 23.25
REPEATS = 4
SWATCH = Swatch(Fabric.STOCKINETTE, Direction.WALE, 100 / STITCH_MM[0], 100 / STITCH_MM[1], 110.0)


def main() -> None:
    print("| photo | spacing, largest error | strain along | strain across |\n|---|---|---|---|")  # noqa: T201
    for fabric in Fabric:
        _row(f"{fabric}", Scene(fabric=fabric))
    for tilt in (5, 10, 15, 19, 22):
        _row(f"sheet, tilt {tilt}°", Scene(tilt_deg=(0.8 * tilt, 0.6 * tilt)))
    for blur in (1, 2, 3, 4):
        _row(f"blur {blur} px of 22 px a row", Scene(blur_px=blur))
    for light in (0.15, 0.3, 0.6, 1.5, 2.5):
        _row(f"light {light:g} of the usual", Scene(light=light))
    _row("light falls to a third across", Scene(shade=1.0))
    for irregular in (0.1, 0.2):
        _row(f"stitches scattered by {irregular:.0%}", Scene(irregular=irregular))
    for tilt in (0, 2, 4, 6):
        _row(f"coin, tilt {tilt}°", Scene(marks=False, coin_mm=COIN_MM, tilt_deg=(tilt, 0)))


def _row(name: str, scene: Scene) -> None:
    try:
        errors = [_errors(replace(scene, seed=seed)) for seed in range(REPEATS)]
    except InputError as error:
        print(f"| {name} | refused: {error.problem} | | |", flush=True)  # noqa: T201
        return
    largest = [max(abs(e[i]) for e in errors) for i in range(3)]
    print(f"| {name} | {largest[0]:.2%} | {largest[1]:.4f} | {largest[2]:.4f} |", flush=True)  # noqa: T201


def _errors(rest: Scene) -> tuple[float, float, float]:
    """Errors of the spacing (relative, the largest of four) and of both strains (absolute)."""
    loaded = replace(rest.pulled(ALONG, ACROSS), seed=rest.seed + 100)
    fabric, coin = replace(SWATCH, fabric=rest.fabric), rest.coin_mm
    sizes = []
    for scene, load in ((rest, 0.0), (loaded, 500.0)):
        spacing = read_photo(SwatchPhoto("", scene.photo(), load), fabric, coin_mm=coin).spacing
        sizes.append((spacing.course_mm, spacing.wale_mm))
    off = [
        size / true - 1
        for scene, pair in zip((rest, loaded), sizes, strict=True)
        for size, true in zip(pair, scene.stitch_mm, strict=True)
    ]
    along = sizes[1][1] / sizes[0][1] - 1 - ALONG
    across = sizes[1][0] / sizes[0][0] - 1 - ACROSS
    return max(map(abs, off)), along, across


if __name__ == "__main__":
    main()
