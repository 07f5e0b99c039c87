"""Spacing of stitches in straightened pictures."""

from dataclasses import replace

import numpy as np
import pytest

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Fabric
from knitcore.measure.photos.stitch_spacing import repeat_of, stitch_spacing
from tests.knitcore.measure.photos.rendered import STITCH_MM, Scene

NEAR = ((0.75 * STITCH_MM[0], 1.33 * STITCH_MM[0]), (0.75 * STITCH_MM[1], 1.33 * STITCH_MM[1]))


def picture(scene: Scene) -> np.ndarray:
    """The middle of the swatch, at most 18 × 22 stitches, with 6 pixels per mm."""
    course, wale = scene.stitch_mm
    return replace(scene, seen_mm=(min(90.0, 18 * course), min(80.0, 22 * wale))).photo()


@pytest.mark.parametrize("fabric", Fabric)
def test_each_fabric_gives_the_size_of_its_stitch(fabric: Fabric) -> None:
    spacing = stitch_spacing(picture(Scene(fabric=fabric)), 6.0, NEAR, fabric)
    assert (spacing.course_mm, spacing.wale_mm) == pytest.approx(STITCH_MM, rel=4e-3)
    assert spacing.course_sd_mm < 0.01 * spacing.course_mm


def test_a_repeat_is_as_the_chart_says() -> None:
    assert [repeat_of(fabric) for fabric in Fabric] == [(1, 1), (1, 2), (2, 1), (2, 2)]


def test_uneven_stitches_are_less_certain() -> None:
    even, uneven = (
        stitch_spacing(picture(Scene(irregular=by)), 6.0, NEAR, Fabric.STOCKINETTE)
        for by in (0.02, 0.09)
    )
    assert uneven.course_sd_mm > 1.5 * even.course_sd_mm
    assert uneven.periodicity < even.periodicity
    assert abs(uneven.wale_mm - STITCH_MM[1]) < 2.5 * uneven.wale_sd_mm


@pytest.mark.parametrize(
    ("scene", "near", "why"),
    [
        (Scene(texture=False), NEAR, "no (columns|rows) of stitches"),
        (Scene(), ((2.0, 3.0), NEAR[1]), "twice as large as the gauge"),
        (Scene(stitch_mm=(1.0, 0.8)), ((0.75, 1.33), (0.6, 1.1)), "too few for these stitches"),
        (Scene(stitch_mm=(30.0, 25.0)), ((22, 40), (19, 33)), "of flat fabric can be used"),
    ],
    ids=["wall", "wrong gauge", "too far", "too few stitches"],
)
def test_what_has_no_spacing_is_refused(
    scene: Scene, near: tuple[tuple[float, float], tuple[float, float]], why: str
) -> None:
    with pytest.raises(InputError, match=why):
        stitch_spacing(picture(scene), 6.0, near, Fabric.STOCKINETTE)
