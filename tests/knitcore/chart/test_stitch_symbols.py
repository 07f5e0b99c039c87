"""Symbols of stitches: each has its own, inside its box, mirrored with its stitch."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore.chart.stitch_kinds import BY_CODE, STITCHES, StitchType
from knitcore.chart.stitch_symbols import StitchSymbol, symbol_of

WAYS = [{}, {"dashes": True}, {"japanese": True}]


def outline(symbol: StitchSymbol) -> tuple[object, ...]:
    strokes = {tuple((round(x, 4), round(y, 4)) for x, y in stroke) for stroke in symbol.strokes}
    return frozenset(strokes), frozenset(symbol.dots)


@pytest.mark.parametrize("way", WAYS)
def test_no_two_stitches_have_one_symbol(way: dict[str, bool]) -> None:
    drawn = {outline(symbol_of(stitch, **way)) for stitch in STITCHES}
    assert len(drawn) == len(STITCHES)


@pytest.mark.parametrize("way", WAYS)
@given(stitch=st.sampled_from(STITCHES))
def test_a_symbol_stays_in_its_box(way: dict[str, bool], stitch: StitchType) -> None:
    symbol = symbol_of(stitch, **way)
    points = [*symbol.dots, *(point for stroke in symbol.strokes for point in stroke)]
    assert all(0 <= x <= stitch.width and 0 <= y <= 1 for x, y in points)


@given(st.sampled_from([s for s in STITCHES if s.width > 1 or s.takes > 1]))
def test_mirrored_stitches_have_mirrored_strokes(stitch: StitchType) -> None:
    ends, images = (
        sorted(
            (round(stitch.width * side + (1 - 2 * side) * x, 3), round(y, 3))
            for stroke in symbol_of(of).strokes
            if len(stroke) == 2
            for x, y in stroke
        )
        for of, side in ((stitch, 0), (stitch.mirrored, 1))
    )
    assert stitch.sites[0].turn or ends == images


def test_the_loop_in_front_runs_through() -> None:
    cross = symbol_of(STITCHES[BY_CODE["[1/1R]"]])
    assert ((0.5, 0.1), (1.5, 0.9)) in cross.strokes
    assert len(cross.strokes) == 3
