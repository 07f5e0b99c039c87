"""Tests of cut cloth: on the bias, in two directions and in a frame."""

import math
from pathlib import Path

import numpy as np
import pytest

from app.context import Context
from app.operations.cloth.cut_tests import (
    BiasRequest,
    BiaxialRequest,
    TrellisRequest,
    bias,
    biaxial,
    trellis,
)
from knitcore.base.errors import CancelledError, InputError
from knitcore.chart.fabric import Fabric
from knitcore.materials import material
from tests.app.operations.cloth.test_piece import ASKED


def test_a_bias_strip_has_an_interval(context: Context) -> None:
    result, straight = (
        bias(BiasRequest.model_validate(ASKED | {"strain": 0.2, "angle_deg": angle}), context)
        for angle in (45.0, 0.0)
    )
    (low, high), force = np.array(result.force_interval_n), np.array(result.force_n)
    assert np.all(low < force)
    assert np.all(force < high)
    taut = math.sqrt(2 - 1.2**2) - 1  # of rows and columns that only turn
    # cloth is soft in shear: on the bias its Poisson's ratio is above a half, and below theirs
    assert taut < result.waist_strain[-1] < -0.5 * 0.2
    assert result.force_n[-1] < straight.force_n[-1]


def test_equal_pulls_of_seed_stitch_in_both_directions(context: Context) -> None:
    request = {"strain_x": 0.1, "strain_y": 0.1, "mesh_mm": 50}
    result = biaxial(BiaxialRequest.model_validate(ASKED | request), context)
    turned = biaxial(BiaxialRequest.model_validate(ASKED | request | {"grain_deg": 90}), context)
    assert result.force_x_n == pytest.approx(turned.force_y_n, rel=1e-6)
    for end, other in zip(result.force_x_interval_n, turned.force_y_interval_n, strict=True):
        assert end == pytest.approx(other, rel=1e-3)


def test_a_frame_measures_the_shear_modulus(context: Context) -> None:
    request = TrellisRequest.model_validate(ASKED | {"angle_deg": 2, "mesh_mm": 50})
    result = trellis(request, context)
    law, angle = material("acrylic").law(Fabric.STOCKINETTE), math.radians(2)
    modulus = law.shear_modulus * (1 + law.shear_stiffening * angle**2)
    assert result.angle_deg == pytest.approx([1.0, 2.0])
    assert result.shear_stress_n_per_mm[-1] / angle == pytest.approx(modulus, rel=1e-6)


def test_too_fine_a_mesh_is_for_the_command_line(context: Context, tmp_path: Path) -> None:
    request = BiasRequest.model_validate(ASKED | {"strain": 0.2, "steps": 900})
    with pytest.raises(InputError) as refused:
        bias(request, context)
    assert refused.value.field == "mesh_mm"
    with pytest.raises(CancelledError):
        bias(request, Context(tmp_path, local=True, cancelled=lambda: True))
