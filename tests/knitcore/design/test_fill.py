import os
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given

from knitcore import CancelledError, Direction, Fabric, InputError, StitchChart, material
from knitcore.design.atlas_build import predict_repeat
from knitcore.design.fill import FilledField, fill_field
from knitcore.design.part_targets import PartTarget, target_maps
from knitcore.design.patch_check import finite_size
from knitcore.design.region_patches import connected
from knitcore.garment.glove import Hand, glove
from knitcore.garment.plan import GarmentPlan
from knitcore.garment.shaped import largest_rectangle
from knitcore.garment.templates import Girth, limb_tube, sock_leg
from knitcore.mechanics.local_moduli import LocalModuli, local_moduli
from knitcore.prediction.predict import predict
from tests.knitcore.charts import stitch_charts
from tests.knitcore.design.atlases import REPEATS, acrylic_atlas

ACRYLIC = material("acrylic")
REPEATS_OF_GARTER = (StitchChart.parse("K\nP"), StitchChart.parse("P\nK"))


def filled(*maps: np.ndarray, **options: Any) -> FilledField:
    """Fill maps of moduli, course-wise and wale-wise, from the small atlas."""
    return fill_field(*maps, ACRYLIC, acrylic_atlas(), **options)


def maps_of(local: LocalModuli) -> np.ndarray:
    """Local moduli course-wise and wale-wise."""
    return np.array([local.modulus_course_n_per_mm, local.modulus_wale_n_per_mm])


def target_like(chart: StitchChart) -> np.ndarray:
    """The local moduli of a chart."""
    return maps_of(local_moduli(chart, ACRYLIC))


def swatch_is_known(field: FilledField) -> bool:
    """Say whether every patch was measured in the swatch."""
    return bool(np.isfinite([(r.swatch_course, r.swatch_wale) for r in field.regions]).all())


def hidden_chart(seed: int, side: int = 40, patches: int = 6, least: int = 8) -> StitchChart:
    """Rectangles of the four fabrics, on each other."""
    rng = np.random.default_rng(seed)
    fabric = np.full((side, side), rng.integers(4))
    for _ in range(patches):
        height, width = rng.integers(least, side // 2, 2)
        row, column = rng.integers(side - height), rng.integers(side - width)
        fabric[row : row + height, column : column + width] = rng.integers(4)
    purl = np.zeros((side, side), dtype=bool)
    for code, kind in enumerate(Fabric):
        purl[fabric == code] = StitchChart.of_fabric(kind, side, side).purl[fabric == code]
    return StitchChart(purl)


def fill_like(chart: StitchChart, noise: float = 0.0, **options: int) -> FilledField:
    """Fill the chart's own map, or one that was painted a little beside it."""
    factors = np.exp(np.random.default_rng(0).normal(0, noise, (2, *chart.purl.shape)))
    return filled(*target_like(chart) * factors, **options)


def off(field: FilledField, chart: StitchChart) -> float:
    """Share of the stitches whose moduli are off by more than 10 % of the hidden chart's."""
    ratios = maps_of(field.local) / target_like(chart)
    return float((np.abs(ratios - 1) > 0.10).any(axis=0).mean())


@pytest.mark.parametrize("seed", range(3))
def test_a_hidden_chart_of_the_four_fabrics_is_found_again(seed: int) -> None:
    """At most 5 % of the area off by more than 10 %, even from a map that is not exact."""
    for least in (5, 8):
        chart = hidden_chart(seed, least=least)
        assert off(fill_like(chart), chart) == 0
        for noise in (0.03, 0.05, 0.10):
            assert off(fill_like(chart, noise=noise), chart) <= 0.05


def test_patches_of_any_shape() -> None:
    """A disc of one mixed repeat in a field of another."""
    row, column = np.indices((32, 32))
    disc = (row - 16) ** 2 + (column - 14) ** 2 < 100
    inside, outside = (acrylic_atlas().index_of(StitchChart.parse(t)) for t in ("KKP", "PKK\nKPK"))
    moduli = np.exp(acrylic_atlas().log_moduli)
    maps = [np.where(disc, moduli[inside, axis], moduli[outside, axis]) for axis in range(2)]
    field = filled(*maps, smallest_patch=3)
    chosen = {acrylic_atlas().keys.index(region.repeat) for region in field.regions}
    assert chosen >= {inside, outside}
    patch = field.patches == field.patches[16, 14]
    assert (patch == disc).mean() > 0.98
    assert swatch_is_known(field)


@given(chart=stitch_charts())
def test_any_chart_is_read_back_from_its_own_map(chart: StitchChart) -> None:
    """Up to swapping all knits and purls, which no modulus tells apart."""
    field = fill_like(chart)
    assert field.chart in (chart, chart.swap())
    assert "read back" in field.messages[0]


@pytest.mark.parametrize("index", range(0, len(REPEATS), 3))
def test_a_uniform_target_is_met(index: int) -> None:
    """Within 5 %, by the prediction of the whole chart."""
    course, wale = (acrylic_atlas().modulus(d)[index] for d in Direction)
    field = filled(np.full((12, 12), course), np.full((12, 12), wale))
    assert len(field.regions) <= 1
    repeat = predict_repeat(field.chart.repeat(), ACRYLIC)
    assert repeat.modulus_course_n_per_mm == pytest.approx(course, rel=0.05)
    assert repeat.modulus_wale_n_per_mm == pytest.approx(wale, rel=0.05)
    assert not any("off" in message for message in field.messages)


@pytest.mark.slow
def test_a_target_between_the_repeats_is_met_by_a_mixture() -> None:
    """Stripes hidden in the target: no repeat of this small atlas comes near."""
    hidden = predict_repeat(StitchChart.parse("KKKKKKPKP\nKKKKKKKPK"), ACRYLIC)
    field = filled(*(np.full((20, 20), hidden.modulus_n_per_mm(d)) for d in Direction))
    mixture = predict_repeat(StitchChart.parse(field.regions[0].repeat), ACRYLIC)
    for direction in Direction:
        target = hidden.modulus_n_per_mm(direction)
        assert mixture.modulus_n_per_mm(direction) == pytest.approx(target, rel=0.08)
    assert field.off_share == 0


def test_patches_to_be_knitted_by_hand_have_no_scattered_stitches() -> None:
    """Single stitches would smooth the border of a disc."""
    row, column = np.indices((8, 8))
    disc = (row - 4) ** 2 + (column - 4) ** 2 < 7
    moduli = [np.where(disc, 0.031, 0.017), np.where(disc, 0.13, 0.3)]
    plain = filled(*moduli, scattered=False, check=False)
    assert len(plain.regions) > 1
    for number, region in enumerate(plain.regions):
        repeat = StitchChart.parse(region.repeat)
        cells = plain.patches == number
        assert any(
            np.array_equal(
                np.roll(g.purl, (a, b), (0, 1))[row % g.rows, column % g.columns][cells] ^ swapped,
                plain.chart.purl[cells],
            )
            for g in (repeat, repeat.mirror())
            for a in range(g.rows)
            for b in range(g.columns)
            for swapped in (False, True)
        )


def test_a_part_that_ends_before_the_clamp_is_judged_by_its_repeat() -> None:
    """The short finger hangs free when the others are pulled."""
    stitch = np.ones((12, 16), dtype=bool)
    stitch[4:8, 10:] = False
    stitch[8:, 13:] = False
    patches = np.where(stitch, 0, 2)
    patches[8:, 8:13] = 1
    repeats = [StitchChart.of_fabric(fabric) for fabric in (Fabric.STOCKINETTE, Fabric.RIB)]
    chart = StitchChart(np.where(patches == 0, False, np.indices(stitch.shape)[1] % 2 > 0))
    factors = finite_size(chart, ACRYLIC, patches, repeats, stitch=stitch)
    assert factors[1].tolist() == [1.0, 1.0]
    assert (factors[0] > 0).all()
    assert (factors[0] != 1).all()


def test_the_same_seed_gives_the_same_chart() -> None:
    chart = hidden_chart(3, side=24)
    assert fill_like(chart, 0.05, seed=5).chart == fill_like(chart, 0.05, seed=5).chart


@pytest.mark.slow
@pytest.mark.parametrize("smallest", [2, 5])
def test_patches_are_not_too_small(smallest: int) -> None:
    rng = np.random.default_rng(0)
    course, wale = np.exp(rng.uniform(-4, -1, (2, 20, 20)))
    field = filled(course, wale, smallest_patch=smallest)
    for patch in range(len(field.regions)):
        rows, columns = np.nonzero(field.patches == patch)
        assert np.ptp(rows) + 1 >= smallest
        assert np.ptp(columns) + 1 >= smallest
        assert field.regions[patch].stitches == len(rows)


@pytest.mark.parametrize("columns", [1, 3])
def test_a_part_narrower_than_a_patch_is_filled(columns: int) -> None:
    """Its repeat is cut off at the part's edge; the stitches beside it stay."""
    garter = ACRYLIC.law(Fabric.GARTER)
    runs = tuple((row, 0, columns) for row in range(12))
    cuff = PartTarget("cuff", runs, garter.modulus_course, garter.modulus_wale)
    course, wale = target_maps([cuff], 12, 10)
    knit = StitchChart.of_fabric(Fabric.STOCKINETTE, 12, 10)
    field = filled(course, wale, parts=[cuff], kept=knit)
    (region,) = field.regions
    assert region.stitches == 12 * columns
    assert region.repeat == "P/K"
    assert not field.chart.purl[:, columns:].any()
    assert field.chart.purl[:, :columns].mean() == pytest.approx(0.5)
    large, interval = garter.modulus_course, region.modulus_course_interval_n_per_mm
    assert interval.low <= min(large, region.modulus_course_n_per_mm)
    assert interval.high >= max(large, region.modulus_course_n_per_mm)


def runs_of(cells: np.ndarray) -> tuple[tuple[int, int, int], ...]:
    """The stitches of a part, one by one."""
    return tuple((row, column, 1) for row, column in np.argwhere(cells).tolist())


def moduli_of(chart: StitchChart, cells: np.ndarray) -> np.ndarray:
    """Predicted moduli of the largest rectangle in a part, course and wale."""
    inside = predict(StitchChart(chart.purl[largest_rectangle(cells)]), ACRYLIC)
    return np.array([inside.modulus_n_per_mm(direction) for direction in Direction])


def refilled(
    kept: StitchChart,
    targets: dict[str, tuple[np.ndarray, float]],
    stitch: np.ndarray | None = None,
) -> FilledField:
    """Fill parts that should be stiffer or softer by a factor, each as it is now."""
    targets = [
        PartTarget(name, runs_of(cells), *(factor * moduli_of(kept, cells)).tolist())
        for name, (cells, factor) in targets.items()
    ]
    maps = target_maps(targets, *kept.purl.shape)
    options = {"parts": targets, "kept": kept, "stitch": stitch}
    return filled(*maps, **options, scattered=False, check=False)


Partition = tuple[StitchChart, np.ndarray, dict[str, np.ndarray]]
"""A chart, where it has stitches, and the stitches of its parts by their names."""


def pieces_of_a_square(seed: int) -> Partition:
    """Two to four parts of any shape in a chart of fabrics."""
    rng = np.random.default_rng(seed)
    kept = hidden_chart(seed, side=int(rng.integers(12, 20)), patches=3, least=4)
    middles = rng.uniform(0, kept.rows, (rng.integers(2, 5), 1, 1, 2))
    places = np.stack(np.indices(kept.purl.shape), axis=-1)
    nearest = ((places - middles) ** 2).sum(axis=-1).argmin(axis=0)
    parts = {f"part {number}": nearest == number for number in np.unique(nearest).tolist()}
    return kept, np.ones(kept.purl.shape, dtype=bool), parts


@cache
def garments() -> tuple[GarmentPlan, ...]:
    """A glove, a sleeve and a sock, each with an outline and parts of several fabrics."""
    return (
        glove(Hand(), ACRYLIC),
        limb_tube("sleeve", [Girth(0, 180), Girth(200, 260)], ACRYLIC),
        sock_leg(220, 360, 200, ACRYLIC),
    )


def pieces_of_a_garment(seed: int) -> Partition:
    """The regions of a garment as its template makes them."""
    plan = garments()[seed % 3]
    stitch = plan.shaped.stitch
    return plan.shaped.chart, stitch, {r.name: r.cells & stitch for r in plan.regions}


def check_no_part_is_farther(partition: Partition, seed: int) -> None:
    """Fill the parts of a chart; not all have a target."""
    rng = np.random.default_rng(seed)
    kept, stitch, parts = partition
    first = next(iter(parts))
    targets = {
        name: (cells, float(rng.choice([0.4, 1 / 1.3, 1.3, 2.5])))
        for name, cells in parts.items()
        if name == first or rng.random() < 0.8
    }
    field = refilled(kept, targets, stitch)
    for part in field.parts:
        cells, factor = targets[part.name]
        before, after = moduli_of(kept, cells), moduli_of(field.chart, cells)
        assert [part.course_before_n_per_mm, part.wale_before_n_per_mm] == pytest.approx(before)
        assert [part.course_n_per_mm, part.wale_n_per_mm] == pytest.approx(after)
        left = np.hypot(*np.log(after / (factor * before)))
        assert left <= np.hypot(*np.log([factor, factor])) + 1e-9
        assert (np.sign(np.log(after / before)) * np.sign(np.log(factor)) >= 0).all()
        changed = (field.chart.purl != kept.purl)[cells].any()
        assert part.repainted or not changed
        assert part.repainted or any(part.name in message for message in field.messages)
        if not part.repainted:
            assert part.nearest.repeat in acrylic_atlas().keys
    outside = ~np.logical_or.reduce([cells for cells, _ in targets.values()])
    outside &= stitch
    assert np.array_equal(field.chart.purl[outside], kept.purl[outside])


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.slow
def test_no_part_is_farther_from_its_target_than_before(seed: int) -> None:
    """And what should be softer is nowhere stiffer."""
    check_no_part_is_farther(pieces_of_a_square(seed), seed)


@pytest.mark.slow
@pytest.mark.parametrize(("pieces", "count"), [(pieces_of_a_square, 4), (pieces_of_a_garment, 2)])
def test_no_part_is_farther_from_its_target_in_many_charts(
    pieces: Callable[[int], Partition], count: int
) -> None:
    """Set KNITCORE_FILLS, such as to 200, to fill more than each garment once."""
    for seed in range(100, 100 + int(os.environ.get("KNITCORE_FILLS", count))):
        check_no_part_is_farther(pieces(seed), seed)


@pytest.mark.slow
def test_each_part_has_its_own_repeat() -> None:
    """Also where parts touch, and one of them is reached only if the other stays."""
    knit = StitchChart.of_fabric(Fabric.STOCKINETTE, 16, 16)
    left = np.indices((16, 16))[1] < 8
    field = refilled(knit, {"soft": (left, 0.4), "stiff": (~left, 2.5)})
    soft, stiff = field.parts
    assert soft.repainted
    assert soft.course_n_per_mm < 0.6 * soft.course_before_n_per_mm
    assert not stiff.repainted
    assert not field.chart.purl[:, 8:].any()
    assert "“stiff” stays as it is, 2.5 times softer" in field.messages[-1]
    assert {region.part for region in field.regions} == {"soft"}
    assert field.off_share >= 0.5


def test_a_part_outside_the_piece_is_refused() -> None:
    stitch = np.ones((8, 8), dtype=bool)
    stitch[4:, 4:] = False
    targets = [
        PartTarget("body", ((0, 0, 8),), 0.1, None),
        PartTarget("gap", ((6, 5, 2),), 0.1, None),
    ]
    with pytest.raises(InputError, match="“gap” lies outside the outline"):
        filled(*target_maps(targets, 8, 8), parts=targets, stitch=stitch)


def test_stitches_without_a_target_are_not_constrained() -> None:
    garter = ACRYLIC.law(Fabric.GARTER)
    course = np.full((10, 10), np.nan)
    course[:, :5] = garter.modulus_course
    wale = np.where(np.isnan(course), np.nan, garter.modulus_wale)
    field = filled(course, wale)
    assert field.off_share == 0
    assert StitchChart(field.chart.purl[:, :5]).repeat() in REPEATS_OF_GARTER


PART = (slice(3, 10), slice(4, 13))


def target_in_part(fabric: Fabric) -> np.ndarray:
    """The fabric's moduli in a part of a chart."""
    maps = np.full((2, 14, 18), np.nan)
    for direction in Direction:
        maps[direction.axis][PART] = ACRYLIC.law(fabric).modulus(direction)
    return maps


@pytest.mark.parametrize("shift", [0, 1])
def test_a_filled_part_continues_its_surroundings(shift: int) -> None:
    """Garter wished for in garter: the rows go through, whichever of them is knit."""
    around = StitchChart.of_fabric("garter", 14, 18).purl ^ bool(shift)
    field = filled(*target_in_part(Fabric.GARTER), kept=StitchChart(around))
    assert np.array_equal(field.chart.purl, around)
    assert field.off_share == 0


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("fabric", [Fabric.SEED, Fabric.GARTER])
def test_stitches_without_a_target_are_kept_and_the_part_fitted_to_them(
    seed: int, fabric: Fabric
) -> None:
    kept = hidden_chart(seed, side=18, patches=4, least=4).purl[:14]
    maps = target_in_part(fabric)
    field = filled(*maps, kept=StitchChart(kept), seed=seed)
    outside = np.ones(kept.shape, dtype=bool)
    outside[PART] = False
    assert np.array_equal(field.chart.purl[outside], kept[outside])
    unaware = filled(*maps, seed=seed).chart.purl
    pasted = StitchChart(np.where(outside, kept, unaware))

    def distance(chart: StitchChart) -> float:
        return float(np.nansum(np.log(target_like(chart) / maps) ** 2))

    assert distance(field.chart) <= distance(pasted) + 1e-9
    assert swatch_is_known(field)
    assert sum(region.stitches for region in field.regions) in (0, 7 * 9)


def test_a_shaped_piece_is_filled_whatever_stands_where_it_has_no_stitch() -> None:
    """Also if a target reaches over its edge: the part of it inside is filled, and judged."""
    kept = hidden_chart(2, side=18, patches=4, least=4).purl[:14]
    stitch = np.ones(kept.shape, dtype=bool)
    stitch[5:9, 10:] = False
    fields = [
        filled(*target_in_part(Fabric.SEED), kept=StitchChart(chart), stitch=stitch)
        for chart in (kept, np.where(stitch, kept, ~kept))
    ]
    inside = fields[0].chart.purl[stitch]
    assert np.array_equal(inside, fields[1].chart.purl[stitch])
    outside = stitch.copy()
    outside[PART] = False
    assert np.array_equal(fields[0].chart.purl[outside], kept[outside])
    assert swatch_is_known(fields[0])
    assert fields[0].off_share <= 0.3


def test_the_missed_share_counts_stitches_with_a_target() -> None:
    course = np.full((12, 12), np.nan)
    course[:4, :4] = 9.0
    for kept in (None, StitchChart.of_fabric("rib", 12, 12)):
        field = filled(course, np.full((12, 12), np.nan), kept=kept)
        assert field.off_share == 1


def test_unreachable_targets_are_reported() -> None:
    field = filled(np.full((6, 6), 9.0), np.full((6, 6), np.nan))
    assert field.off_share == 1
    assert "softer course-wise than wanted" in field.messages[0]
    assert "In this yarn, repeats have" in field.messages[0]
    assert np.isnan(field.regions[0].deviation_wale)


def test_it_reports_progress_and_can_be_cancelled() -> None:
    shares: list[float] = []
    maps = target_like(hidden_chart(1, side=20, patches=3)) * [[[1.05]], [[1.0]]]
    filled(*maps, progress=shares.append)
    assert shares == sorted(shares)
    assert 0 <= shares[0] < shares[-1] <= 1
    with pytest.raises(CancelledError):
        filled(*maps, cancelled=lambda: True)


def test_patches_are_connected() -> None:
    labels = np.array([[0, 0, 1], [1, 0, 1], [1, 1, 0]])
    assert len(np.unique(connected(labels))) == 4


NAN = np.full((2, 2), np.nan)
CORNER = np.array([[1.0, np.nan], [np.nan, np.nan]])


@pytest.mark.parametrize(
    ("maps", "options", "says"),
    [
        ((np.ones((2, 3)), np.ones((3, 2))), {}, "differ in size"),
        ((NAN, NAN), {}, "there is no target"),
        ((np.zeros((2, 2)), np.ones((2, 2))), {}, "not positive"),
        ((np.full((2, 2), np.inf), np.ones((2, 2))), {}, "not positive"),
        ((np.ones((2, 2)), NAN), {"kept": StitchChart.parse("KP")}, "2x2"),
        ((CORNER, NAN), {"stitch": np.isnan(CORNER)}, "inside the outline"),
        ((np.ones((1, 3)),) * 2, {"stitch": np.array([[True, False, True]])}, "2 pieces"),
    ],
)
def test_maps_that_cannot_be_used(
    maps: tuple[np.ndarray, ...], options: dict[str, Any], says: str
) -> None:
    with pytest.raises(InputError, match=says):
        filled(*maps, **options)


def test_the_atlas_must_be_of_the_yarn() -> None:
    with pytest.raises(InputError, match="it was built for acrylic"):
        fill_field(CORNER, CORNER, material("cotton"), acrylic_atlas())
