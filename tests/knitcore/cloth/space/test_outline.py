"""Sheets of any outline: holes, parts that meet at a corner, bridges."""

from __future__ import annotations

import io

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Fabric
from knitcore.chart.phases import continued
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.space.curl import curl
from knitcore.cloth.space.folds import opposed, turning
from knitcore.cloth.space.hang import hang
from knitcore.cloth.space.sheet_shape import settle, shake_mm
from knitcore.cloth.space.stitch_sheet import StitchSheet, sheet_of
from knitcore.cloth.space.surface import corners_of, filled
from knitcore.cloth.space.tangent import Tangent
from knitcore.formats.write.yarn_mesh import write_curled_glb
from knitcore.garment.shaped import outline_marks
from knitcore.materials import material

ACRYLIC = material("acrylic")
OUTLINES = {
    "hole": "xxxxxx\nxx..xx\nxx..xx\nxxxxxx",
    "slit": "xxxxxx\nx....x\nxxxxxx\nxxxxxx",
    "two holes": "xxxxxx\nx.xx.x\nx.xx.x\nxxxxxx",
    "holes that meet at a corner": "xxxxxx\nx.xxxx\nxx.xxx\nxxxxxx",
    "parts that meet at a corner": "...xxx\n...xxx\nxxx...\nxxx...",
    "bridge": "xx..xx\nxxxxxx\nxx..xx\nxx..xx",
}
KINDS = pytest.mark.parametrize("outline", OUTLINES.values(), ids=OUTLINES)


def _sheet(outline: str) -> tuple[StitchSheet, Array]:
    """A mixed sheet of this outline in a rough shape, with contact in ``pairs``."""
    stitches = outline_marks(outline)
    chart = continued(StitchChart.parse("KKPKPP\nKPPKKP\nPPKKPK\nKPKPKK"), stitches)
    sheet = sheet_of(chart, ACRYLIC, stitches).cut(stitches)
    x = sheet.flat_mm + 0.5 * np.random.default_rng(0).standard_normal(sheet.flat_mm.shape)
    x[29] = x[3] + 1.1
    return sheet, x


PAIRS = np.array([[0, 18]])


@KINDS
def test_gradient_and_hessian_are_derivatives(outline: str) -> None:
    sheet, x = _sheet(outline)
    way, h = np.random.default_rng(1).standard_normal(x.shape), 1e-6
    (above, rising), (below, falling) = (sheet.energy(x + step * way, PAIRS) for step in (h, -h))
    _, gradient = sheet.energy(x, PAIRS)
    assert (above - below) / (2 * h) == pytest.approx((gradient * way).sum(), rel=1e-6)
    matrix = Tangent(sheet).matrix(x, PAIRS, np.ones(x.shape, bool), convex=False)
    change = (rising - falling).ravel() / (2 * h)
    assert np.allclose(matrix @ way.ravel(), change, rtol=1e-5, atol=1e-6)
    assert not gradient[~sheet.used].any()


@KINDS
def test_motion_of_the_whole_costs_nothing(outline: str) -> None:
    sheet, x = _sheet(outline)
    moved = x @ Rotation.random(rng=np.random.default_rng(2)).as_matrix().T + 3.0
    assert sheet.energy(moved, PAIRS)[0] == pytest.approx(sheet.energy(x, PAIRS)[0], rel=1e-10)


@KINDS
def test_every_outline_comes_to_rest(outline: str) -> None:
    stitches = outline_marks(outline).repeat(2, axis=0).repeat(2, axis=1)
    piece = curl(StitchChart.parse("K").tile(*stitches.shape), ACRYLIC, stitches=stitches)
    assert piece.converged
    assert piece.depth_mm > piece.thickness_mm


@pytest.mark.parametrize("fabric", [Fabric.GARTER, Fabric.RIB, Fabric.SEED])
def test_what_lies_flat_lies_flat_around_a_hole(fabric: Fabric) -> None:
    """At its own size: the edge of the hole takes its parity from within the cloth."""
    stitches = np.ones((16, 16), dtype=bool)
    stitches[5:10, 6:11] = False  # odd, so that the chart's parity differs at its sides
    chart = StitchChart.of_fabric(fabric, rows=16, columns=16)
    purl = chart.purl ^ ~stitches & (np.random.default_rng(0).random((16, 16)) < 0.5)
    piece = curl(StitchChart(purl), ACRYLIC, stitches=stitches)
    record = ACRYLIC.record(fabric)
    assert piece.converged
    assert piece.depth_mm < 0.1
    assert piece.width_mm == pytest.approx(16 * record.stitch_course_mm, rel=1e-3)


def _held_at(sheet: StitchSheet, held: NDArray[np.bool_]) -> Array:
    x = sheet.flat_mm + shake_mm(sheet.flat_mm.shape)
    x[held.ravel()] = sheet.flat_mm[held.ravel()]
    shape = settle(sheet.clamped(held.ravel()), x, held=held.ravel())
    assert shape.converged
    return shape.x.reshape(*held.shape, 3)


@pytest.mark.parametrize("axis", [0, 1], ids=["sides", "ends"])
def test_the_edge_of_a_hole_curls_like_a_free_edge(axis: int) -> None:
    """Stockinette three stitches wide beside a clamp, beyond it a free edge or a long hole."""
    beside, hole, length = 3, 6, 48
    whole = np.ones((length, 2 * (2 + beside) + hole), dtype=bool)
    holed = whole.copy()
    holed[2:-2, 2 + beside : -2 - beside] = False
    strip = whole[:, : 2 + beside]
    heights = []
    for stitches in (strip, holed):
        there = stitches.T if axis else stitches
        sheet = sheet_of(StitchChart.parse("K").tile(*there.shape), ACRYLIC, there).cut(there)
        held = np.zeros((stitches.shape[0] + 1, stitches.shape[1] + 1), dtype=bool)
        held[:, :3] = True
        if stitches is holed:
            held[:, -3:] = held[:3] = held[-3:] = True
        corners = _held_at(sheet, held.T if axis else held)
        line = corners[:, length // 2] if axis else corners[length // 2]
        heights.append(line[: 3 + beside, 2])
    free, edge = heights
    towards = 1.0 if axis else -1.0
    assert towards * edge[-1] > 0.5
    np.testing.assert_allclose(edge, free, atol=0.2)


def test_runs_end_at_a_hole() -> None:
    """Two panels of a rib beside a hole are at an edge, and no longer between others."""
    chart = StitchChart.parse("KKKPPPKKKPPPKKK").tile(6, 1)
    stitches = np.ones(chart.purl.shape, dtype=bool)
    stitches[2:4, 6:9] = False
    side = turning(continued(chart, stitches), stitches)
    assert opposed(side)[0].tolist() == [3] * 15
    assert opposed(side)[2, [1, 4, 10, 13]].tolist() == [3, 3, 3, 3]
    lone = np.ones(chart.purl.shape, dtype=bool)
    lone[:, [2, 6]] = False  # the purls have nothing beside them
    assert opposed(turning(continued(chart, lone), lone))[2, 4] == 0


def test_parts_that_nothing_holds_together_are_refused_by_name() -> None:
    stitches = outline_marks("xxxx.x\nxxxx.x\nxxxx..")
    with pytest.raises(InputError, match="2 parts") as told:
        curl(StitchChart.parse("K").tile(3, 6), ACRYLIC, stitches=stitches)
    assert told.value.field == "outline"
    assert "stitch 6 of row 2" in told.value.problem
    assert "Join them" in told.value.remedy


def test_corners_without_a_stitch_go_on_as_those_beside_them() -> None:
    """A plane stays a plane, and a hole in a bowl is filled like the bowl."""
    there = corners_of(outline_marks("..xxxxxx\nxxx...xx\nxxx...xx\nxxxxxxxx"))
    row, column = np.indices(there.shape).astype(float)
    plane = np.stack([2.0 * column, 3.0 * row, column - row], axis=-1)
    bowl = np.stack([column, row, 0.1 * (row**2 + column**2)], axis=-1)
    hidden = np.where(there[..., None], 0.0, 50.0)
    np.testing.assert_allclose(filled(plane + hidden, there), plane, atol=1e-9)
    inner = (slice(1, -1), slice(3, 6))
    off = np.abs(filled(bowl + hidden, there) - bowl)
    assert off[inner].max() < 0.3
    np.testing.assert_array_equal(off[there], 0.0)


def test_a_hole_is_a_hole_in_the_file() -> None:
    stitches = np.ones((10, 12), dtype=bool)
    stitches[3:7, 4:8] = False
    piece = curl(
        StitchChart.of_fabric(Fabric.SEED, rows=10, columns=12), ACRYLIC, stitches=stitches
    )
    solid = write_curled_glb(piece.chart, piece.corners_mm, ACRYLIC, piece.stitches)
    mesh = trimesh.load_mesh(io.BytesIO(solid), file_type="glb")
    middle = 500.0 * (mesh.bounds[0] + mesh.bounds[1])
    size = ACRYLIC.record(Fabric.SEED).stitch_mm
    within = np.abs(1000.0 * mesh.vertices[:, :2] - middle[:2]) < np.array(size)
    assert not within.all(axis=1).any()


def test_a_piece_with_a_hole_hangs_by_its_highest_edge() -> None:
    stitches = outline_marks("..xxxx..\nxxxxxxxx\nxxx..xxx\nxxx..xxx\nxxxxxxxx\n........")
    chart = StitchChart.of_fabric(Fabric.GARTER, rows=6, columns=8)
    found = hang(chart, ACRYLIC, linear_density_g_per_m=0.5, stitches=stitches)
    whole = hang(chart, ACRYLIC, linear_density_g_per_m=0.5)
    assert found.converged
    assert found.weight_n == pytest.approx(whole.weight_n * stitches.mean(), rel=0.01)
    held = found.corners_mm[-1, 2:7]
    assert not np.ptp(held[:, 1:], axis=0).any()
    height = ACRYLIC.record(Fabric.GARTER).stitch_wale_mm
    assert found.drop_mm == pytest.approx(5 * height, rel=0.1)
    assert np.array_equal(found.used, corners_of(stitches))
