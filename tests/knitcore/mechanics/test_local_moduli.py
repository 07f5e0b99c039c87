"""Local moduli: pure fabrics, bounds, symmetry, patches and windows."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from knitcore import Direction, Fabric, InputError, StitchChart, material
from knitcore.chart.fabric import PHASES
from knitcore.chart.phases import QUARTERS_OF_CODE, surroundings
from knitcore.materials import Laws, load_library
from knitcore.mechanics.local_moduli import local_moduli, stitch_table, windows_of
from tests.knitcore.charts import stitch_charts


@pytest.mark.parametrize("identifier", [*load_library(Laws.PUBLISHED), "cotton:simulation"])
@pytest.mark.parametrize("fabric", Fabric)
def test_pure_fabrics_have_their_law(identifier, fabric):
    yarn = material(identifier)
    maps = local_moduli(StitchChart.of_fabric(fabric, rows=5, columns=6), yarn)
    law = yarn.law(fabric)
    np.testing.assert_allclose(maps.modulus_course_n_per_mm, law.modulus_course, rtol=1e-13)
    np.testing.assert_allclose(maps.modulus_wale_n_per_mm, law.modulus_wale, rtol=1e-13)
    np.testing.assert_allclose(
        maps.extensibility_wale_mm_per_n * maps.modulus_wale_n_per_mm, 1, rtol=1e-13
    )


@pytest.mark.parametrize("identifier", load_library(Laws.PUBLISHED))
def test_every_kind_lies_between_its_phases(identifier):
    yarn = material(identifier)
    table = stitch_table(yarn)
    for code, quarters in enumerate(QUARTERS_OF_CODE):
        laws = [yarn.law(PHASES[p]) for p in quarters.ravel()]
        for direction in Direction:
            moduli = [law.modulus(direction) for law in laws]
            value = table.modulus_n_per_mm(direction)[code]
            assert min(moduli) * (1 - 1e-12) <= value <= max(moduli) * (1 + 1e-12)
            low, high = table.modulus_interval_n_per_mm(direction)
            assert low[code] < value < high[code]
    np.testing.assert_allclose(table.fractions.sum(axis=1), 1)


def test_log_deviations_are_the_delta_method():
    yarn = material("acrylic:published")
    table = stitch_table(yarn)
    for code in range(16):
        phases = QUARTERS_OF_CODE[code]
        spreads = [yarn.record(PHASES[p]).uncertainty for p in phases.ravel()]
        if len(np.unique(phases)) == 1:
            spread = spreads[0]
            assert table.log_sd_course[code] == pytest.approx(spread.log_modulus_course)
            assert table.log_sd_wale[code] == pytest.approx(spread.log_modulus_wale)
        else:
            assert 0 < table.log_sd_course[code] <= max(s.log_modulus_course for s in spreads)


@given(stitch_charts(8))
def test_turning_over_mirrors_the_maps(chart):
    yarn = material("cotton:published")
    face, back = local_moduli(chart, yarn), local_moduli(chart.turn_over(), yarn)
    for name in ("modulus_course_n_per_mm", "modulus_wale_n_per_mm"):
        np.testing.assert_allclose(getattr(face, name), getattr(back, name)[:, ::-1], rtol=1e-13)


@given(stitch_charts(8), st.data())
def test_a_window_holds_what_a_stroke_changes_and_its_surroundings_determine_it(chart, data):
    touched = tuple(
        slice(*sorted(data.draw(st.tuples(st.integers(0, n), st.integers(0, n)))))
        for n in chart.shape
    )
    painted = chart.purl.copy()
    painted[touched] ^= data.draw(hnp.arrays(bool, painted[touched].shape))
    windows = [windows_of(each, n) for each, n in zip(touched, chart.shape, strict=True)]
    changed, around = zip(*windows, strict=True)
    inside = tuple(
        slice(c.start - a.start, c.stop - a.start) for c, a in zip(changed, around, strict=True)
    )
    codes = surroundings(chart)
    codes[changed] = surroundings(StitchChart(painted[around]))[inside]
    np.testing.assert_array_equal(codes, surroundings(StitchChart(painted)))


def test_two_regions_have_their_own_moduli_inside():
    yarn = material("acrylic:published")
    purl = np.zeros((20, 40), dtype=bool)
    purl[:, 20:] = StitchChart.of_fabric("garter", 20, 20).purl
    maps = local_moduli(StitchChart(purl), yarn)
    assert maps.modulus_course_n_per_mm[1:-1, 1:19] == pytest.approx(
        yarn.law(Fabric.STOCKINETTE).modulus_course
    )
    assert maps.modulus_wale_n_per_mm[1:-1, 21:-1] == pytest.approx(
        yarn.law(Fabric.GARTER).modulus_wale
    )


def test_a_missing_fabric_matters_only_where_it_is_used():
    needle = material("glove-wool:needle-2.0mm:published")
    plain = local_moduli(StitchChart.of_fabric("stockinette", 3, 3), needle)
    assert plain.modulus_course_n_per_mm == pytest.approx(0.793, rel=0.01)
    with pytest.raises(InputError, match="has no rib"):
        local_moduli(StitchChart.of_fabric("rib", 3, 3), needle)
