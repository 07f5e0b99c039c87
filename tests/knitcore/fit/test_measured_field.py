"""Measured displacement fields: reading, comparing, calibrating."""

from dataclasses import asdict, replace

import numpy as np
import pytest

from knitcore import Direction, Fabric, InputError, material
from knitcore.cloth.flat import SheetModel
from knitcore.fit.calibration import calibrate
from knitcore.fit.field_comparison import Edges, compare
from knitcore.fit.measured_field import MeasuredField, measured_field
from knitcore.law.constitutive import ConstitutiveLaw
from tests.knitcore.cloth.flat.synthetic import PITCH_PX, camera_arrays

GARTER = material("acrylic:published").law(Fabric.GARTER)


def synthetic_field(law: ConstitutiveLaw = GARTER) -> MeasuredField:
    return measured_field(*camera_arrays(law, SheetModel()), PITCH_PX)


def test_a_synthetic_field_is_read_back() -> None:
    field = synthetic_field()
    assert field.width == pytest.approx(960)
    assert field.length == pytest.approx(320)
    assert [field.stretch(f) for f in field.frames] == pytest.approx([0.15, 0.3], abs=0.004)
    for edges in Edges:
        errors = compare(field, GARTER, Direction.WALE, edges=edges).frames
        assert max(f.ux_rms_percent_width for f in errors) < 0.06
        assert max(f.uy_rms_percent_width for f in errors) < 0.06


@pytest.mark.slow
def test_calibration_finds_the_law_of_a_synthetic_field() -> None:
    truth = replace(GARTER, shear_modulus=0.03, kappa_xx=0.4, kappa_yy=0.4)
    fit = calibrate(synthetic_field(truth), GARTER, Direction.WALE)
    assert fit.law.shear_modulus == pytest.approx(0.03, rel=0.25)
    assert fit.parameters["coupling_factor"] == pytest.approx(1.0, abs=0.15)
    assert fit.frames == (2, 3)


def test_a_picture_turned_by_a_quarter_gives_the_same_errors() -> None:
    """Pulled along the picture's x instead of y; the law is another, so that errors are seen."""
    displacement, frame = camera_arrays(GARTER, SheetModel())
    turned = np.stack([displacement[:, 1], displacement[:, 0]], axis=1).transpose(0, 1, 3, 2)
    other = material("acrylic:published").law(Fabric.SEED)
    upright, lying = (
        compare(measured_field(u, frame), other, Direction.WALE, edges=Edges.RIGID).frames
        for u in (displacement, turned)
    )
    for before, after in zip(upright, lying, strict=True):
        assert before.ux_rms_percent_width > 0.05
        assert after.ux_rms_percent_width == pytest.approx(before.ux_rms_percent_width, rel=1e-3)
        assert after.uy_rms_percent_width == pytest.approx(before.uy_rms_percent_width, rel=1e-2)


def test_a_course_wise_pull_is_compared_along_the_courses() -> None:
    """The field of a wale-wise pull is a course-wise one if x and y of the law are exchanged."""
    field = measured_field(*camera_arrays(GARTER, SheetModel()))
    other_way = str.maketrans("xy", "yx")
    exchanged = ConstitutiveLaw(**{k.translate(other_way): v for k, v in asdict(GARTER).items()})
    errors = compare(field, exchanged, Direction.COURSE, edges=Edges.MEASURED).frames
    assert max(max(f.ux_rms_percent_width, f.uy_rms_percent_width) for f in errors) < 0.06


def test_pictures_can_be_left_out() -> None:
    field = synthetic_field()
    assert [f.number for f in field.only({3}).frames] == [3]
    with pytest.raises(InputError, match="frames"):
        field.only({7})


@pytest.mark.parametrize(
    "shape", [(3, 2, 10), (3, 1, 10, 10), (3, 2, 10, 10)], ids=["flat", "one part", "still"]
)
def test_fields_that_cannot_be_used_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(InputError, match="field"):
        measured_field(np.zeros(shape), np.arange(3))
