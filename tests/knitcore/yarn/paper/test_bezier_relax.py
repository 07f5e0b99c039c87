from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from knitcore import ConvergenceError, Fabric, UnravelledError
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.paper_samples import Sample, load_samples, sample
from knitcore.yarn.model.relaxed_cell import RelaxedCell
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.paper.bezier_relax import first_shapes, lowest, relax_published
from knitcore.yarn.paper.bezier_shape import unknown_names
from knitcore.yarn.paper.bezier_stitch import Stitch
from knitcore.yarn.paper.certificate import is_certified, is_clasped
from knitcore.yarn.paper.continuation import free_constraints, is_admissible
from knitcore.yarn.paper.minimise import BezierMinimum, minimise_bezier
from tests.knitcore.refusals import refuses

SAMPLES = load_samples()
NAMES = [f"{s.yarn_id}-{s.fabric}" for s in SAMPLES]


def settled(stitch: Stitch, start: np.ndarray, known: Sample) -> BezierMinimum:
    """The minimum that a start leads to at the loop length of a sample."""
    return minimise_bezier(
        stitch, start, known.loop_length_mm, free_constraints(known.loop_length_mm)
    )


def published(known: Sample, *sizes_mm: float, **options: Any) -> RelaxedCell:
    """The stitch of a sample, at sizes that are held if there are any."""
    return relax_published(known.fabric, known.yarn, known.loop_length_mm, *sizes_mm, **options)


def turned_over(unknowns: np.ndarray, fabric: Fabric) -> np.ndarray:
    """A shape whose strands have passed through each other."""
    swapped = unknowns.copy()
    swapped[unknown_names(fabric).index("tilt")] *= -1.0
    return swapped


@pytest.mark.parametrize("known", SAMPLES, ids=NAMES)
def test_published_energies_and_shares(known):
    # Supplementary Table 8 (printed in J, meant in mJ = N mm)
    cell = published(known, starts=2)
    assert cell.converged
    assert cell.energy_n_mm == pytest.approx(known.energy_n_mm, rel=0.03)
    assert cell.contact_share == pytest.approx(known.contact_share, abs=0.015)
    assert cell.bending_share + cell.contact_share == pytest.approx(1.0)
    assert cell.yarn_length_mm == pytest.approx(known.loop_length_mm, rel=1e-5)


@pytest.mark.parametrize(("course_mm", "energy"), [(2.80, 0.40451), (5.32, 0.89431)])
@pytest.mark.slow
def test_authors_example_curve(course_mm, energy):
    # their sample results for stockinette, core300x, first and last point
    entries = sample("acrylic", "stockinette").parameters
    configured = {entry.name: entry.configured for entry in entries}
    loop_length_mm = configured.pop("loop_length_mm")
    yarn = YarnModel(**(configured | {"core_radius_mm": 0.300}))
    options = {"cell_course_mm": course_mm, "convention": Convention.AUTHORS_CODE, "starts": 1}
    cell = relax_published("stockinette", yarn, loop_length_mm, **options)
    assert cell.cell_course_mm == course_mm
    assert cell.energy_n_mm == pytest.approx(energy, rel=1e-3)


@pytest.mark.parametrize("known", SAMPLES, ids=NAMES)
def test_packaged_shapes_are_stationary(known):
    stitch = Stitch(known.fabric, known.yarn)
    start = first_shapes(stitch, known.loop_length_mm, 2)[known.yarn_id == "cotton"]
    before = stitch.evaluate(start)
    after = settled(stitch, start, known)
    assert before.lengths_mm.sum() == pytest.approx(known.loop_length_mm, rel=1e-5)
    assert before.energy_n_mm == pytest.approx(after.energy_n_mm, rel=1e-3)
    assert np.abs(after.force_n).max() < 5e-4  # N; garter ends on a constraint


def test_random_starts_end_in_one_minimum():
    known = sample("cotton", Fabric.SEED)
    stitch = Stitch(known.fabric, known.yarn)
    energies = [
        settled(stitch, start, known).energy_n_mm
        for start in first_shapes(stitch, known.loop_length_mm, 5)[2:]
    ]
    assert np.ptp(energies) < 1e-4


def test_conventions_weigh_the_same_stitch_differently():
    known = sample("cotton", "stockinette")
    energies = [
        relax_published("stockinette", known.yarn, 12.28, convention=c, starts=1).energy_n_mm
        for c in (Convention.PAPER, Convention.PUBLISHED, Convention.AUTHORS_CODE)
    ]
    assert energies == sorted(energies)
    assert energies[0] < 0.9 * energies[1]


@pytest.mark.slow
def test_holding_a_size_costs_energy():
    known = sample("cotton", "rib")
    free = published(known, starts=1)
    wider = published(known, 1.2 * free.cell_course_mm, starts=1)
    both = published(known, 1.2 * free.cell_course_mm, 1.1 * wider.cell_wale_mm, starts=1)
    assert free.energy_n_mm < wider.energy_n_mm < both.energy_n_mm
    assert both.cell_wale_mm == pytest.approx(1.1 * wider.cell_wale_mm)


def test_thicker_core_grows_into_place():
    # the packaged shape overlaps with this core, so the core has to grow first
    known = sample("cotton", "stockinette")
    thick = replace(known.yarn, core_radius_mm=0.42)
    cell = relax_published("stockinette", thick, known.loop_length_mm, starts=2)
    assert cell.converged
    assert cell.energy_n_mm > known.energy_n_mm


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("loop_length_mm", {"loop_length_mm": 6.0}),
        ("loop_length_mm", {"loop_length_mm": 600.0}),
        ("loop_length_mm", {"loop_length_mm": float("nan")}),
        ("cell_course_mm", {"cell_course_mm": 40.0}),
        ("cell_wale_mm", {"cell_wale_mm": 0.01}),
        ("starts", {"starts": 0}),
        ("fabric", {"fabric": "lace"}),
        ("convention", {"convention": "ours"}),
    ],
)
def test_impossible_stitches_are_refused(field, arguments):
    known = sample("acrylic", "stockinette")
    given = {"fabric": "stockinette", "yarn": known.yarn, "loop_length_mm": 11.3} | arguments
    with refuses(field):
        relax_published(**given)


def test_jammed_unravelled_and_unfinished_stitches_are_refused():
    known = sample("acrylic", "rib")
    stitch = Stitch(known.fabric, known.yarn)
    start = first_shapes(stitch, known.loop_length_mm, 1)[0]
    good = settled(stitch, start, known)
    assert lowest(stitch, [good]) is good
    thick = replace(known.yarn, core_radius_mm=0.501 * good.evaluation.closest_mm)
    with pytest.raises(ConvergenceError, match="jammed"):
        lowest(Stitch(known.fabric, thick), [good])
    with pytest.raises(ConvergenceError, match="starts"):
        lowest(stitch, [replace(good, converged=False)])
    swapped = turned_over(good.unknowns, known.fabric)
    certified = is_certified(stitch, start, swapped)
    assert not certified
    with pytest.raises(UnravelledError):
        lowest(stitch, [replace(good, unknowns=swapped, certified=certified)])


@pytest.mark.slow
def test_a_size_beyond_the_yarn_is_refused():
    known = sample("cotton", "stockinette")
    with pytest.raises(ConvergenceError, match="natural"):
        relax_published("stockinette", known.yarn, 12.28, cell_course_mm=9.0, starts=1)


@pytest.mark.parametrize("fabric", list(Fabric))
def test_strands_that_passed_through_each_other_are_noticed(fabric):
    known = sample("acrylic", fabric)
    stitch = Stitch(fabric, known.yarn)
    start = first_shapes(stitch, known.loop_length_mm, 1)[0]
    minimum = settled(stitch, start, known)
    assert is_admissible(stitch, minimum)
    swapped = turned_over(minimum.unknowns, fabric)
    # all stitches turned over: another fabric in stockinette only, but no way there in any
    assert is_clasped(stitch, swapped) == (fabric is not Fabric.STOCKINETTE)
    assert is_certified(stitch, start, minimum.unknowns)
    assert not is_certified(stitch, minimum.unknowns, swapped)


def test_all_starts_are_reported():
    known = sample("cotton", "stockinette")
    cell = published(known, starts=3)
    assert [start.name for start in cell.starts] == ["start 1", "start 2", "start 3"]
    relaxed = [start.energy_n_mm for start in cell.starts if start.outcome == "relaxed"]
    assert min(relaxed) == cell.energy_n_mm


@pytest.mark.parametrize("fabric", list(Fabric))
def test_centre_lines_cover_the_repeat(fabric):
    known = sample("cotton", fabric)
    cell = published(known, starts=1)
    across, up = 1 + fabric.course_odd, 1 + fabric.wale_odd
    assert len(cell.centre_lines) == up
    for line in cell.centre_lines:
        assert np.linalg.norm(np.diff(line, axis=0), axis=1).sum() == pytest.approx(
            across * known.loop_length_mm, rel=5e-3
        )
        over = line[-1] - line[0]
        np.testing.assert_allclose(over, [across * cell.cell_course_mm, 0.0, 0.0], atol=1e-9)
        # the next repeat goes on in the same direction
        ends = np.array([line[1] - line[0], line[-1] - line[-2]])
        ends /= np.linalg.norm(ends, axis=1)[:, None]
        assert ends[0] @ ends[1] > 0.95
