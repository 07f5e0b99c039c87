"""Memory of the bending, and release of fabric against it."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from knitcore import StitchChart
from knitcore.base.arrays import Array
from scripts.training.charts import YARN_POINTS
from studies.rest_states import Bending, Candidate, Memory, Rest, held_flat, lengths, off_machine

YARN, LOOP = YARN_POINTS[0].yarn, YARN_POINTS[0].loop_length_mm
GARTER = StitchChart.parse("K/P")


@pytest.fixture
def helix() -> Array:
    """(samples, 4, 3): a helix and its derivatives, which bends by 1/mm everywhere."""
    angle = np.linspace(0.0, 3.0, 20)
    flat = [np.roll((np.cos(angle), np.sin(angle)), -k, axis=0) for k in range(2)]
    along = np.zeros_like(angle)
    position, speed = (*flat[0], angle), (-flat[0][1], flat[0][0], along + 1.0)
    bent, third = (-flat[0][0], -flat[0][1], along), (flat[0][1], -flat[0][0], along)
    return np.stack([position, speed, bent, third]).transpose(2, 0, 1)


@pytest.fixture(params=[False, True], ids=["turning", "held"])
def memory(helix: Array, request: pytest.FixtureRequest) -> Memory:
    """Memory of yarn that was bent a little less, and in another plane."""
    tangent = helix[:, 1] / np.sqrt(2.0)
    curvature = 0.9 * np.cross(tangent, helix[:, 2]) if request.param else np.full((20, 1), 0.3)
    return Memory(Bending(0.5, 0.1, request.param, added=True), np.ones(20), tangent, curvature)


def test_derivatives_of_the_memory_are_those_of_its_energy(memory: Memory, helix: Array) -> None:
    way = np.random.default_rng(0).standard_normal(helix.shape)
    up, down = (helix + step * way for step in (1e-6, -1e-6))
    flat = way[:, 1:3].reshape(20, 6)
    gain = memory.energy(up[:, 1], up[:, 2]) - memory.energy(down[:, 1], down[:, 2])
    np.testing.assert_allclose((memory.slopes(helix) * flat).sum(axis=1), gain / 2e-6, atol=1e-7)
    change = (memory.slopes(up) - memory.slopes(down)) / 2e-6
    second = np.einsum("imn,in->im", memory.curvatures(helix), flat)
    np.testing.assert_allclose(second, change, atol=1e-5)


def test_yarn_that_turns_as_a_whole_remembers_the_same(memory: Memory, helix: Array) -> None:
    before = memory.energy(helix[:, 1], helix[:, 2])
    across = np.cross(helix[0, 1], (1.0, 0.0, 0.0))
    turn = Rotation.from_rotvec(0.4 * across / np.linalg.norm(across)).as_matrix()
    after = memory.energy(helix[:1, 1] @ turn.T, helix[:1, 2] @ turn.T)
    assert after[0] == pytest.approx(before[0])


def test_the_memory_follows_as_far_as_it_must(memory: Memory, helix: Array) -> None:
    *_, away = memory.after(helix).away(helix[:, 1], helix[:, 2])
    assert np.linalg.norm(away, axis=1).max() == pytest.approx(0.1, rel=1e-4)


def test_fabric_off_the_machine_keeps_some_of_its_height_by_friction() -> None:
    loops = lengths(GARTER, LOOP)
    held = off_machine(GARTER, YARN, loops, 1.8)
    assert held.cell_course_mm == pytest.approx(1.8)
    free, rubbed = (Rest.held(held, Candidate(f)).release().size_mm[1] for f in (0.0, 0.26))
    flat = held_flat(GARTER, YARN, loops).cell_wale_mm
    assert free == pytest.approx(flat, rel=1e-3)
    assert 1.1 * flat < rubbed < held.cell_wale_mm


def test_set_keeps_the_shape_in_which_the_fabric_was_knitted() -> None:
    held = off_machine(GARTER, YARN, lengths(GARTER, LOOP), 1.8)
    free = Rest.held(held, Candidate()).release()
    kept = Rest.held(held, Candidate(0.0, Bending(0.9, held=True))).release()
    assert kept.size_mm[1] > free.size_mm[1] * 1.02
