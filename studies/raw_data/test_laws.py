"""The paper's constants from the authors' tests."""

from pathlib import Path

import pytest

from knitcore.chart.fabric import Direction
from knitcore.fit.pull_fit import Reduction
from knitcore.fit.strip_fit import fit_tests

X = Direction.COURSE

PUBLISHED = {
    "Stockinette": (0.204, 0.930, 1.111, 2.537, 0.046, 0.010, 0.444, 0.430),
    "Garter": (0.241, 0.060, 1.170, 0.802, 0.022, 0.022, 0.481, 0.150),
    "Rib": (0.011, 0.126, 0.385, 1.251, 0.011, 0.034, 0.208, 0.294),
    "Seed": (0.074, 0.020, 1.148, 0.568, 0.027, 0.017, 0.471, 0.138),
}
"""Tables 9 and 10: C_xxxx, C_yyyy, alpha_xx, alpha_yy, beta_xx, beta_yy, nu_yx, nu_xy."""


@pytest.mark.parametrize("fabric", PUBLISHED)
def test_published_reduction_gives_the_published_constants(study_data: Path, fabric: str) -> None:
    files = [study_data / "uniaxial" / f"outputData_Acrylic Yarn {fabric} {d}.h5" for d in "XY"]
    fit = fit_tests(*files, reduction=Reduction.PUBLISHED)
    law, expected = fit.law, PUBLISHED[fabric]
    assert law.poisson_yx == pytest.approx(expected[6], abs=0.001)
    assert law.poisson_xy == pytest.approx(expected[7], abs=0.001)
    assert law.stiffness_xxxx == pytest.approx(expected[0], rel=0.10)
    assert law.stiffness_yyyy == pytest.approx(expected[1], rel=0.10)
    assert law.alpha_xx == pytest.approx(expected[2], rel=0.05)
    assert law.alpha_yy == pytest.approx(expected[3], rel=0.05)
    assert law.beta_xx == pytest.approx(expected[4], rel=0.25)
    assert law.beta_yy == pytest.approx(expected[5], rel=0.25)
    assert fit.rms_n_per_mm < 0.03 * max(fit.residuals[X].stress.max(), 0.1)


def test_uniform_reduction_differs_where_the_notes_say(study_data: Path) -> None:
    """Clamp to clamp, garter's C_yyyy is 0.08 and stockinette's C_xxxx 0.31 to 0.33 N/mm."""
    folder = study_data / "uniaxial"
    stiffness = {}
    for fabric in ("Garter", "Stockinette"):
        files = [folder / f"outputData_Acrylic Yarn {fabric} {d}.h5" for d in "XY"]
        stiffness[fabric] = fit_tests(*files, reduction=Reduction.UNIFORM).law
    assert stiffness["Garter"].stiffness_yyyy == pytest.approx(0.078, rel=0.08)
    assert stiffness["Stockinette"].stiffness_xxxx == pytest.approx(0.313, rel=0.08)
