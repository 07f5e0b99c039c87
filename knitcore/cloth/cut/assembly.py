"""Energy, forces and tangent of a piece by scikit-fem's bases and forms."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.cloth.cut.cut_cloth import Cloth
from knitcore.cloth.flat.grid_kernel import respond
from knitcore.cloth.flat.sheet_models import EnergyModel

QUADRATURE_ORDER = 4


@dataclass(frozen=True, eq=False)
class Assembled:
    """A piece in one state.

    Attributes
    ----------
    energy : N·mm; infinite if a fibre has collapsed to a point: the rest is then meaningless.
    force : N, (2, nodes), gradient of the energy.
    tangent : N/mm, sparse (2 * nodes, 2 * nodes): all x displacements, then all y.
    """

    energy: float
    force: Array
    tangent: scipy.sparse.csr_array


class PieceEnergy:
    """The elastic energy of cloth, and of tapes on its edges, as a function of displacements.

    Parameters
    ----------
    mesh : of scikit-fem, in mm.
    cloth : laws under it.
    turn : (2, 2), columns are the unit vectors along course and wale.
    element : of scikit-fem, scalar; by default quadratic ones.
    order : of the quadrature.
    """

    def __init__(
        self,
        mesh: Any,
        cloth: Cloth,
        turn: Array,
        *,
        element: Any = None,
        order: int = QUADRATURE_ORDER,
    ) -> None:
        from skfem import Basis, ElementQuad2, ElementTriP2, MeshQuad  # slow to import

        if element is None:
            element = ElementQuad2() if isinstance(mesh, MeshQuad) else ElementTriP2()
        self.basis = Basis(mesh, element, intorder=order)
        self.cloth = cloth
        self.turn = turn
        self.shape: tuple[int, int] = self.basis.dx.shape
        x, y = np.asarray(self.basis.global_coordinates())
        course, wale = np.tensordot(turn.T, (x, y), axes=1)
        self.law_of_point = cloth.law_at(course, wale)
        self._turned = np.kron(turn, turn)
        """Matrix from (a0, a1, b0, b1) in the frame of the fibres to gradients in the piece's."""

    def fibres(self, displacement: Array) -> Array:
        """Images (elements, points, 4) of the unit vectors along course and wale, a then b, in the
        frame of the fibres at rest.
        """
        gradient = np.array([self.basis.interpolate(u).grad for u in displacement])  # i, j
        gradient += np.eye(2)[:, :, None, None]
        columns = gradient.transpose(2, 3, 1, 0).reshape(*self.shape, 4)
        images: Array = columns @ self._turned
        return images

    def at(self, displacement: Array, tapes: list[tuple[Any, float]]) -> Assembled:
        """Energy, forces and tangent.

        Parameters
        ----------
        displacement : (2, nodes), mm.
        tapes : bases of edges, and the stiffnesses (N) of the tapes on them.
        """
        density, stress, stiffness = self._respond(displacement, self.cloth.sheet.parameters)
        energy = float(np.sum(density * self.basis.dx))
        if energy == np.inf:
            return Assembled(energy, np.empty(0), scipy.sparse.csr_array((0, 0)))
        # by column j and component i of the gradient, twice
        h = (self._turned @ stiffness @ self._turned.T).reshape(*self.shape, 2, 2, 2, 2)
        force = self._force(stress)
        xx, xy, yy = (
            _tangent(self.basis, h[:, :, :, i, :, k]) for i, k in ((0, 0), (0, 1), (1, 1))
        )
        for edge, tape in tapes:
            more, pull, blocks = _tape(edge, displacement, tape)
            energy += more
            force += pull
            xx, xy, yy = (a + b for a, b in zip((xx, xy, yy), blocks, strict=True))
        return Assembled(
            energy, force, scipy.sparse.csr_array(scipy.sparse.block_array([[xx, xy], [xy.T, yy]]))
        )

    def law_force(self, laws: NDArray[np.void], displacement: Array) -> Array:
        """Force (2, nodes), N, under other laws, given as records like the sheet's parameters."""
        return self._force(self._respond(displacement, laws)[1])

    def _respond(self, displacement: Array, laws: NDArray[np.void]) -> tuple[Array, Array, Array]:
        """Energy densities (elements, points) and their derivatives by the fibres."""
        fibres = self.fibres(displacement).reshape(-1, 4)
        stress, stiffness = np.empty(fibres.shape), np.empty((*fibres.shape, 4))
        model = self.cloth.sheet.model
        density = respond(
            laws,
            self.law_of_point.ravel(),
            model.energy is EnergyModel.PUBLISHED,
            fibres,
            stress,
            stiffness,
        )
        return density.reshape(self.shape), stress, stiffness

    def _force(self, stress: Array) -> Array:
        """Forces (2, nodes) of the derivatives (elements * points, 4) by the fibres."""
        p = (stress @ self._turned.T).reshape(*self.shape, 2, 2)
        return np.array([_force(self.basis, p[..., i]) for i in range(2)])


def _force(basis: Any, p: Array) -> Array:
    """Integral of p (elements, points, 2) times the gradient of each shape function."""
    from skfem import LinearForm

    px, py = p[..., 0], p[..., 1]
    form = LinearForm(lambda v, _: px * v.grad[0] + py * v.grad[1])
    forces: Array = form.assemble(basis)
    return forces


def _tangent(basis: Any, h: Array) -> Any:
    """Integral of the gradients of two shape functions times h (elements, points, 2, 2)."""
    from skfem import BilinearForm

    hxx, hxy, hyx, hyy = h[..., 0, 0], h[..., 0, 1], h[..., 1, 0], h[..., 1, 1]

    def form(u: Any, v: Any, _: Any) -> Array:
        (ux, uy), (vx, vy) = u.grad, v.grad
        density: Array = vx * (hxx * ux + hxy * uy) + vy * (hyx * ux + hyy * uy)
        return density

    return BilinearForm(form).assemble(basis)


def _tape(edge: Any, displacement: Array, stiffness: float) -> tuple[float, Array, tuple[Any, ...]]:
    """Energy, forces (2, nodes) and the blocks xx, xy, yy of the tangent of a tape, which is slack
    where it would be compressed.
    """
    from skfem import BilinearForm, LinearForm

    normal = edge.normals
    tangent = np.array([-normal[1], normal[0]])
    along = np.array(
        [t + np.einsum("j...,j...", edge.interpolate(u).grad, tangent)
         for u, t in zip(displacement, tangent, strict=True)]
    )  # fmt: skip
    length = np.hypot(*along)
    unit = along / length
    strain = np.maximum(length - 1, 0.0)
    pull = stiffness * strain
    taut = np.where(length > 1, stiffness, 0.0)

    def slope(v: Any) -> Array:
        along_edge: Array = v.grad[0] * tangent[0] + v.grad[1] * tangent[1]
        return along_edge

    force = np.array(
        [LinearForm(lambda v, _, f=pull * u: f * slope(v)).assemble(edge) for u in unit]
    )
    blocks = []
    for i, k in ((0, 0), (0, 1), (1, 1)):
        h = (taut - pull / length) * unit[i] * unit[k] + (i == k) * pull / length
        form = BilinearForm(lambda u, v, _, h=h: h * slope(u) * slope(v))
        blocks.append(form.assemble(edge))
    return float(np.sum(pull * strain / 2 * edge.dx)), force, tuple(blocks)
