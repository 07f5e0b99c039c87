import math

import pytest

from knitcore import CancelledError, Direction, StitchChart, material
from knitcore.chart.repeats import repeats_up_to
from knitcore.design.atlas_build import build_atlas, predict_repeat
from knitcore.design.mixtures import Mixer

ACRYLIC = material("acrylic")


@pytest.fixture(scope="module")
def mixer() -> Mixer:
    """Mixes the repeats of up to 2 x 2 stitches."""
    return Mixer(build_atlas(ACRYLIC, repeats_up_to(2, 2)), ACRYLIC)


def test_a_target_between_two_fabrics_is_met_by_stripes_of_them(mixer: Mixer) -> None:
    hidden = StitchChart.parse("KKKKKKPKP\nKKKKKKKPK")
    target = predict_repeat(hidden, ACRYLIC)
    found = mixer.nearest(target.modulus_course_n_per_mm, target.modulus_wale_n_per_mm)
    assert found is not None
    assert found.off <= math.log(1.08)
    again = predict_repeat(found.repeat, ACRYLIC)
    for direction in Direction:
        assert again.modulus_n_per_mm(direction) == pytest.approx(
            target.modulus_n_per_mm(direction), rel=0.08
        )


def test_one_target_alone_is_enough(mixer: Mixer) -> None:
    found = mixer.nearest(0.1, float("nan"))
    assert found is not None
    assert found.modulus_course_n_per_mm == pytest.approx(0.1, rel=0.05)


def test_mixtures_fit_their_room(mixer: Mixer) -> None:
    found = mixer.nearest(0.1, 0.1, most_rows=4, most_columns=5)
    assert found is not None
    assert found.repeat.rows <= 4
    assert found.repeat.columns <= 5


def test_it_can_be_cancelled(mixer: Mixer) -> None:
    def stop() -> None:
        raise CancelledError("stopped")

    with pytest.raises(CancelledError):
        mixer.nearest(0.1, 0.1, look=stop)
