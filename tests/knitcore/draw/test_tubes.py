import numpy as np
import pytest

from knitcore import InputError
from knitcore.draw.tubes import tube_mesh
from knitcore.formats.write.yarn_mesh import loop_centre_line


def test_vertices_lie_on_the_radius_around_the_line() -> None:
    line = loop_centre_line(0) * [3.0, 2.0, 0.7]
    mesh = tube_mesh(line, 0.5, sides=8)
    distance = np.linalg.norm(mesh.vertices.reshape(len(line), 8, 3) - line[:, None], axis=2)
    np.testing.assert_allclose(distance, 0.5, rtol=1e-5)


def test_a_straight_tube_encloses_its_volume() -> None:
    line = np.stack([np.zeros(5), np.linspace(0, 4, 5), np.zeros(5)], axis=1)
    mesh = tube_mesh(line, 1.0, sides=64)
    corners = mesh.vertices[mesh.faces].astype(float)
    side_flux = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    caps = np.pi * 4.0 / 3.0  # the open end at y = 4 seen from the origin, as a cone
    assert side_flux + caps == pytest.approx(np.pi * 4.0, rel=5e-3)


@pytest.mark.parametrize(("points", "radius", "sides"), [(1, 1.0, 8), (5, 0.0, 8), (5, 1.0, 2)])
def test_tubes_without_volume_are_refused(points: int, radius: float, sides: int) -> None:
    with pytest.raises(InputError):
        tube_mesh(np.eye(5, 3)[:points], radius, sides)
