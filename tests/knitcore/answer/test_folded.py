"""What a knitter knows of ribs and welts, and the formulas behind it."""

import csv
from importlib.resources import files

import numpy as np
import pytest

from knitcore.answer.folded import folded_repeat
from knitcore.answer.relaxed import RelaxedSize, SizeSource, known_size, stored_ratio
from knitcore.answer.repeat import Layout, Repeat
from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.law.response import Parallel
from knitcore.law.uniaxial import free_strains_at_stress, strain_at_stress
from knitcore.materials import Material, Yarn, load_library, material

LOADS = np.array([0.001, 0.01, 0.03, 0.05, 0.1, 0.2])


def repeat_of(text):
    return Repeat.of(StitchChart.parse(text))


RIB22 = repeat_of("KKPP")
WELT22 = repeat_of("K\nK\nP\nP")


def folded(repeat, yarn):
    return folded_repeat(repeat, yarn, known_size(repeat, yarn))


@pytest.mark.parametrize("identifier", load_library())
def test_wide_rib_draws_in_and_stretches_more_than_1x1(identifier):
    yarn = material(identifier)
    rib = yarn.record(Fabric.RIB)
    wide = folded(RIB22, yarn)
    assert wide.relaxed.course_mm < 0.9 * rib.stitch_course_mm
    narrow = free_strains_at_stress(rib.law, Direction.COURSE, LOADS)
    assert np.all(wide.along.strain(LOADS) > 1.1 * narrow)
    assert wide.along.modulus_n_per_mm < rib.law.modulus_course


@pytest.mark.parametrize("identifier", load_library())
def test_garter_welts_shorten(identifier):
    yarn = material(identifier)
    welt = folded(WELT22, yarn)
    heights = [yarn.record(f).stitch_wale_mm for f in (Fabric.STOCKINETTE, Fabric.GARTER)]
    assert welt.relaxed.wale_mm < 0.9 * min(heights)
    assert welt.along.modulus_n_per_mm < yarn.law(Fabric.GARTER).modulus_wale


@pytest.mark.parametrize("chart", [RIB22, repeat_of("KKKP"), WELT22])
def test_the_modulus_is_the_slope_of_the_curve(chart):
    repeat = folded(chart, material("lace-cashmere"))
    for direction in Direction:
        response = repeat.response(direction)
        small = 1e-7
        assert small / response.strain(small) == pytest.approx(response.modulus_n_per_mm, rel=2e-3)
        strains = response.strain(np.linspace(0, 0.2, 30))
        assert strains[0] == pytest.approx(0, abs=1e-12)
        assert np.all(np.diff(strains) > 0)


def test_under_load_the_flat_composite_comes_back():
    series = folded(RIB22, material("acrylic")).along
    fold = series.gap_mm * np.exp(-0.2 / series.unfolding_stress_n_per_mm)
    assert fold < 1e-6
    assert series.size_mm(0.0) == pytest.approx(series.relaxed_mm)


def test_a_repeat_wider_than_its_flat_composite_is_scaled():
    yarn = material("acrylic")
    series = folded_repeat(RIB22, yarn, RelaxedSize.from_gauge(20, 33)).along
    assert series.gap_mm == 0
    assert series.size_mm(0.0) == pytest.approx(5.0)
    flat = folded_repeat(RIB22, yarn, RelaxedSize.from_gauge(100 / series.flat_mm, 33)).along
    np.testing.assert_allclose(series.strain(LOADS), flat.strain(LOADS))


def test_a_gauge_is_as_good_as_the_table():
    size = RelaxedSize.from_gauge(50, 33)
    repeat = folded_repeat(RIB22, material("acrylic"), size)
    assert repeat.relaxed.source is SizeSource.GAUGE
    assert repeat.along.size_mm(0.0) == pytest.approx(2.0)
    for bad in ((0, 30), (30, float("nan")), (-1, 5)):
        with pytest.raises(InputError, match="is no gauge"):
            RelaxedSize.from_gauge(*bad)


def test_study_yarn_gives_the_study_s_strains():
    """The yarn-level study (L = 11.28 mm): 2x2 rib at 0.05 and 0.1 N/mm has 2.18 and 2.90, where
    1x1 rib has 1.47 and 2.09. Only ratios carry over to a material."""
    yarn = material("acrylic")
    ratio = folded(RIB22, yarn).along.strain(LOADS[3:5]) / free_strains_at_stress(
        yarn.law(Fabric.RIB), Direction.COURSE, LOADS[3:5]
    )
    np.testing.assert_allclose(ratio, [2.18 / 1.47, 2.90 / 2.09], rtol=0.15)


def test_ribs_wale_wise_follow_the_force_per_wale():
    yarn = material("acrylic")
    rib = yarn.record(Fabric.RIB)
    wide = folded(RIB22, yarn)
    expected = rib.law.modulus_wale * rib.stitch_course_mm / wide.relaxed.course_mm
    assert wide.across.modulus_n_per_mm == pytest.approx(expected)


def test_welts_course_wise_have_their_rows_in_parallel():
    yarn = material("acrylic")
    welt = folded(WELT22, yarn)
    assert isinstance(welt.across, Parallel)
    rows = [yarn.record(f) for f in (Fabric.STOCKINETTE, Fabric.GARTER)]
    force = sum(r.law.modulus_course * r.stitch_wale_mm for r in rows) / 2
    flat = sum(r.stitch_wale_mm for r in rows) / 2
    assert welt.across.modulus_n_per_mm == pytest.approx(force / flat)


def test_layouts():
    assert RIB22.layout is Layout.RIB
    assert WELT22.layout is Layout.WELT
    assert repeat_of("KP\nPK").layout is None


def test_one_cloth_has_one_size():
    basket = StitchChart.parse("KKPP\nKKPP\nPPKK\nPPKK")
    variants = [
        basket.mirror(),
        basket.swap(),
        basket.turn_over(),
        basket.mirror_vertical(),
        StitchChart(np.roll(basket.purl, (1, 3), axis=(0, 1))),
    ]
    cotton = material("cotton")
    assert {known_size(Repeat.of(v), cotton) for v in variants} == {
        known_size(Repeat.of(basket), cotton)
    }
    assert known_size(repeat_of("KKKKKPPPPP"), cotton) is None


@pytest.mark.parametrize("text", ["KKKPP", "K\nK\nP\nK\nP"])
def test_repeats_of_the_store_have_a_size_in_every_yarn(text):
    """Acrylic and cotton have their own ratio, other yarns the mean of the two."""
    repeat = repeat_of(text)
    ratios = {name: stored_ratio(repeat.chart, material(name)) for name in ("acrylic", "cotton")}
    mean = stored_ratio(repeat.chart, material("glove-wool"))
    np.testing.assert_allclose(mean, np.sqrt(np.prod(list(ratios.values()), axis=0)))
    size = known_size(repeat, material("glove-wool"))
    assert size is not None
    assert size.source is SizeSource.STORE
    pure = known_size(
        repeat_of("KP" if repeat.layout is Layout.RIB else "K\nP"), material("acrylic")
    )
    drawn_in = known_size(repeat, material("acrylic"))
    along = "course_mm" if repeat.layout is Layout.RIB else "wale_mm"
    assert getattr(drawn_in, along) < getattr(pure, along) * 1.2


def test_pure_fabrics_keep_their_size_in_the_table():
    yarn = material("lace-acrylic")
    for fabric in Fabric:
        size = known_size(Repeat.of(StitchChart.of_fabric(fabric, 2, 2)), yarn)
        assert size.course_mm == pytest.approx(yarn.record(fabric).stitch_course_mm)
        assert size.wale_mm == pytest.approx(yarn.record(fabric).stitch_wale_mm)


def test_without_yarn_data_the_study_s_unfolding_stress_is_used():
    acrylic = material("acrylic")
    bare = Material("bare", "bare", Yarn(), acrylic.fabrics)
    repeat = folded(repeat_of("KKKP"), bare)
    assert repeat.along.unfolding_stress_n_per_mm == 0.015


@pytest.mark.parametrize("fabric", Fabric)
@pytest.mark.parametrize("direction", Direction)
def test_strains_at_many_stresses_are_those_of_one(fabric, direction):
    law = material("lace-bamboo").law(fabric)
    many = free_strains_at_stress(law, direction, LOADS)
    one = [strain_at_stress(law, direction, s) for s in LOADS]
    np.testing.assert_allclose(many, one, rtol=1e-9)


MIRRORED = [
    "K",
    "K/P",
    "KP",
    "KP/PK",
    "KKP",
    "K/K/P",
    "K/K/K/P",
    "KP/KP/PK/PK",
    "KKPP/PPKK",
]


@pytest.mark.parametrize("text", MIRRORED)
def test_the_mirrored_sizes_are_those_of_our_yarn_level(text):
    from knitcore.yarnlevel.conventions import Convention
    from knitcore.yarnlevel.relax import Branch, relax
    from knitcore.yarnlevel.yarn import YarnModel

    chart = StitchChart.parse(text.replace("/", "\n"))
    cell = relax(
        chart,
        YarnModel(45e-3, 6e-4, 2.4, 0.74, 0.30),
        11.28,
        branch=Branch.MIRRORED,
        convention=Convention.AUTHORS_CODE,
    )
    table = files("knitcore.answer").joinpath("data", "relaxed_sizes.csv").read_text("utf-8")
    (row,) = (
        row
        for row in csv.DictReader(table.splitlines())
        if (row["branch"], row["chart"]) == ("mirrored", text)
    )
    tabled = float(row["course_mm"]), float(row["wale_mm"])
    assert (cell.cell_course_mm, cell.cell_wale_mm) == pytest.approx(tabled, rel=0.01)
