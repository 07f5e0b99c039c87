"""Outlines of cut pieces and their meshes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from skfem import MeshQuad

from knitcore.cloth.cut import CutPiece
from knitcore.cloth.cut.cut_mesh import MAX_ELEMENTS, mesh_of, size_for, triangulation
from tests.knitcore.refusals import refuses

SLEEVE = CutPiece(
    [(0, 0), (60, 0), (80, 90), (40, 120), (-20, 90)],
    holes=[[(20, 20), (40, 20), (40, 40), (20, 40)], [(30, 70), (36, 80), (24, 80)]],
    edges={"cuff": (1,), "cap": (3, 4), "holes": (6, 7, 8, 9, 10, 11, 12)},
)


def areas(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = points[triangles].transpose(1, 0, 2)
    u, v = b - a, c - a
    return (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2


@pytest.mark.parametrize("size", [3.0, 9.0, 40.0])
def test_triangles_cover_the_piece_exactly(size: float) -> None:
    covered = areas(*triangulation(SLEEVE, size))
    assert covered.min() > 0
    assert covered.sum() == pytest.approx(SLEEVE.area_mm2, rel=1e-12)


def test_triangles_inside_are_nearly_equilateral() -> None:
    points, triangles = triangulation(SLEEVE, 4.0)
    corners = points[triangles]
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    quality = 4 * np.sqrt(3) * areas(points, triangles) / np.sum(sides**2, axis=1)
    assert np.median(quality) > 0.95
    assert quality.min() > 0.3


def test_edges_are_whole_sides() -> None:
    mesh = mesh_of(SLEEVE, 5.0)
    for edge, sides in SLEEVE.edges.items():
        ends = mesh.p[:, mesh.facets[:, mesh.boundaries[edge]]]
        lines = SLEEVE.sides[[s - 1 for s in sides]]
        length = np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1).sum()
        assert np.hypot(*(ends[:, 1] - ends[:, 0])).sum() == pytest.approx(length)


def test_an_upright_rectangle_is_made_of_quadrilaterals() -> None:
    mesh = mesh_of(CutPiece.rectangle(30.0, 60.0, grain_deg=20.0), 10.0)
    assert isinstance(mesh, MeshQuad)
    assert mesh.nelements == 18


@settings(max_examples=25)
@given(st.lists(st.floats(0.3, 1.0), min_size=3, max_size=12), st.floats(2.0, 30.0))
def test_any_star_shaped_outline_has_a_mesh(radii: list[float], size: float) -> None:
    angle = np.arange(len(radii)) / len(radii) * 2 * np.pi
    corners = 40 * np.array(radii)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    piece = CutPiece([tuple(corner) for corner in corners.tolist()])
    assert areas(*triangulation(piece, size)).sum() == pytest.approx(piece.area_mm2, rel=1e-9)


def test_a_sliver_gets_no_endless_mesh() -> None:
    sliver = CutPiece([(0.0, 0.0), (1000.0, 999.99), (1000.0, 1000.01)])
    assert len(triangulation(sliver, size_for(sliver, 600))[1]) < 2000


@pytest.mark.parametrize(
    ("field", "make"),
    [
        ("outline", lambda: CutPiece([(0, 0), (1, 1)])),
        ("outline", lambda: CutPiece([(0, 0), (9, 0), (9, 9), (0, 0)])),
        ("outline", lambda: CutPiece([(0, 0), (9, 9), (9, 0), (0, 9)])),
        ("outline", lambda: CutPiece([(0, 0), (np.nan, 0), (9, 9)])),
        (
            "outline",
            lambda: CutPiece([(0, 0), (9, 0), (9, 9)], holes=[[(20, 0), (25, 0), (25, 5)]]),
        ),
        ("outline", lambda: CutPiece([(float(i), float(i % 2)) for i in range(501)])),
        ("edges.hem", lambda: CutPiece([(0, 0), (9, 0), (9, 9)], edges={"hem": (4,)})),
        ("edges.hem", lambda: CutPiece([(0, 0), (9, 0), (9, 9)], edges={"hem": ()})),
        ("grain_deg", lambda: CutPiece([(0, 0), (9, 0), (9, 9)], grain_deg=np.inf)),
        ("width_mm", lambda: CutPiece.rectangle(0.0, 5.0)),
        ("mesh_mm", lambda: mesh_of(SLEEVE, 0.99 * size_for(SLEEVE, MAX_ELEMENTS))),
        ("mesh_mm", lambda: mesh_of(SLEEVE, -1.0)),
        ("edge", lambda: SLEEVE.sides_of("hem")),
    ],
)
def test_invalid_pieces_are_refused(field: str, make: object) -> None:
    with refuses(field):
        make()  # type: ignore[operator]
