"""Searches for a fabric: what is found, how it is ranked, and what is refused."""

from statistics import NormalDist
from typing import Any

import numpy as np
import pytest

from knitcore import Direction, Fabric, InputError, StitchChart, material
from knitcore.chart.repeats import repeats_up_to
from knitcore.design.atlas import CURVES, VALUES, Atlas
from knitcore.design.atlas_build import build_atlas
from knitcore.design.cost import CostLimits
from knitcore.design.find import FabricMatches, Quantity, Target, WornTube, find_fabric
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.mechanics.pressure import limb_pressure
from tests.knitcore.design.atlases import REPEATS, acrylic_atlas
from tests.knitcore.refusals import refuses

ACRYLIC = material("acrylic")


def find(*targets: Target, count: int = len(REPEATS), **options: Any) -> FabricMatches:
    """Search the small atlas of acrylic, by default for all its repeats."""
    return find_fabric(acrylic_atlas(), targets, count=count, **options)


@pytest.mark.parametrize("worn_mm", [206.0, 240.0, 260.0])
@pytest.mark.parametrize("direction", list(Direction))
@pytest.mark.parametrize("fabric", list(Fabric))
def test_a_wanted_pressure_is_that_of_the_pressure_model(
    fabric: Fabric, direction: Direction, worn_mm: float
) -> None:
    expected = limb_pressure(ACRYLIC.law(fabric), direction, 200.0, worn_mm).mmhg
    quantity = Quantity.PRESSURE_COURSE if direction is Direction.COURSE else Quantity.PRESSURE_WALE
    middle = float(np.sqrt(expected.low * expected.high))
    target = Target(quantity, middle, 0.05, limb=WornTube(200.0, worn_mm))
    search = find(target)
    key = acrylic_atlas().keys[acrylic_atlas().index_of(StitchChart.of_fabric(fabric)) or 0]
    own = next(c for c in search.candidates if c.repeat == key)
    assert own.values[target.label] == pytest.approx(middle, rel=0.01)
    assert own.reached
    assert own.intervals[target.label].low <= expected.low * 1.01
    assert own.intervals[target.label].high >= expected.high * 0.99


def test_stretch_at_a_load_and_poisson_s_ratio_together() -> None:
    law = ACRYLIC.law(Fabric.GARTER)
    strain = free_strains_at_stress(law, Direction.WALE, 0.05)
    stretch = Target(Quantity.STRETCH_WALE, strain, 0.02, load_n_per_mm=0.05)
    best = find(stretch, Target(Quantity.POISSON_WALE, law.poisson_xy, 0.02)).candidates[0]
    assert best.repeat == "P/K"
    assert best.reached
    assert "stretch_wale@0.05" in best.intervals


def test_one_quantity_at_two_loads_is_two_targets() -> None:
    targets = [
        Target(Quantity.STRETCH_COURSE, value, load_n_per_mm=load)
        for value, load in ((0.1, 0.01), (0.5, 0.1))
    ]
    assert len(find(*targets).candidates[0].values) == 2


def test_a_limb_beyond_the_lock_up_gives_nan() -> None:
    target = Target(Quantity.PRESSURE_WALE, 20.0, limb=WornTube(100.0, 900.0))
    search = find(target)
    assert not search.reached
    assert "no repeat stretches that far" in search.message


def test_limits_of_knitting_cost() -> None:
    target = Target(Quantity.MODULUS_COURSE, 0.2)
    free = find(target)
    easy = find(target, limits=CostLimits(transfers_per_stitch=0.0, curl=0.5))
    assert 0 < len(easy.candidates) < len(free.candidates)
    assert all(c.cost.transfers_per_stitch == 0 for c in easy.candidates)
    assert all(abs(c.cost.curl) <= 0.5 for c in easy.candidates)
    with pytest.raises(InputError, match="no repeat is within") as caught:
        find(target, limits=CostLimits(0.0, 0.0, 0.0))
    assert "Relax one" in caught.value.remedy


@pytest.mark.parametrize("index", range(len(REPEATS)))
def test_the_values_of_a_repeat_find_that_repeat(index: int) -> None:
    course, wale = np.exp(acrylic_atlas().log_moduli[index]).tolist()
    targets = (
        Target(Quantity.MODULUS_COURSE, course),
        Target(Quantity.EXTENSIBILITY_WALE, 1 / wale),
    )
    search = find(*targets)
    assert search.reached
    own = next(c for c in search.candidates if c.repeat == acrylic_atlas().keys[index])
    assert own.reached
    assert own.misfit == pytest.approx(0, abs=1e-3)
    assert own.deviations[Quantity.MODULUS_COURSE] == pytest.approx(0, abs=1e-3)


def test_candidates_are_ranked() -> None:
    search = find(Target(Quantity.ANISOTROPY, 1.0), count=5)
    ranks = [(-round(candidate.chance, 2), candidate.misfit) for candidate in search.candidates]
    assert ranks == sorted(ranks)
    for candidate in search.candidates:
        interval = candidate.intervals[Quantity.ANISOTROPY]
        assert interval.low < candidate.values[Quantity.ANISOTROPY] < interval.high


def test_the_surer_of_two_equal_predictions_comes_first() -> None:
    """A value on the target has 2Φ(z) − 1, where the tolerance is z standard deviations."""
    target = Target(Quantity.MODULUS_COURSE, 0.1, tolerance=0.2)
    factors = np.array([1.1, 1.5, 1.001])
    chance = target.chance(np.full(3, 0.1), 0.1 / factors, 0.1 * factors)
    deviations = np.log(1.2) / (np.log(factors) / NormalDist().inv_cdf(0.95))
    np.testing.assert_allclose(chance, [2 * NormalDist().cdf(z) - 1 for z in deviations])
    missed = target.chance(np.array([0.13]), np.array([0.125]), np.array([0.135]))
    assert missed < 0.02
    assert target.chance(*np.full((3, 1), np.nan)) == 0


def test_unreachable_targets_are_reported_with_the_nearest_repeat() -> None:
    search = find(Target(Quantity.MODULUS_COURSE, 5.0))
    assert not search.reached
    stiffest = int(acrylic_atlas().modulus(Direction.COURSE).argmax())
    assert search.candidates[0].repeat == acrylic_atlas().keys[stiffest]
    assert "No repeat meets this" in search.message
    assert "all repeats span" in search.message


def test_targets_that_can_be_met_singly_but_not_together() -> None:
    course, wale = (acrylic_atlas().modulus(d) for d in Direction)
    targets = [
        Target(Quantity.MODULUS_COURSE, float(course.max()), 0.01),
        Target(Quantity.MODULUS_WALE, float(wale.min()), 0.01),
    ]
    search = find(*targets)
    assert not search.reached
    assert "but not the other targets" in search.message


def test_within_all_tolerances_comes_before_better_on_the_average() -> None:
    values, curves = np.ones((2, len(VALUES))), np.zeros((2, *CURVES))
    values[0, VALUES.index("modulus_course_n_per_mm")] = 1.12  # beyond 10 %, wale exact
    values[1, VALUES.index("modulus_course_n_per_mm")] = 1.09
    values[1, VALUES.index("modulus_wale_n_per_mm")] = 1.09
    sources = "measured", "measured"
    atlas = Atlas("made", "", ("K", "KP"), values, curves, sources)
    targets = [Target(Quantity.MODULUS_COURSE, 1.0), Target(Quantity.MODULUS_WALE, 1.0)]
    search = find_fabric([atlas], targets)
    assert [candidate.repeat for candidate in search.candidates] == ["KP", "K"]
    assert search.candidates[0].misfit > search.candidates[1].misfit


def test_other_yarns_are_searched_too() -> None:
    lace = build_atlas(material("lace-bamboo"), repeats_up_to(1, 2))
    target = Target(Quantity.MODULUS_WALE, float(lace.column("modulus_wale_n_per_mm")[0]), 0.001)
    assert find_fabric([acrylic_atlas(), lace], [target]).candidates[0].material == "lace-bamboo"


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: find_fabric([], [Target(Quantity.ANISOTROPY, 1.0)]), "atlas"),
        (find, "targets"),
        (lambda: find(*[Target(Quantity.ANISOTROPY, 1.0)] * 2), "targets"),
        (lambda: Target(Quantity.ANISOTROPY, -1.0), "targets.anisotropy"),
        (lambda: Target(Quantity.ANISOTROPY, 1.0, weight=float("inf")), "targets.anisotropy"),
        (lambda: Target(Quantity.PRESSURE_WALE, 20.0), "targets.pressure_wale_mmhg"),
        (lambda: Target(Quantity.STRETCH_WALE, 0.1, load_n_per_mm=9), "targets.stretch_wale"),
        (lambda: WornTube(200.0, 200.0), "limb"),
    ],
)
def test_unusable_targets_are_refused(make: object, field: str) -> None:
    with refuses(field):
        make()


def test_a_fabric_whose_figures_contradict_each_other_never_ranks_first() -> None:
    """Acrylic garter course-wise, as published, is the stiffest: its width was misread."""
    atlas = build_atlas(material("acrylic:published"), ["K", "K/P", "KP", "KP/PK", "KKP/PPK"])
    limb = WornTube(200.0, 250.0)
    pressures = {}
    for quantity in (Quantity.PRESSURE_COURSE, Quantity.PRESSURE_WALE):
        target = Target(quantity, 1000.0, limb=limb)
        search = find_fabric(atlas, target)
        pressures[quantity] = [c.values[target.label] for c in search.candidates]
        last = search.candidates[-1]
        if quantity is Quantity.PRESSURE_COURSE:
            assert last.repeat == "K/P"
            assert last.values[target.label] == max(pressures[quantity])
    wale = pressures[Quantity.PRESSURE_WALE]
    assert wale == sorted(wale, reverse=True)


def test_one_atlas_and_one_target_by_name_are_enough() -> None:
    atlas = build_atlas(material("acrylic"), ["KKPP", "KP/PK"])
    target = Target("modulus_course", 0.04, tolerance=0.5)
    assert target == Target(Quantity.MODULUS_COURSE, 0.04, tolerance=0.5)
    alone, listed = find_fabric(atlas, target), find_fabric([atlas], [target])
    assert alone.to_dict() == listed.to_dict()
    with pytest.raises(InputError, match="quantity: 'modulus' is not known"):
        Target("modulus", 0.04)
