"""Scenes of views, made without a service."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from app.context import Context
from app.drawing.computed import PosedView, StretchView
from app.drawing.design_view import ViewRequest, build_scene
from app.drawing.fabric import RECTANGLE, Box, FabricScene

SMALL = {"chart": "KPKP\nPKPK\nKPKP", "material": "acrylic"}


def scene_of(
    request: Mapping[str, object], view: PosedView | StretchView | None = None
) -> FabricScene:
    """The scene of a view, of a computed shape if it is given."""
    return build_scene(ViewRequest.model_validate(request), view, Context(Path()))


def test_outlines_stay_on_the_fabric() -> None:
    ground = scene_of(SMALL).ground
    sides = ground.outline_mm(Box(0, 0, 3, 4))
    assert len(sides) == 2 * (3 + 4)
    np.testing.assert_allclose(np.ptp(sides.reshape(-1, 2), axis=0), ground.extent_mm, rtol=1e-6)
    np.testing.assert_allclose(ground.outline_mm(Box(0, 0, 99, 99)), sides)
    assert len(ground.outline_mm(Box(7, 7, 8, 8))) == 0


def test_a_fabric_reaches_as_far_to_each_side_of_its_middle() -> None:
    """Rows of different height must not put the scale, or a picture, beside the fabric."""
    chart = "\n".join(["K" * 20] * 20 + ["K" * 20, "P" * 20] * 5)
    ground = scene_of(SMALL | {"chart": chart}).ground
    assert np.ptp(ground.sizes_mm[:, 0, 1]) > 0.2
    ends = ground.outline_mm(Box(0, 0, 30, 20)).reshape(-1, 2)
    np.testing.assert_allclose(ends.min(axis=0), -ground.extent_mm / 2, rtol=1e-5)
    np.testing.assert_allclose(ends.max(axis=0), ground.extent_mm / 2, rtol=1e-5)


def test_stitches_of_lace_and_cables_are_drawn_with_their_colours() -> None:
    """Where all are knit or purl, nothing changes."""
    lace = {"chart": "KKKKKK;KO/\\OK;P[2/2R]P;PKKKKP", "material": "acrylic"}
    scene, plain = scene_of(lace), scene_of(SMALL | {"chart": "KKKKKK/KKKKKK/PKKKKP/PKKKKP"})
    assert scene.shapes.source.startswith("loops as the chart knits them")
    assert not plain.shapes.source.startswith("loops as")
    np.testing.assert_array_equal(scene.colours, plain.colours)
    part = scene_of(lace | {"outline": "......\n.xxxx.\n.xxxx.\n.xxxx."})
    assert part.drawn is not None
    np.testing.assert_array_equal(part.shapes.lines, scene.shapes.lines)


def test_an_outline_follows_the_stitches_of_a_part() -> None:
    ground = scene_of(SMALL).ground
    cross = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]]) > 0
    sides = ground.outline_mm(Box(0, 0, 3, 3, cross))
    assert len(sides) == 12
    ends, counts = np.unique(sides.reshape(-1, 2).round(3), axis=0, return_counts=True)
    assert (counts == 2).all(), ends  # one closed line
    outlined = SMALL | {"outline": "xxxx\nxxxx\n.xx."}
    assert len(scene_of(outlined).ground.outline_mm(Box(0, 0, 1, 4))) == 6


def test_a_huge_chart_is_drawn_around_its_focus() -> None:
    chart = {"fabric": "stockinette", "columns": 400, "rows": 300}
    focus = {"row": 299, "column": 0}
    scene = scene_of({"chart": chart, "material": "acrylic", "focus": focus})
    drawing = scene.drawing()
    assert drawing.part.shapes.index.size <= 40_000
    np.testing.assert_array_equal(
        drawing.part.placement.centres_mm[-1, 0], scene.placement.centres_mm[299, 0]
    )
    assert drawing.ground.shape == (300, 400)
    assert not drawing.is_whole


def test_every_way_to_colour_the_stitches() -> None:
    regions = [
        {"id": "a", "name": "A", "colour": "#ff0000", "yarn": "red", "runs": [[0, 0, 2]]},
        {"id": "b", "name": "B", "colour": "#00ff00", "runs": [[0, 1, 2], [1, 0, 1]]},
        {"id": "c", "name": "C", "colour": "#0000ff", "runs": [[2, 0, 4]], "hidden": True},
    ]

    def colours(colour: str, **more: object) -> np.ndarray:
        return scene_of(SMALL | {"colour": colour, "regions": regions, **more}).colours

    palette = {"yarn": "#101010", "seed": "#123456"}
    plain = [0x10, 0x10, 0x10]
    by_yarn, by_region = (colours(c, palette=palette) for c in ("yarn", "region"))
    assert by_yarn[0].tolist() == [[255, 0, 0], [255, 0, 0], plain, plain]
    assert by_region[0].tolist() == [[255, 0, 0], [0, 255, 0], [0, 255, 0], plain]
    assert by_region[2].tolist() == [plain] * 4
    assert colours("phase", palette=palette)[1, 1].tolist() == [0x12, 0x34, 0x56]
    field = {"values": list(range(12)), "low": 0, "high": 11}
    assert colours("field", field=field)[0, 0].tolist() == [0x01, 0x19, 0x59]


@pytest.mark.parametrize(("groups", "count"), [("stitch", 12), ("block", 2), ("region", 1)])
def test_rectangles_stand_for_stitches_blocks_or_regions(groups: str, count: int) -> None:
    body = SMALL | {
        "rectangles": True,
        "rectangle_groups": groups,
        "rectangle_block": 3,
        "regions": [{"id": "a", "name": "A", "colour": "#ff0000", "runs": [[0, 0, 2]]}],
    }
    scene = scene_of(body)
    rectangles = scene.rectangles_mm
    assert rectangles is not None
    assert rectangles.shape == (count, 4, 2)
    assert scene.drawing().weight == 12 + RECTANGLE * count
