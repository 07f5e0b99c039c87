import contextlib
from collections.abc import Callable
from pathlib import Path
from statistics import NormalDist
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore import Fabric, InputError, StitchChart, predict
from knitcore.base.batch import run_batch
from knitcore.base.errors import CancelledError
from knitcore.chart.fabric import Direction
from knitcore.chart.repeats import repeats_up_to
from knitcore.design.atlas import CURVES, FORMAT, VALUES, Atlas, load_atlas, save_atlas
from knitcore.design.atlas_build import AT_ONCE, build_atlas, parts_folder
from knitcore.design.cost import CostLimits, knitting_cost
from knitcore.design.find import Quantity, Target, WornTube, find_fabric
from knitcore.law.uniaxial import strain_at_stress
from knitcore.materials import material
from knitcore.mechanics.pressure import limb_pressure
from tests.knitcore.design.atlases import REPEATS, acrylic_atlas

ACRYLIC = material("acrylic")


@pytest.mark.parametrize("fabric", list(Fabric))
def test_pure_fabrics_have_their_measured_laws(fabric: Fabric) -> None:
    index = acrylic_atlas().index_of(StitchChart.of_fabric(fabric, rows=2, columns=2))
    assert index is not None
    law = ACRYLIC.law(fabric)
    assert acrylic_atlas().column("modulus_course_n_per_mm")[index] == pytest.approx(
        law.modulus_course
    )
    assert acrylic_atlas().column("modulus_wale_n_per_mm")[index] == pytest.approx(law.modulus_wale)
    assert acrylic_atlas().provenance[index] == "measured"


def test_a_mixed_repeat_has_its_prediction() -> None:
    basket = StitchChart.parse("KKPP\nKKPP\nPPKK\nPPKK")
    atlas = build_atlas(ACRYLIC, [basket])
    assert atlas.provenance == ("learned",)
    found = predict(basket, ACRYLIC)
    assert atlas.column("modulus_course_n_per_mm")[0] == found.modulus_course_n_per_mm


def test_intervals_hold_their_values() -> None:
    for direction in ("course", "wale"):
        value = acrylic_atlas().column(f"modulus_{direction}_n_per_mm")
        assert (acrylic_atlas().column(f"modulus_{direction}_low") < value).all()
        assert (acrylic_atlas().column(f"modulus_{direction}_high") > value).all()


def test_a_stopped_build_resumes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stopped after the first part; the finished part is not computed again."""
    file, repeats = tmp_path / "atlas.npz", repeats_up_to(3, 3)
    told: list[tuple[int, int]] = []
    with pytest.raises(CancelledError):
        build_atlas(
            ACRYLIC,
            repeats,
            file=file,
            progress=lambda done, of: told.append((done, of)),
            cancelled=lambda: len(told) > 1,
        )
    assert told == [(0, len(repeats)), (AT_ONCE, len(repeats))]
    assert len(list(parts_folder(file).glob("*.json"))) == 1
    assert not file.exists()

    computed: list[int] = []

    def counting(function: Callable[..., dict[str, object]], tasks: Any, **options: Any) -> object:
        def count(task: Any) -> dict[str, object]:
            computed.append(len(task.keys))
            return function(task)

        return run_batch(count, tasks, **options)

    monkeypatch.setattr("knitcore.design.atlas_build.run_batch", counting)
    resumed = build_atlas(ACRYLIC, repeats, file=file)
    assert sum(computed) == len(repeats) - AT_ONCE
    assert resumed.only(acrylic_atlas().keys).values == pytest.approx(
        acrylic_atlas().values, nan_ok=True
    )
    assert not parts_folder(file).exists()

    again = build_atlas(ACRYLIC, repeats, file=file)
    assert sum(computed) == len(repeats) - AT_ONCE
    assert again.keys == resumed.keys
    assert again.values == pytest.approx(resumed.values, rel=1e-6, nan_ok=True)
    assert again.provenance == resumed.provenance


def test_two_processes_make_the_same_atlas(tmp_path: Path) -> None:
    atlas = build_atlas(ACRYLIC, REPEATS, file=tmp_path / "a.npz", workers=2)
    assert atlas.keys == acrylic_atlas().keys
    assert np.array_equal(atlas.curves, acrylic_atlas().curves)


@pytest.mark.parametrize("fabric", list(Fabric))
def test_curves_of_pure_fabrics_are_those_of_their_laws(fabric: Fabric) -> None:
    index = acrylic_atlas().index_of(StitchChart.of_fabric(fabric, rows=2, columns=2))
    for direction in Direction:
        for load in (0.013, 0.1, 0.31):
            exact = strain_at_stress(ACRYLIC.law(fabric), direction, load)
            assert acrylic_atlas().strain_at(direction, load)[index] == pytest.approx(
                exact, rel=0.005
            )
            back = acrylic_atlas().stress_at(direction, exact)[index]
            assert back == pytest.approx(load, rel=0.01)


@pytest.mark.parametrize("worn_mm", [206.0, 240.0, 260.0])
@pytest.mark.parametrize("direction", list(Direction))
@pytest.mark.parametrize("fabric", list(Fabric))
def test_a_wanted_pressure_is_that_of_the_pressure_model(
    fabric: Fabric, direction: Direction, worn_mm: float
) -> None:
    expected = limb_pressure(ACRYLIC.law(fabric), direction, 200.0, worn_mm).mmhg
    quantity = Quantity.PRESSURE_COURSE if direction is Direction.COURSE else Quantity.PRESSURE_WALE
    middle = float(np.sqrt(expected.low * expected.high))
    target = Target(quantity, middle, 0.05, limb=WornTube(200.0, worn_mm))
    found = find_fabric([acrylic_atlas()], [target], count=len(acrylic_atlas()))
    key = acrylic_atlas().keys[
        acrylic_atlas().index_of(StitchChart.of_fabric(fabric, rows=2, columns=2)) or 0
    ]
    own = next(c for c in found.candidates if c.repeat == key)
    assert own.values[target.label] == pytest.approx(middle, rel=0.01)
    assert own.reached
    assert own.intervals[target.label].low <= expected.low * 1.01
    assert own.intervals[target.label].high >= expected.high * 0.99


def test_stretch_at_a_load_and_poisson_s_ratio_together() -> None:
    law = ACRYLIC.law(Fabric.GARTER)
    targets = [
        Target(
            Quantity.STRETCH_WALE,
            strain_at_stress(law, Direction.WALE, 0.05),
            0.02,
            load_n_per_mm=0.05,
        ),
        Target(Quantity.POISSON_WALE, law.poisson_xy, 0.02),
    ]
    best = find_fabric([acrylic_atlas()], targets).candidates[0]
    assert best.repeat == "P/K"
    assert best.reached
    assert "stretch_wale@0.05" in best.intervals


def test_one_quantity_at_two_loads_is_two_targets() -> None:
    targets = [
        Target(Quantity.STRETCH_COURSE, value, load_n_per_mm=load)
        for value, load in ((0.1, 0.01), (0.5, 0.1))
    ]
    assert len(find_fabric([acrylic_atlas()], targets).candidates[0].values) == 2


def test_a_limb_beyond_the_lock_up_gives_nan() -> None:
    target = Target(Quantity.PRESSURE_WALE, 20.0, limb=WornTube(100.0, 900.0))
    found = find_fabric([acrylic_atlas()], [target])
    assert not found.reached
    assert "no repeat stretches that far" in found.message


def test_limits_of_knitting_cost() -> None:
    target = Target(Quantity.MODULUS_COURSE, 0.2)
    free = find_fabric([acrylic_atlas()], [target], count=len(acrylic_atlas()))
    easy = find_fabric(
        [acrylic_atlas()],
        [target],
        count=len(acrylic_atlas()),
        limits=CostLimits(transfers_per_stitch=0.0, curl=0.5),
    )
    assert 0 < len(easy.candidates) < len(free.candidates)
    assert all(c.cost.transfers_per_stitch == 0 for c in easy.candidates)
    assert all(abs(c.cost.curl) <= 0.5 for c in easy.candidates)
    with pytest.raises(InputError, match="no repeat is within") as caught:
        find_fabric([acrylic_atlas()], [target], limits=CostLimits(0.0, 0.0, 0.0))
    assert "Relax one" in caught.value.remedy


@given(place=st.floats(0, 0.999), byte=st.integers(0, 255), data=st.data())
def test_a_damaged_file_is_read_or_refused(
    tmp_path: Path, place: float, byte: int, data: st.DataObject
) -> None:
    file = tmp_path / "atlas.npz"
    save_atlas(acrylic_atlas(), file)
    content = bytearray(file.read_bytes())
    content[int(place * len(content))] = byte
    file.write_bytes(content[: data.draw(st.integers(0, len(content)))] if byte % 2 else content)
    with contextlib.suppress(InputError):
        assert len(load_atlas(file).values) == len(acrylic_atlas())


def test_an_atlas_of_other_laws_is_not_continued(tmp_path: Path) -> None:
    file = tmp_path / "atlas.npz"
    save_atlas(acrylic_atlas(), file)
    with pytest.raises(InputError, match="atlas of acrylic with other laws"):
        build_atlas(material("cotton"), REPEATS, file=file)


def test_an_atlas_of_an_older_version_is_built_again(tmp_path: Path) -> None:
    file = tmp_path / "atlas.npz"
    np.savez(file, format=np.array(FORMAT - 1), values=np.zeros((2, 3)))
    with pytest.raises(InputError, match="another version"):
        load_atlas(file)


@pytest.mark.parametrize("content", [b"", b"no archive", None])
def test_files_that_hold_no_atlas(tmp_path: Path, content: bytes | None) -> None:
    file = tmp_path / "atlas.npz"
    if content is None:
        np.savez(file, format=np.array(FORMAT), values=np.zeros((2, 3)))
    else:
        file.write_bytes(content)
    with pytest.raises(InputError, match="is not an atlas"):
        load_atlas(file)


@pytest.mark.parametrize(
    ("text", "transfers", "curl"),
    [("K", 0, 1), ("KP", 0, 0), ("K\nP", 1, 0), ("KP\nPK", 1, 0), ("KKP", 0, 1 / 3)],
)
def test_costs_of_knitting(text: str, transfers: float, curl: float) -> None:
    cost = knitting_cost(StitchChart.parse(text))
    assert (cost.transfers_per_stitch, cost.curl) == pytest.approx((transfers, curl))


@pytest.mark.parametrize("index", range(len(REPEATS)))
def test_the_values_of_a_repeat_find_that_repeat(index: int) -> None:
    targets = [
        Target(
            Quantity.MODULUS_COURSE, float(acrylic_atlas().column("modulus_course_n_per_mm")[index])
        ),
        Target(
            Quantity.EXTENSIBILITY_WALE,
            1 / float(acrylic_atlas().column("modulus_wale_n_per_mm")[index]),
        ),
    ]
    found = find_fabric([acrylic_atlas()], targets, count=len(acrylic_atlas()))
    assert found.reached
    own = next(c for c in found.candidates if c.repeat == acrylic_atlas().keys[index])
    assert own.reached
    assert own.misfit == pytest.approx(0, abs=1e-3)
    assert own.deviations[Quantity.MODULUS_COURSE] == pytest.approx(0, abs=1e-3)


def test_candidates_are_ranked() -> None:
    found = find_fabric([acrylic_atlas()], [Target(Quantity.ANISOTROPY, 1.0)], count=5)
    ranks = [(-round(candidate.chance, 2), candidate.misfit) for candidate in found.candidates]
    assert ranks == sorted(ranks)
    for candidate in found.candidates:
        interval = candidate.intervals[Quantity.ANISOTROPY]
        assert interval.low < candidate.values[Quantity.ANISOTROPY] < interval.high


def test_the_surer_of_two_equal_predictions_comes_first() -> None:
    """Of a value on the target: 2Φ(z) − 1, where the tolerance is z standard deviations."""
    target = Target(Quantity.MODULUS_COURSE, 0.1, tolerance=0.2)
    factors = np.array([1.1, 1.5, 1.001])
    chance = target.chance(np.full(3, 0.1), 0.1 / factors, 0.1 * factors)
    deviations = np.log(1.2) / (np.log(factors) / NormalDist().inv_cdf(0.95))
    np.testing.assert_allclose(chance, [2 * NormalDist().cdf(z) - 1 for z in deviations])
    missed = target.chance(np.array([0.13]), np.array([0.125]), np.array([0.135]))
    assert missed < 0.02
    assert target.chance(*np.full((3, 1), np.nan)) == 0


def test_unreachable_targets_are_reported_with_the_nearest_repeat() -> None:
    found = find_fabric([acrylic_atlas()], [Target(Quantity.MODULUS_COURSE, 5.0)])
    assert not found.reached
    stiffest = int(acrylic_atlas().column("modulus_course_n_per_mm").argmax())
    assert found.candidates[0].repeat == acrylic_atlas().keys[stiffest]
    assert "No repeat meets this" in found.message
    assert "all repeats span" in found.message


def test_targets_that_can_be_met_singly_but_not_together() -> None:
    course, wale = (acrylic_atlas().column(f"modulus_{d}_n_per_mm") for d in ("course", "wale"))
    targets = [
        Target(Quantity.MODULUS_COURSE, float(course.max()), 0.01),
        Target(Quantity.MODULUS_WALE, float(wale.min()), 0.01),
    ]
    found = find_fabric([acrylic_atlas()], targets)
    assert not found.reached
    assert "but not the other targets" in found.message


def test_within_all_tolerances_comes_before_better_on_the_average() -> None:
    values, curves = np.ones((2, len(VALUES))), np.zeros((2, *CURVES))
    values[0, VALUES.index("modulus_course_n_per_mm")] = 1.12  # beyond 10 %, wale exact
    values[1, VALUES.index("modulus_course_n_per_mm")] = 1.09
    values[1, VALUES.index("modulus_wale_n_per_mm")] = 1.09
    sources = "measured", "measured"
    atlas = Atlas("made", "", ("K", "KP"), values, curves, sources)
    targets = [Target(Quantity.MODULUS_COURSE, 1.0), Target(Quantity.MODULUS_WALE, 1.0)]
    found = find_fabric([atlas], targets)
    assert [candidate.repeat for candidate in found.candidates] == ["KP", "K"]
    assert found.candidates[0].misfit > found.candidates[1].misfit


def test_other_yarns_are_searched_too() -> None:
    lace = build_atlas(material("lace-bamboo"), repeats_up_to(1, 2))
    target = Target(Quantity.MODULUS_WALE, float(lace.column("modulus_wale_n_per_mm")[0]), 0.001)
    assert find_fabric([acrylic_atlas(), lace], [target]).candidates[0].material == "lace-bamboo"


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: find_fabric([], [Target(Quantity.ANISOTROPY, 1.0)]), "atlas"),
        (lambda: find_fabric([acrylic_atlas()], []), "targets"),
        (lambda: find_fabric([acrylic_atlas()], [Target(Quantity.ANISOTROPY, 1.0)] * 2), "targets"),
        (lambda: Target(Quantity.ANISOTROPY, -1.0), "targets.anisotropy"),
        (lambda: Target(Quantity.ANISOTROPY, 1.0, weight=float("inf")), "targets.anisotropy"),
        (lambda: Target(Quantity.PRESSURE_WALE, 20.0), "targets.pressure_wale_mmhg"),
        (lambda: Target(Quantity.STRETCH_WALE, 0.1, load_n_per_mm=9), "targets.stretch_wale"),
        (lambda: WornTube(200.0, 200.0), "limb"),
    ],
)
def test_unusable_targets_are_refused(make: object, field: str) -> None:
    assert callable(make)
    with pytest.raises(InputError) as caught:
        make()
    assert caught.value.field == field
