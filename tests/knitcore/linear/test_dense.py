"""Dense linear algebra against NumPy's, and its order of sums."""

import numpy as np
import pytest

from knitcore.linear import dense

RNG = np.random.default_rng(2)


def _definite(count, rows):
    """A front (count, rows) of a positive definite matrix (rows, rows), and that matrix."""
    wide = RNG.standard_normal((rows, rows + 3))
    matrix = wide @ wide.T / rows + np.eye(rows)
    return matrix[:count].copy(), matrix


@pytest.mark.parametrize("shape", [(1, 1, 1), (6, 16, 4), (7, 35, 13), (40, 21, 33)])
@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_a_product_is_subtracted(shape, kind):
    columns, rows, terms = shape
    target, left, right = (
        RNG.standard_normal(of).astype(kind)
        for of in ((columns, rows), (terms, rows), (terms, columns))
    )
    expected = target.astype(float) - right.T.astype(float) @ left
    dense.subtract_product(target, left, right, False)
    np.testing.assert_allclose(target, expected, atol=100 * np.finfo(kind).eps)


@pytest.mark.parametrize(("count", "rows"), [(1, 1), (5, 5), (9, 40), (70, 70), (64, 130)])
def test_a_front_is_eliminated(count, rows):
    front, matrix = _definite(count, rows)
    assert dense.eliminate(front)
    expected = np.linalg.cholesky(matrix)[:, :count].T
    np.testing.assert_allclose(np.triu(front), np.triu(expected), atol=1e-12)


def test_the_products_of_a_sum_are_added_one_by_one():
    """The order that makes the result the same on every processor."""
    terms = RNG.standard_normal((50, 2)).astype(np.float32)
    target = np.zeros((1, 1), np.float32)
    dense.subtract_product(target, terms[:, :1].copy(), terms[:, 1:].copy(), False)
    total = np.float32(0.0)
    for first, second in terms:
        total -= first * second
    assert target[0, 0] == total


def test_matrices_that_are_not_definite_or_singular_are_refused():
    front, matrix = _definite(30, 30)
    front -= 1.01 * np.linalg.eigvalsh(matrix)[0] * np.eye(30)
    assert not dense.eliminate(front)
    assert not dense.eliminate(np.full((3, 3), np.nan))
    with pytest.raises(ZeroDivisionError):
        dense.solved(np.ones((2, 2)), np.ones(2))


@pytest.mark.parametrize("count", [1, 4, 19, 66])
def test_systems_are_solved(count):
    front, matrix = _definite(count, count)
    right = RNG.standard_normal((3, count))
    solution = right.copy()
    assert dense.eliminate(front)
    dense.substitute(front, solution)
    np.testing.assert_allclose(solution, np.linalg.solve(matrix, right.T).T, atol=1e-11)
    general = RNG.standard_normal((count, count))
    np.testing.assert_allclose(
        dense.solved(general, right[0]), np.linalg.solve(general, right[0]), rtol=1e-6
    )


def test_products_are_those_of_numpy():
    left, right = RNG.standard_normal((7, 40)), RNG.standard_normal((40, 13))
    np.testing.assert_allclose(dense.product(left, right), left @ right, atol=1e-13)
    np.testing.assert_allclose(dense.times(left, right[:, 2]), left @ right[:, 2], atol=1e-13)
    assert dense.dot(left[0], left[1]) == pytest.approx(left[0] @ left[1])
    assert dense.norm(left[0]) == pytest.approx(np.linalg.norm(left[0]))
    assert dense.times(np.zeros((0, 4)), np.ones(4)).shape == (0,)
    assert dense.product(np.zeros((2, 0)), np.zeros((0, 3))).tolist() == [[0.0] * 3] * 2
