import numpy as np
import pytest

from knitcore.chart.fabric import Direction
from tests.knitcore.results import sweep


def test_strains_refer_to_the_force_free_cell():
    stretched = sweep(Direction.WALE, [0.0, 0.5], [0.0, -0.1], [0.0, 0.3])
    assert stretched.strain == pytest.approx([0.0, 0.5])
    assert stretched.transverse_strain == pytest.approx([0.0, -0.1])
    assert stretched.cells[1].cell_mm(Direction.WALE) == pytest.approx(3.0)
    assert stretched.seconds == pytest.approx(1.0)
    assert stretched.converged
    assert np.all(stretched.bending_share + stretched.contact_share == 1.0)


@pytest.mark.parametrize(
    ("share", "strain"), [((0.2, 0.4, 0.6), 0.3), ((0.6, 0.7, 0.8), 0.0), ((0.1, 0.2, 0.3), None)]
)
def test_strain_at_which_contact_overtakes_bending(share, strain):
    along = np.array([0.0, 0.2, 0.4])
    stretched = sweep(Direction.COURSE, along, -0.1 * along, along, contact_share=share)
    overtakes = stretched.contact_overtakes_at_strain
    assert overtakes == (None if strain is None else pytest.approx(strain))
