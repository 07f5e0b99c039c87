"""Pictures of a fabric that the service draws itself."""

import io

import numpy as np
import pytest
from fastapi.testclient import TestClient
from PIL import Image

from app.drawing.colours import FABRIC_COLOURS, rgb
from app.drawing.computed import PosedView
from app.drawing.fabric import FabricScene
from app.viewer.still import still_png
from knitcore.chart.fabric import Fabric
from knitcore.draw.body import Body
from tests.app.drawing.test_design_view import scene_of

ASKED = {"chart": "\n".join(["KKKK"] * 4), "material": "acrylic", "colour": "fabric"}


def picture(content: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(content))).astype(float)


def still(width: int, height: int, **changed: object) -> np.ndarray:
    return picture(still_png(scene_of(ASKED | changed), width, height))


def opaque(drawn: np.ndarray) -> np.ndarray:
    return drawn[..., 3] > 128


def cloth(height_mm: float) -> np.ndarray:
    """The corners of 4 x 4 stitches of 3 mm, all at one height."""
    corners = np.full((5, 5, 3), height_mm, np.float32)
    corners[..., 1], corners[..., 0] = 3.0 * np.mgrid[:5, :5]
    return corners


def posed(view: PosedView) -> FabricScene:
    return scene_of(ASKED | {"curl": {"id": "posed"}}, view)


def test_the_fabric_lies_in_the_middle_in_its_colour() -> None:
    drawn = still(120, 90)
    assert drawn.shape == (90, 120, 4)
    shown = opaque(drawn)
    columns, rows = np.flatnonzero(shown.any(axis=0)), np.flatnonzero(shown.any(axis=1))
    assert columns.mean() == pytest.approx(60, abs=2)
    assert 0.6 * 90 < np.ptp(rows) < 90
    assert not shown[0].any()
    colour = drawn[shown][:, :3].mean(axis=0)
    expected = np.array(rgb(FABRIC_COLOURS[Fabric.STOCKINETTE]))
    assert np.corrcoef(colour, expected)[0, 1] > 0.99


def test_face_and_back_of_a_loop_differ() -> None:
    """Knits show their legs in front, purls their heads."""
    knit, purl = (still(120, 90, chart="\n".join([4 * kind] * 4)) for kind in "KP")
    assert np.abs(knit - purl).mean() > 5


def test_where_there_is_no_stitch_nothing_is_drawn() -> None:
    part, whole = (
        np.flatnonzero(opaque(still(120, 90, outline=outline)).any(axis=0)).max()
        for outline in ("\n".join(["xx.."] * 4), None)
    )
    assert part < whole - 20


def test_a_shape_that_leaves_the_picture_is_cut_at_its_edges() -> None:
    near = posed(PosedView(cloth(12.0)))
    vars(near)["ground"] = scene_of(ASKED).ground  # nearer to the eye, in the frame of the flat one
    shown = opaque(picture(still_png(near, 120, 90)))
    assert shown[0].any()
    assert shown[-1].any()


def on_a_ball(over_mm: float) -> np.ndarray:
    """A picture of flat cloth, 4 x 4 stitches, and a ring around its middle: over or under it."""
    turn = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    circle = np.stack([np.sin(turn), np.zeros(24), np.cos(turn)], axis=-1)
    rings = np.stack([6.0 + 2.0 * circle, 6.0 + 2.0 * circle])
    rings[:, :, 1] = [[2.0], [10.0]]
    rings[..., 2] += over_mm - 6.0
    return picture(still_png(posed(PosedView(cloth(0.0), Body.around(rings))), 120, 90))


def test_what_the_cloth_rests_on_hides_it_or_is_hidden() -> None:
    above, below = on_a_ball(6.0), on_a_ball(-6.0)
    # skin is reddish, the yarn blue
    seen = [(opaque(at) & (at[..., 0] > at[..., 2])).sum() for at in (above, below)]
    assert seen[0] > 2 * seen[1] > 0  # between the loops it is seen from above, too


def test_what_it_rests_on_is_framed_whole() -> None:
    """A table that reaches far beyond the cloth, on one side, and towards the eye."""
    table = Body.slab(np.array([(-60.0, -40.0), (0.0, -40.0), (0.0, 40.0), (-60.0, 40.0)]), 10.0)
    drawing = posed(PosedView(cloth(0.0), table).upright())
    shown = opaque(picture(still_png(drawing, 120, 90)))
    columns, rows = np.flatnonzero(shown.any(axis=0)), np.flatnonzero(shown.any(axis=1))
    assert 0 < columns[0] < columns[-1] < 119
    assert 0 < rows[0] < rows[-1] < 89
    assert columns.mean() == pytest.approx(60, abs=4)
    assert np.ptp(columns) > 0.6 * 120 * (90 / 120 * 1.25)


def test_large_pictures_are_larger_not_other_ones() -> None:
    small, large = still(80, 60), still(160, 120)
    shares = [opaque(drawn).mean() for drawn in (small, large)]
    assert shares[0] == pytest.approx(shares[1], abs=0.03)


def test_the_service_gives_it_without_a_browser(client: TestClient) -> None:
    answer = client.post("/api/v1/views/still?width=64&height=48", json=ASKED)
    assert answer.headers["content-type"] == "image/png"
    assert picture(answer.content).shape == (48, 64, 4)
    assert client.post("/api/v1/views/still?width=1601", json=ASKED).status_code == 422


def test_many_stitches_make_one_surface_in_the_same_place() -> None:
    chart = {"fabric": "stockinette", "columns": 40, "rows": 40}
    few = {"fabric": "stockinette", "columns": 25, "rows": 25}
    cloth, yarn = (opaque(still(120, 90, chart=of)) for of in (chart, few))
    ends = [
        np.flatnonzero(shown.any(axis=axis))[[0, -1]] for shown in (cloth, yarn) for axis in (0, 1)
    ]
    assert np.abs(np.subtract(ends[:2], ends[2:])).max() <= 5
    (top, bottom), (left, right) = ends[1], ends[0]
    assert cloth[top + 2 : bottom - 2, left + 2 : right - 2].all()
