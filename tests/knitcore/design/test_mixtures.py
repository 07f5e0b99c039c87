import pytest

from knitcore import CancelledError, material
from knitcore.chart.repeats import repeats_up_to
from knitcore.design.atlas_build import build_atlas
from knitcore.design.mixtures import Mixer

ACRYLIC = material("acrylic")


@pytest.fixture(scope="module")
def mixer() -> Mixer:
    """Mixes the repeats of up to 2 x 2 stitches."""
    return Mixer(build_atlas(ACRYLIC, repeats_up_to(2, 2)), ACRYLIC)


def test_one_target_alone_is_enough(mixer: Mixer) -> None:
    mixture = mixer.nearest(0.1, float("nan"))
    assert mixture.modulus_course_n_per_mm == pytest.approx(0.1, rel=0.05)


@pytest.mark.slow
def test_mixtures_fit_their_room(mixer: Mixer) -> None:
    mixture = mixer.nearest(0.1, 0.1, most_rows=4, most_columns=5)
    assert mixture.repeat.rows <= 4
    assert mixture.repeat.columns <= 5


def test_it_can_be_cancelled(mixer: Mixer) -> None:
    def stop() -> None:
        raise CancelledError("stopped")

    with pytest.raises(CancelledError):
        mixer.nearest(0.1, 0.1, look=stop)
