"""Points of a stretch curve from rendered photos of a hanging swatch."""

from dataclasses import replace
from typing import Any

import pytest

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.measure.photos.hanging_swatch import Swatch, SwatchPhoto, read_hanging, read_photo
from tests.knitcore.measure.photos.rendered import Scene

SWATCH = Swatch(Fabric.STOCKINETTE, Direction.WALE, 19.7, 28.2, 110.0, 8.0)
"""Counted 1.5 % wrong."""


def scene_of(**options: Any) -> Scene:
    """A scene with 4 pixels per mm, which are enough."""
    return Scene(**{"px_per_mm": 4.0} | options)


def hung(scene: Scene, load_g: float, name: str = "photo") -> SwatchPhoto:
    return SwatchPhoto(name, scene.photo(), load_g)


def test_photos_give_force_and_strains() -> None:
    rest = scene_of(tilt_deg=(3, 1))
    loaded = replace(rest.pulled(0.3, -0.12), tilt_deg=(6, -4), seed=1, shade=0.6)
    read = read_hanging([hung(loaded, 500), hung(rest, 0)], SWATCH)
    (point,) = read.points
    assert point.force_n_per_mm == pytest.approx((500 + 4) * 9.80665e-3 / 110)
    assert point.strain_along == pytest.approx(0.3, abs=0.01)
    assert point.strain_across == pytest.approx(-0.12, abs=0.01)
    assert point.strain_along_sd < 0.01
    assert [photo.load_g for photo in read.photos] == [0, 500]
    assert not read.notes


@pytest.mark.slow
def test_a_swatch_on_its_side_is_pulled_along_its_rows() -> None:
    scene = scene_of(turn_deg=90)
    course, wale = scene.stitch_mm
    pulled = replace(scene, stitch_mm=(course * 1.9, wale * 0.8), swatch_mm=(200, 100))
    swatch = replace(SWATCH, direction=Direction.COURSE, fabric=Fabric.STOCKINETTE)
    (point,) = read_hanging([hung(scene, 0), hung(pulled, 700)], swatch).points
    assert point.direction is Direction.COURSE
    assert point.strain_along == pytest.approx(0.9, abs=0.02)
    assert point.strain_across == pytest.approx(-0.2, abs=0.01)


def test_without_a_photo_at_rest_the_gauge_serves_and_costs_precision() -> None:
    read = read_hanging([hung(scene_of().pulled(0.3, -0.12), 500)], SWATCH)
    (point,) = read.points
    assert abs(point.strain_along - 0.3) < 2 * point.strain_along_sd
    assert point.strain_along_sd > 0.02
    assert "gauge" in read.notes[0]


def test_a_coin_serves_with_a_larger_error() -> None:
    scene = scene_of(marks=False, coin_mm=23.25, tilt_deg=(2, 0))
    read = read_photo(hung(scene, 0), SWATCH, coin_mm=23.25)
    assert read.spacing.course_mm == pytest.approx(5.0, rel=0.015)
    assert read.scale.relative_error > 0.005


@pytest.mark.slow
def test_a_gauge_that_does_not_fit_is_noted() -> None:
    swatch = replace(SWATCH, stitches_per_10_cm=22.0)
    read = read_hanging([hung(scene_of(), 0), hung(scene_of().pulled(0.2, -0.1), 300)], swatch)
    assert "count it again" in read.notes[0]


@pytest.mark.parametrize(
    ("scene", "why"),
    [
        (scene_of(texture=False), "no swatch stands out"),
        (scene_of(blur_px=4.5), "is blurred by"),
        (scene_of(light=0.15), "has no contrast"),
        (scene_of(yarn=1.6, light=2.6), "quite black or white"),
        (scene_of(tilt_deg=(17, 15)), "is tilted"),
        (scene_of(px_per_mm=1.9), "too few for these stitches"),
    ],
    ids=["blank", "blurred", "dark", "glare", "tilted", "far"],
)
def test_photos_that_cannot_serve_are_refused(scene: Scene, why: str) -> None:
    with pytest.raises(InputError, match=why) as refused:
        read_photo(hung(scene, 0, "mine.jpg"), SWATCH)
    assert refused.value.field == "mine.jpg"
    assert refused.value.remedy


def test_weights_must_differ_and_pull() -> None:
    with pytest.raises(InputError, match="not different weights"):
        read_hanging([hung(scene_of(), 0)], SWATCH)
    with pytest.raises(InputError, match="stretch the swatch by 0"):
        read_hanging([hung(scene_of(), 0), hung(scene_of(), 10)], SWATCH)
