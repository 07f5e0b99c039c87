"""Every input that is a choice among names: unknown ones are refused with those that are known."""

import pytest

from knitcore import Direction, Fabric
from knitcore.base.choice import Choice
from knitcore.cloth.flat import Clamps
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.study.relax import Branch
from tests.knitcore.refusals import refuses


@pytest.mark.parametrize("kind", [Direction, Fabric, Clamps, Convention, Branch])
def test_names_are_read_and_others_refused(kind: type[Choice]) -> None:
    assert [kind.parse(str(member)) for member in kind] == list(kind)
    with refuses(kind.__name__.lower()) as refused:
        kind.parse("sideways")
    assert all(member in refused.value.remedy for member in kind)


def test_a_fabric_may_be_written_in_capitals() -> None:
    assert Fabric.parse(" Garter ") is Fabric.GARTER
