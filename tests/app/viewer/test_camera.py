"""The camera sees the whole fabric from every side."""

import numpy as np
import pytest

from app.viewer.camera import ASPECT, FIELD_OF_VIEW, CameraSide, stand
from app.viewer.cloth import UNITS_PER_MM
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE


@pytest.mark.parametrize("side", CameraSide)
@pytest.mark.parametrize("below_mm", [0.0, 15.0])
@pytest.mark.parametrize("aspect", [ASPECT, 0.46])
@pytest.mark.parametrize("extent_mm", [(40.0, 50.0), (50.0, 20.0), (20.0, 60.0), (300.0, 300.0)])
def test_all_corners_are_in_the_picture(
    side: CameraSide, extent_mm: tuple[float, float], below_mm: float, aspect: float
) -> None:
    """And what lies below it, unless the fabric is seen by its edge."""
    position, aim, up = stand(side, np.array(extent_mm), below_mm, aspect)
    ahead = (aim - position) / np.linalg.norm(aim - position)
    right = np.cross(ahead, up)
    right /= np.linalg.norm(right)
    corners = np.array([[x, y, 0.0] for x in (-0.5, 0.5) for y in (-0.5, 0.5)])
    places = corners * [*extent_mm, 0.0]
    if side is not CameraSide.EDGE:
        places = np.vstack([places, [0.0, -extent_mm[1] / 2 - below_mm, 0.0]])
    seen = places - position
    half = seen @ ahead * np.tan(FIELD_OF_VIEW / 2)
    across = seen @ right / (half * aspect)
    upward = seen @ np.cross(right, ahead) / half
    assert np.abs(across).max() < 0.95
    assert np.abs(upward[:4]).max() < 0.95
    assert np.abs(upward).max() < 1.01


@pytest.mark.parametrize("side", CameraSide)
def test_the_largest_cloth_is_within_the_drawing_distance_of_browsers(side: CameraSide) -> None:
    side_mm = MAX_STITCHES_PER_SIDE * 8.0  # bulky yarn
    position, _, _ = stand(side, UNITS_PER_MM * np.array([side_mm, side_mm]))
    assert np.linalg.norm(position) + 0.75 * UNITS_PER_MM * side_mm < 1000
