"""Scale, tilt and blur of rendered photos."""

from typing import Any

import numpy as np
import pytest

from knitcore.base.errors import InputError
from knitcore.measure.photos.photo_scale import coin_scale, sheet_scale
from tests.knitcore.measure.photos.rendered import Scene

COIN_MM = 23.25
PX_PER_MM = 4.0


def scene_of(**options: Any) -> Scene:
    """A scene with as many pixels as are enough."""
    return Scene(px_per_mm=PX_PER_MM, **options)


@pytest.mark.parametrize("tilt", [(0.0, 0.0), (12.0, 0.0), (8.0, -9.0)])
def test_the_sheet_gives_scale_and_tilt(tilt: tuple[float, float]) -> None:
    scale = sheet_scale(scene_of(tilt_deg=tilt).photo())
    assert scale.px_per_mm == pytest.approx(
        PX_PER_MM * np.sqrt(np.cos(np.radians(tilt)).prod()), rel=4e-3
    )
    assert scale.tilt_deg == pytest.approx(float(np.hypot(*tilt)), abs=1.0)


@pytest.mark.parametrize("blur", [0.7, 2.0, 3.0])
def test_the_edges_of_the_marks_give_the_blur(blur: float) -> None:
    assert sheet_scale(scene_of(blur_px=blur).photo()).blur_px == pytest.approx(blur, rel=0.2)


def test_a_coin_gives_the_scale_and_an_error_that_covers_its_tilt() -> None:
    for tilt in (0.0, 3.0):
        scale = coin_scale(
            scene_of(marks=False, coin_mm=COIN_MM, tilt_deg=(tilt, 0)).photo(), COIN_MM
        )
        assert abs(scale.px_per_mm / PX_PER_MM - 1) < 2 * scale.relative_error


@pytest.mark.parametrize(
    ("scene", "why"),
    [
        (scene_of(tilt_deg=(24, 0)), "tilted by 24°; 20°"),
        (scene_of(marks=False), "0 of the sheet's four marks"),
        (scene_of(blur_px=9), "0 of the sheet's four marks"),
        (scene_of(swatch_mm=(190, 150)), None),
        (scene_of(swatch_mm=(190, 260)), "0 of the sheet's four marks"),
    ],
    ids=["tilted", "without sheet", "blurred", "beside the marks", "over the marks"],
)
def test_photos_without_four_marks_or_too_tilted_are_refused(scene: Scene, why: str | None) -> None:
    if why is None:
        assert sheet_scale(scene.photo()).tilt_deg < 2
        return
    with pytest.raises(InputError, match=why):
        sheet_scale(scene.photo())


def test_photos_without_a_coin_or_too_tilted_are_refused() -> None:
    with pytest.raises(InputError, match="no round thing"):
        coin_scale(scene_of(marks=False).photo(), COIN_MM)
    with pytest.raises(InputError, match="10° can be corrected"):
        coin_scale(scene_of(marks=False, coin_mm=COIN_MM, tilt_deg=(9, 0)).photo(), COIN_MM)
