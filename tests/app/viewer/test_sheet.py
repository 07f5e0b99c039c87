"""Pictures of cloth that is too large to be drawn as tubes."""

from io import BytesIO

import numpy as np
import pytest
import scipy
from PIL import Image

from app.drawing.fabric import FabricScene
from app.viewer import sheet
from app.viewer.sheet import packed, sheet_picture
from app.viewer.views import new_view
from tests.app.drawing.test_design_view import scene_of

ROWS = 32


def scene(chart: str = "K" * ROWS, **more: object) -> FabricScene:
    return scene_of(
        {"chart": "\n".join([chart] * ROWS), "material": "acrylic", "colour": "yarn"} | more
    )


def sides(scene: FabricScene) -> list[np.ndarray]:
    """Pictures of face and back."""
    face, back = sheet_picture(scene), sheet_picture(scene, back=True)
    assert face is not None
    assert back is not None
    return [face, back]


def upright(picture: np.ndarray) -> float:
    """Contrast across wales over that across courses: the legs of knits stand, the heads of purls
    lie."""
    grey = picture[..., :3].mean(axis=2)
    grey = grey[grey.shape[0] // 4 : -grey.shape[0] // 4, grey.shape[1] // 4 : -grey.shape[1] // 4]
    return float(grey.mean(axis=0).std() / grey.mean(axis=1).std())


def test_face_and_back_show_the_stitches_of_their_side() -> None:
    knit, purl = (sides(scene(ROWS * kind)) for kind in "KP")
    for standing, lying in (knit, reversed(purl)):
        assert upright(standing) > 2 * upright(lying)


def test_both_pictures_are_as_one_stands_before_them() -> None:
    """The rib is at the left of the face, and at the right of the back."""
    face, back = sides(scene("KP" * 8 + "K" * 16 + "K" * 8))
    for picture, rib in ((face, 0), (back, 1)):
        grey = picture[..., :3].astype(float).mean(axis=2)
        halves = grey[:, : grey.shape[1] // 2], grey[:, -(grey.shape[1] // 2) :]
        rough = [half.mean(axis=0).std() for half in halves]
        assert np.argmax(rough) == rib


def test_a_picture_has_the_proportions_of_the_cloth_and_no_holes() -> None:
    of = scene()
    face, _ = sides(of)
    height, width = face.shape[:2]
    across, down = of.ground.reach_mm
    assert width / height == pytest.approx(across / down, rel=0.02)
    inside = face[height // 4 : -height // 4, width // 4 : -width // 4, 3]
    assert inside.min() == 255


def unevenness(cloth: FabricScene) -> float:
    """Standard deviation of the light of whole rows, seen from afar, over their mean."""
    face = sheet_picture(cloth)
    assert face is not None
    light = ((face[..., :3] / 255) ** 2.2).mean(axis=2)
    rows = scipy.ndimage.gaussian_filter1d(light[:, 20:-20].mean(axis=1), 12)[50:-50]
    return float(rows.std() / rows.mean())


@pytest.mark.parametrize("lines", ["KK", "KP"], ids=["stockinette", "garter"])
def test_rows_and_pixels_do_not_make_bands(lines: str) -> None:
    assert unevenness(scene("\n".join(kind * ROWS for kind in lines))) < 0.006


@pytest.mark.parametrize("height", [2.49, 2.51])
def test_rows_of_two_and_a_half_pixels_make_no_bands(
    height: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    cloth = scene("\n".join(kind * ROWS for kind in 5 * "KP"))
    course, reach = cloth.ground.sizes_mm[..., 1].mean(), cloth.ground.reach_mm
    monkeypatch.setattr(sheet, "PIXELS", (height / course) ** 2 * reach.prod())
    assert unevenness(cloth) < 0.006


def test_there_is_no_cloth_beyond_the_outline() -> None:
    outline = "\n".join([*[16 * "x" + 16 * "."] * 16, *[32 * "x"] * 16])
    face, back = sides(scene(outline=outline))
    height, width = face.shape[:2]
    assert face[: height // 3, 2 * width // 3 :, 3].max() == 0
    assert back[: height // 3, : width // 3, 3].max() == 0
    assert face[height // 8 : height // 3, width // 4, 3].min() == 255


def test_few_stitches_are_seen_one_by_one() -> None:
    small = {"chart": "KKPP\nKKPP", "material": "acrylic"}
    assert sheet_picture(scene_of(small)) is None


def test_a_packed_picture_is_the_picture() -> None:
    picture = sides(scene())[0]
    file = packed(picture)
    with Image.open(BytesIO(file)) as image:
        shown = np.asarray(image.convert("RGBA")).astype(float)
    cloth = picture[..., 3] == 255
    assert np.array_equal(shown[..., 3], picture[..., 3])
    assert np.abs(shown - picture)[cloth].mean() < 4
    assert len(file) < picture.size / 6


def test_a_view_keeps_a_picture_packed_only() -> None:
    of, view = scene(), new_view()
    try:
        face = packed(sides(of)[0])
        view.show(of.drawing(), face)
        shown = view.server.scene.get_handle_by_name("/face")
        assert shown is not None
        assert [value for value in vars(shown).values() if isinstance(value, np.ndarray)] == []
        assert vars(shown)["_image"] is face
        assert shown._data is face  # type: ignore[attr-defined]
    finally:
        view.stop()
