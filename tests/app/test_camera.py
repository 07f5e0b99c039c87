"""The camera sees the whole fabric from every side."""

from __future__ import annotations

import numpy as np
import pytest

from app.viewer.camera import ASPECT, FIELD_OF_VIEW, Side, stand


@pytest.mark.parametrize("side", Side)
@pytest.mark.parametrize("extent_mm", [(40.0, 50.0), (50.0, 20.0), (20.0, 60.0), (300.0, 300.0)])
def test_all_corners_are_in_the_picture(side: Side, extent_mm: tuple[float, float]) -> None:
    position, aim, up = stand(side, np.array(extent_mm))
    ahead = (aim - position) / np.linalg.norm(aim - position)
    right = np.cross(ahead, up)
    right /= np.linalg.norm(right)
    corners = np.array([[x, y, 0.0] for x in (-0.5, 0.5) for y in (-0.5, 0.5)])
    seen = corners * [*extent_mm, 0.0] - position
    half = seen @ ahead * np.tan(FIELD_OF_VIEW / 2)
    across = seen @ right / (half * ASPECT)
    upward = seen @ np.cross(right, ahead) / half
    assert np.abs(across).max() < 0.95
    assert np.abs(upward).max() < 0.95
