"""Kinds of input: what is not of the kind is refused with the field and what to give."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from knitcore import Direction, Fabric, material
from knitcore.base.kinds import as_mask, as_numbers, check_callables, check_flags
from knitcore.cloth.cut.outline import CutPiece
from knitcore.draw.tubes import tube_mesh
from knitcore.law.uniaxial import free_strains_at_stress, uniaxial_response
from knitcore.mechanics.elastica import Parity
from knitcore.mechanics.reduced_symmetry import SegmentGeometry
from tests.knitcore.refusals import refuses

WORDS: list[Any] = ["0.2 mm", [object()], [[1], [1, 2]], {}]
LAW = material("acrylic").law(Fabric.GARTER)


def test_numbers_may_come_in_lists_but_not_in_words() -> None:
    assert as_numbers("strain", [1, 2], "Give numbers.").tolist() == [1.0, 2.0]
    for wrong in WORDS:
        with refuses("strain", r"cannot be read as numbers. Give numbers.$"):
            as_numbers("strain", wrong, "Give numbers.")


def test_a_mask_is_a_copy_and_holds_nothing_else() -> None:
    given = np.eye(2, dtype=bool)
    mask = as_mask("stitch", given, "Give a table.")
    mask[0, 0] = False
    assert given[0, 0]
    assert as_mask("stitch", [[0, 1]], "Give a table.").dtype == bool
    for wrong in ([True, False], [[0, 2]], [["K", "P"]]):
        with refuses("stitch", "Give a table.$"):
            as_mask("stitch", wrong, "Give a table.")


def test_flags_and_functions() -> None:
    check_flags(flat=np.True_, even=False)
    check_callables(progress=None, cancelled=lambda: False)
    with refuses("flat", "is of type int. Give True or False.$"):
        check_flags(flat=1)
    with refuses("cancelled", "is of type bool. Give a function.$"):
        check_callables(cancelled=True)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("field", "call"),
    [
        ("stress", lambda wrong: free_strains_at_stress(LAW, Direction.WALE, wrong)),
        ("strain", lambda wrong: uniaxial_response(LAW, Direction.WALE, wrong)),
        ("curve_mm", lambda wrong: SegmentGeometry.from_curve(Parity.EVEN, wrong)),
        ("centre_line", lambda wrong: tube_mesh(wrong, 0.5)),
        ("outline", lambda wrong: CutPiece([wrong, wrong, wrong])),
    ],
)
def test_numbers_in_words_are_refused_everywhere(field: str, call: Callable[[str], object]) -> None:
    with refuses(field, "cannot be read as numbers"):
        call("x")
