import pytest

from knitcore import StitchChart
from knitcore.design.cost import knitting_cost


@pytest.mark.parametrize(
    ("text", "transfers", "curl"),
    [("K", 0, 1), ("KP", 0, 0), ("K\nP", 1, 0), ("KP\nPK", 1, 0), ("KKP", 0, 1 / 3)],
)
def test_costs_of_knitting(text: str, transfers: float, curl: float) -> None:
    cost = knitting_cost(StitchChart.parse(text))
    assert (cost.transfers_per_stitch, cost.curl) == pytest.approx((transfers, curl))
