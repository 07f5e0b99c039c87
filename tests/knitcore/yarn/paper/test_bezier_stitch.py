import numpy as np
import pytest

from knitcore.chart.fabric import Fabric
from knitcore.yarn.kernels.potential import potential
from knitcore.yarn.model.conventions import REGULARISATION_N_MM4, Convention
from knitcore.yarn.model.paper_samples import load_samples, sample
from knitcore.yarn.paper import bezier_contact as contact
from knitcore.yarn.paper.bezier_relax import first_shapes
from knitcore.yarn.paper.bezier_stitch import Stitch
from knitcore.yarn.paper.elastic import bernstein, elastic_energy, gauss_tables


def case(fabric, convention=Convention.PUBLISHED):
    known = sample("acrylic", fabric)
    stitch = Stitch(fabric, known.yarn, convention)
    return stitch, first_shapes(stitch, known.loop_length_mm, 3)[2]


@pytest.mark.parametrize("convention", list(Convention))
@pytest.mark.parametrize("fabric", list(Fabric))
def test_gradients_are_the_derivatives(fabric, convention):
    stitch, unknowns = case(fabric, convention)
    energies = stitch.evaluate(unknowns)
    for i in range(stitch.size):
        step = np.zeros(stitch.size)
        step[i] = 1e-6
        above, below = (stitch.evaluate(unknowns + s * step) for s in (1, -1))
        slope = (above.energy_n_mm - below.energy_n_mm) / 2e-6
        lengths = (above.lengths_mm - below.lengths_mm) / 2e-6
        largest = np.abs(energies.gradient).max()
        assert energies.gradient[i] == pytest.approx(slope, rel=1e-4, abs=1e-5 * largest)
        assert energies.length_gradient[:, i] == pytest.approx(lengths, abs=1e-6)


@pytest.mark.parametrize("fabric", list(Fabric))
def test_bending_agrees_with_a_fine_sum_of_textbook_formulas(fabric):
    stitch, unknowns = case(fabric)
    controls = stitch.controls(unknowns)
    points = 4000
    t = (np.arange(points) + 0.5) / points
    total = 0.0
    for curve in controls:
        v, a = (bernstein(t, d) @ curve for d in (1, 2))
        speed = np.linalg.norm(v, axis=1)
        curvature = np.linalg.norm(np.cross(v, a), axis=1) / speed**3
        vector = (a - v * (np.sum(v * a, axis=1) / speed**2)[:, None]) / speed[:, None] ** 2
        change = np.linalg.norm(np.gradient(vector, t, axis=0), axis=1) / speed
        density = 0.5 * stitch.yarn.bending_modulus_n_mm2 * curvature**2
        density += REGULARISATION_N_MM4 * change**2
        total += np.mean(density * speed)
    assert stitch.evaluate(unknowns).bending_n_mm == pytest.approx(total, rel=1e-4)


@pytest.mark.parametrize("fabric", list(Fabric))
def test_contact_agrees_with_the_sum_over_ordered_pairs(fabric):
    # the authors' sum: every point with every point of every image, each way
    stitch, unknowns = case(fabric)
    controls, yarn = stitch.controls(unknowns), stitch.yarn
    points, _, lengths, arclengths = contact.contact_points(controls, *contact.midpoint_tables())
    course, wale = unknowns[-2:]
    images = contact.course_images(fabric)
    law = yarn.contact_stiffness_n_per_mm3, yarn.contact_exponent
    law += yarn.radius_mm, yarn.core_radius_mm
    total = 0.0
    for n in range(-3, 4):
        for m in range(-images, images + 1):
            sign = (-1.0) ** (m * fabric.course_odd + n * fabric.wale_odd)
            other = points * [1, 1, sign] + [m * course, n * wale, 0]
            apart = np.linalg.norm(points[:, None] - other[None], axis=2)
            near = apart < 2 * yarn.radius_mm
            if n == 0:
                along = np.abs(arclengths[:, None] - arclengths[None] - m * lengths.sum())
                near &= along > 2.1 * yarn.radius_mm
            for i, j in np.argwhere(near):
                total += potential(apart[i, j], *law) * lengths[i] * lengths[j]
    assert stitch.evaluate(unknowns).contact_n_mm == pytest.approx(total, rel=1e-9)


def test_a_straight_curve_costs_nothing():
    controls = np.linspace([0, 0, 0], [2, 1, 0.5], 6)[None].astype(float)
    gradient, lengths, by_point = np.zeros_like(controls), np.empty(1), np.empty_like(controls)
    energy = elastic_energy(controls, 1.0, 1.0, *gauss_tables(), gradient, lengths, by_point)
    assert energy == pytest.approx(0.0, abs=1e-12)
    assert lengths[0] == pytest.approx(np.sqrt(5.25))
    assert gradient == pytest.approx(np.zeros_like(gradient), abs=1e-8)


def test_quadrature_is_fine_enough():
    nodes, weights = np.polynomial.legendre.leggauss(200)
    fine = weights / 2, np.stack([bernstein((nodes + 1) / 2, d) for d in (1, 2, 3)])
    for known in load_samples():
        stitch = Stitch(known.fabric, known.yarn)
        unknowns = first_shapes(stitch, known.loop_length_mm, 2)[known.yarn_id == "cotton"]
        controls = stitch.controls(unknowns)
        room = np.zeros_like(controls), np.empty(8), np.empty_like(controls)
        energy = elastic_energy(
            controls, 0.5 * known.yarn.bending_modulus_n_mm2, REGULARISATION_N_MM4, *fine, *room
        )
        assert stitch.evaluate(unknowns).bending_n_mm == pytest.approx(energy, rel=1e-5)
