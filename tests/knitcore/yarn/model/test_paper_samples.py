import pytest

from knitcore import Fabric, InputError
from knitcore.yarn.model.paper_samples import load_samples, sample


def test_eight_samples_with_shares_that_add_up():
    samples = load_samples()
    assert len(samples) == 8
    assert all(s.contact_share + s.bending_share == pytest.approx(1) for s in samples)


def test_swapped_loop_lengths_of_cotton_are_set_right():
    assert sample("cotton", Fabric.RIB).loop_length_mm == 17.94
    assert sample("cotton", Fabric.SEED).loop_length_mm == 17.32
    length = sample("cotton", "rib").parameters[-1]
    assert (length.printed, length.used) == (17.32, 17.94)
    assert "swapped" in length.reason


def test_thin_yarn_is_kept_as_run_and_stiffness_in_newton_per_cubic_millimetre():
    assert sample("acrylic", "garter").yarn.radius_mm == 0.54
    assert sample("cotton", "seed").yarn.contact_stiffness_n_per_mm3 == 0.0115


def test_configured_core_radius_differs_from_the_table():
    stockinette = sample("acrylic", "stockinette")
    yarn, loop_length_mm = stockinette.as_configured()
    assert (yarn.core_radius_mm, stockinette.yarn.core_radius_mm) == (0.325, 0.335)
    assert (yarn.bending_modulus_n_mm2, loop_length_mm) == (0.045, 11.28)


def test_unknown_sample_is_refused():
    with pytest.raises(InputError, match="contact data"):
        sample("silk", "rib")
    with pytest.raises(InputError, match="configuration"):
        sample("cotton", "rib").as_configured()
