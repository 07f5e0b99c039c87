"""A yarn from a ruler, a scale and photos, against yarns of the library."""

import math

import numpy as np
import pytest

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import free_strains_at_stress, uniaxial_response
from knitcore.materials import load_library, material
from knitcore.materials.estimate.without_tester import (
    KnownSwatch,
    points_of_law,
    yarn_without_tester,
)
from knitcore.materials.material_document import MaterialDocument
from knitcore.measure.stretch_points import StretchPoint

FABRIC = Fabric.STOCKINETTE
RECORD = material("cotton").record(FABRIC)


def hung(law: ConstitutiveLaw, *directions: Direction) -> list[StretchPoint]:
    """Half a litre and one and a half of water on 110 mm, without errors."""
    points = []
    for direction in directions:
        for stress in (0.045, 0.135):
            along = free_strains_at_stress(law, direction, stress)
            across = float(uniaxial_response(law, direction, [along]).transverse_strain[0])
            points.append(StretchPoint(FABRIC, direction, stress, along, 0.004, across, 0.004))
    return points


def known(**more: float) -> KnownSwatch:
    return KnownSwatch(FABRIC, 100 / RECORD.stitch_course_mm, 100 / RECORD.stitch_wale_mm, **more)


def width(interval: object) -> float:
    return math.log(interval.high / interval.low)  # type: ignore[attr-defined]


@pytest.mark.slow
def test_each_measurement_narrows_what_it_is_about() -> None:
    area = RECORD.stitch_course_mm * RECORD.stitch_wale_mm
    weight = RECORD.loop_length_mm * 0.394e-3 * 120 * 150 / area
    swatch = known(
        weight_g=weight, width_mm=120, height_mm=150, tex=394, wraps_per_inch=10.5,
        ten_stitches_mm=10 * RECORD.loop_length_mm,
    )  # fmt: skip
    yarn = yarn_without_tester(swatch, hung(RECORD.law, *Direction))
    names = [step.name for step in yarn.steps]
    assert names == [
        "library", "ball band", "gauge and weight", "ten stitches",
        "photos, pulled course-wise", "photos, pulled wale-wise",
    ]  # fmt: skip
    library, band, gauge, ten, course, wale = yarn.steps
    assert width(band.bending_modulus_n_mm2) < 0.4 * width(library.bending_modulus_n_mm2)
    assert width(gauge.loop_length_mm) < 0.3 * width(library.loop_length_mm)
    assert width(ten.loop_length_mm) < width(gauge.loop_length_mm)
    assert ten.strain_at_load == library.strain_at_load
    for before, after, direction in (
        (ten, course, Direction.COURSE),
        (course, wale, Direction.WALE),
    ):
        now = after.strain_at_load[direction]
        assert width(now) < 0.5 * width(before.strain_at_load[direction])
        assert now.low < free_strains_at_stress(RECORD.law, direction, 0.1) < now.high
    assert wale.loop_length_mm.value == pytest.approx(RECORD.loop_length_mm, rel=0.03)
    assert wale.bending_modulus_n_mm2.low < 0.0708 < wale.bending_modulus_n_mm2.high
    assert wale.other_strains < library.other_strains
    assert yarn.fabrics[FABRIC].law.poisson_yx == pytest.approx(RECORD.law.poisson_yx, abs=0.06)
    assert not yarn.notes


@pytest.mark.slow
def test_intervals_cover_the_other_fabrics_of_the_library() -> None:
    inside = []
    for yarn in [*load_library().values()][::3]:
        record = yarn.record(FABRIC)
        swatch = KnownSwatch(FABRIC, 100 / record.stitch_course_mm, 100 / record.stitch_wale_mm)
        made = yarn_without_tester(swatch, hung(record.law, *Direction))
        for fabric, estimate in made.fabrics.items():
            for direction, strain in estimate.strain_at_load.items():
                true = free_strains_at_stress(yarn.law(fabric), direction, 0.1)
                inside.append(strain.low < true < strain.high)
    assert np.mean(inside) > 0.85


def test_the_yarn_becomes_a_material_with_its_uncertainty() -> None:
    yarn = yarn_without_tester(known(), hung(RECORD.law, Direction.COURSE))
    kept = MaterialDocument.from_material(yarn.material("mine", "Mine", "cotton")).to_material()
    assert kept.is_complete
    assert kept.yarn.fibre == "cotton"
    own, other = kept.record(FABRIC), kept.record(Fabric.RIB)
    assert own.stitch_course_mm == pytest.approx(RECORD.stitch_course_mm)
    assert own.uncertainty.curve(Direction.COURSE).log_stress < 0.5 * (
        other.uncertainty.curve(Direction.COURSE).log_stress
    )
    assert "wale-wise" not in kept.note
    assert any("course-wise only" in note for note in yarn.notes)


def test_tests_of_one_fabric_serve_in_place_of_photos() -> None:
    yarn = yarn_without_tester(known(), points_of_law(FABRIC, RECORD.law), source="tests")
    assert yarn.steps[-1].name == "tests, pulled wale-wise"
    stretch = yarn.fabrics[FABRIC].strain_at_load[Direction.WALE]
    assert stretch.value == pytest.approx(
        free_strains_at_stress(RECORD.law, Direction.WALE, 0.1), rel=0.05
    )


def test_contradictions_are_noted_or_refused() -> None:
    notes = yarn_without_tester(known(ten_stitches_mm=220)).notes
    assert any("against that from gauge" in note for note in notes)
    with pytest.raises(InputError, match="cannot make ten stitches"):
        yarn_without_tester(known(ten_stitches_mm=12))
    with pytest.raises(InputError, match="tex"):
        known(tex=0.4)
