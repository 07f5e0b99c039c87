from __future__ import annotations

import contextlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from knitcore import Fabric, InputError, StitchChart
from knitcore.design.atlas import (
    VALUES,
    Atlas,
    build_atlas,
    knitting_cost,
    load_atlas,
    predict_repeat,
    save_atlas,
)
from knitcore.design.find import Quantity, Target, find_fabric
from knitcore.design.repeats import repeats_up_to
from knitcore.errors import CancelledError
from knitcore.materials import Material, material
from knitcore.mechanics.prediction import Prediction
from knitcore.yarnlevel.known import known_repeat

ACRYLIC = material("acrylic")
REPEATS = repeats_up_to(2, 3)
ATLAS = build_atlas(ACRYLIC, REPEATS)


@pytest.mark.parametrize("fabric", list(Fabric))
def test_pure_fabrics_have_their_measured_laws(fabric: Fabric) -> None:
    index = ATLAS.index_of(StitchChart.of_fabric(fabric, rows=2, columns=2))
    assert index is not None
    law = ACRYLIC.law(fabric)
    assert ATLAS.column("modulus_course_n_per_mm")[index] == pytest.approx(law.modulus_course)
    assert ATLAS.column("modulus_wale_n_per_mm")[index] == pytest.approx(law.modulus_wale)
    assert ATLAS.provenance[index] == "measured"


def test_repeats_of_the_store_have_their_yarn_level_law() -> None:
    basket = StitchChart.parse("KKPP\nKKPP\nPPKK\nPPKK")
    stored = known_repeat(basket.tile(2, 2), ACRYLIC)
    assert stored is not None
    atlas = build_atlas(ACRYLIC, [basket])
    assert atlas.provenance == ("yarn level",)
    assert atlas.column("modulus_course_n_per_mm")[0] == pytest.approx(stored.law.modulus_course)


def test_intervals_hold_their_values() -> None:
    for direction in ("course", "wale"):
        value = ATLAS.column(f"modulus_{direction}_n_per_mm")
        assert (ATLAS.column(f"modulus_{direction}_low") < value).all()
        assert (ATLAS.column(f"modulus_{direction}_high") > value).all()


def test_a_stopped_build_goes_on_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "atlas.npz"
    asked: list[int] = []

    def stop_after_five() -> bool:
        asked.append(1)
        return len(asked) > 5

    with pytest.raises(CancelledError, match="after 5"):
        build_atlas(ACRYLIC, REPEATS, file=file, cancelled=stop_after_five)
    assert len(load_atlas(file)) == 5

    computed: list[StitchChart] = []

    def counting(chart: StitchChart, _: Material) -> Prediction:
        computed.append(chart)
        return predict_repeat(chart, ACRYLIC)

    monkeypatch.setattr("knitcore.design.atlas.predict_repeat", counting)
    resumed = build_atlas(ACRYLIC, REPEATS, file=file)
    assert len(computed) == len(REPEATS) - 5
    assert resumed.keys == ATLAS.keys
    assert np.array_equal(resumed.values, ATLAS.values)
    assert load_atlas(file).provenance == ATLAS.provenance


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(place=st.floats(0, 0.999), byte=st.integers(0, 255), data=st.data())
def test_a_damaged_file_is_read_or_refused(
    tmp_path: Path, place: float, byte: int, data: st.DataObject
) -> None:
    file = tmp_path / "atlas.npz"
    save_atlas(ATLAS, file)
    content = bytearray(file.read_bytes())
    content[int(place * len(content))] = byte
    file.write_bytes(content[: data.draw(st.integers(0, len(content)))] if byte % 2 else content)
    with contextlib.suppress(InputError):
        assert len(load_atlas(file).values) == len(ATLAS)


def test_an_atlas_of_other_laws_is_not_continued(tmp_path: Path) -> None:
    file = tmp_path / "atlas.npz"
    save_atlas(ATLAS, file)
    with pytest.raises(InputError, match="atlas of acrylic with other laws"):
        build_atlas(material("cotton"), REPEATS, file=file)


@pytest.mark.parametrize("content", [b"", b"no archive", None])
def test_files_that_hold_no_atlas(tmp_path: Path, content: bytes | None) -> None:
    file = tmp_path / "atlas.npz"
    if content is None:
        np.savez(file, format=np.array(1), values=np.zeros((2, 3)))
    else:
        file.write_bytes(content)
    with pytest.raises(InputError, match="holds no atlas"):
        load_atlas(file)


@pytest.mark.parametrize(
    ("text", "transfers", "curl", "even"),
    [
        ("K", 0, 1, 1),
        ("KP", 0, 0, 0.5),
        ("K\nP", 1, 0, 0.5),
        ("KP\nPK", 1, 0, 0),
        ("KKP", 0, 1 / 3, 2 / 3),
    ],
)
def test_costs_of_knitting(text: str, transfers: float, curl: float, even: float) -> None:
    cost = knitting_cost(StitchChart.parse(text))
    assert (cost.transfers_per_stitch, cost.curl) == pytest.approx((transfers, curl))
    assert cost.even_share == pytest.approx(even if text != "KKP" else (1 / 3 + 1) / 2)


@pytest.mark.parametrize("index", range(len(REPEATS)))
def test_what_a_repeat_has_finds_that_repeat(index: int) -> None:
    targets = [
        Target(Quantity.MODULUS_COURSE, float(ATLAS.column("modulus_course_n_per_mm")[index])),
        Target(
            Quantity.EXTENSIBILITY_WALE, 1 / float(ATLAS.column("modulus_wale_n_per_mm")[index])
        ),
    ]
    found = find_fabric([ATLAS], targets)
    assert found.reached
    assert found.candidates[0].misfit == pytest.approx(0, abs=1e-3)
    assert found.candidates[0].deviations[Quantity.MODULUS_COURSE] == pytest.approx(0, abs=1e-3)


def test_candidates_are_ranked() -> None:
    found = find_fabric([ATLAS], [Target(Quantity.ANISOTROPY, 1.0)], count=5)
    misfits = [candidate.misfit for candidate in found.candidates]
    assert misfits == sorted(misfits)
    for candidate in found.candidates:
        interval = candidate.intervals[Quantity.ANISOTROPY]
        assert interval.low < candidate.values[Quantity.ANISOTROPY] < interval.high


def test_what_nothing_reaches_is_said_with_the_nearest() -> None:
    found = find_fabric([ATLAS], [Target(Quantity.MODULUS_COURSE, 5.0)])
    assert not found.reached
    stiffest = int(ATLAS.column("modulus_course_n_per_mm").argmax())
    assert found.candidates[0].repeat == ATLAS.keys[stiffest]
    assert "Nothing reaches this" in found.message
    assert "all repeats span" in found.message


def test_wishes_that_each_can_be_had_but_not_together() -> None:
    course, wale = (ATLAS.column(f"modulus_{d}_n_per_mm") for d in ("course", "wale"))
    targets = [
        Target(Quantity.MODULUS_COURSE, float(course.max()), 0.01),
        Target(Quantity.MODULUS_WALE, float(wale.max()), 0.01),
    ]
    found = find_fabric([ATLAS], targets)
    assert not found.reached
    assert "not together with the rest" in found.message


def test_within_all_tolerances_comes_before_better_on_the_average() -> None:
    values = np.ones((2, len(VALUES)))
    values[0, VALUES.index("modulus_course_n_per_mm")] = 1.12  # beyond 10 %, wale exact
    values[1, VALUES.index("modulus_course_n_per_mm")] = 1.09
    values[1, VALUES.index("modulus_wale_n_per_mm")] = 1.09
    atlas = Atlas("made", "", ("K", "KP"), values, ("measured", "measured"))
    targets = [Target(Quantity.MODULUS_COURSE, 1.0), Target(Quantity.MODULUS_WALE, 1.0)]
    found = find_fabric([atlas], targets)
    assert [candidate.repeat for candidate in found.candidates] == ["KP", "K"]
    assert found.candidates[0].misfit > found.candidates[1].misfit


def test_other_yarns_are_searched_too() -> None:
    lace = build_atlas(material("lace-bamboo"), repeats_up_to(1, 2))
    target = Target(Quantity.MODULUS_WALE, float(lace.column("modulus_wale_n_per_mm")[0]), 0.001)
    assert find_fabric([ATLAS, lace], [target]).candidates[0].material == "lace-bamboo"


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: find_fabric([], [Target(Quantity.ANISOTROPY, 1.0)]), "atlas"),
        (lambda: find_fabric([ATLAS], []), "targets"),
        (lambda: find_fabric([ATLAS], [Target(Quantity.ANISOTROPY, 1.0)] * 2), "targets"),
        (lambda: Target(Quantity.ANISOTROPY, -1.0), "targets.anisotropy"),
        (lambda: Target(Quantity.ANISOTROPY, 1.0, weight=float("inf")), "targets.anisotropy"),
    ],
)
def test_wishes_that_cannot_be_used(make: object, field: str) -> None:
    assert callable(make)
    with pytest.raises(InputError) as caught:
        make()
    assert caught.value.field == field
