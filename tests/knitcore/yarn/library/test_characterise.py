"""One repeat, and whole yarns, characterised as batches."""

import json
from dataclasses import replace

import pytest

from knitcore import Direction, Fabric, InputError, StitchChart, material, predict
from knitcore.materials import load_library
from knitcore.materials.material_files import load_material_file, save_material_file
from knitcore.prediction.prediction import Source
from knitcore.yarn.library.characterise import RepeatTask, characterise_repeat
from knitcore.yarn.library.yarn_material import material_of
from knitcore.yarn.library.yarn_table import (
    YarnTable,
    characterise_yarns,
    plan_for_material,
    plan_for_yarn,
)
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.study.relax import Branch

COTTON = sample("cotton", "stockinette")


@pytest.fixture(scope="module")
def table() -> YarnTable:
    """Stockinette and garter of cotton, one of the three lengths too short for the yarn."""
    plan = plan_for_material(
        material("cotton"),
        fabrics=[Fabric.STOCKINETTE, Fabric.GARTER],
        loop_lengths_mm=[14.0, 5.0, 15.0],
    )
    (made,) = characterise_yarns([plan], workers=1)
    return made


@pytest.mark.slow
def test_the_json_of_a_repeat_is_reproducible() -> None:
    task = RepeatTask("K", COTTON.yarn, COTTON.loop_length_mm)
    once, again = characterise_repeat(task), characterise_repeat(task)
    assert json.dumps(once) == json.dumps(again)
    assert once["energy_n_mm"] == pytest.approx(0.3868, rel=2e-3)  # docs/yarn-level.md
    course = once["curves"]["course"]
    assert course["strain"][0] == 0.0
    assert max(course["stress_n_per_mm"]) > task.max_stress_n_per_mm
    below = [s for s in course["stress_n_per_mm"] if s <= task.max_stress_n_per_mm]
    assert len(below) >= 12  # enough of the curve to fit
    assert once["law_range"]["max_stress_n_per_mm"] == task.max_stress_n_per_mm


def test_every_input_counts_for_the_key() -> None:
    task = RepeatTask("K", COTTON.yarn, COTTON.loop_length_mm)
    others = [
        replace(task, chart="KP"),
        replace(task, loop_length_mm=12.0),
        replace(task, yarn=replace(COTTON.yarn, core_radius_mm=0.3)),
        replace(task, branch=Branch.FREE),
        replace(task, max_stress_n_per_mm=0.2),
    ]
    assert len({task.key, *(other.key for other in others)}) == 6
    assert replace(task).key == task.key


def test_less_yarn_makes_a_smaller_and_stiffer_stitch(table: YarnTable) -> None:
    """Manufacturing tension as loop length (paper, Supplementary Fig. 9)."""
    for fabric in (Fabric.STOCKINETTE, Fabric.GARTER):
        short, tight, loose = table.of(fabric)
        assert [row.loop_length_mm for row in (short, tight, loose)] == [5.0, 14.0, 15.0]
        assert "too short" in short.failure
        assert short.law is None
        assert tight.stitches_per_cm2 > loose.stitches_per_cm2  # type: ignore[operator]
        assert tight.law.modulus_course > loose.law.modulus_course
        assert tight.law.modulus_wale > loose.law.modulus_wale


def test_rows_are_flat_and_alike(table: YarnTable) -> None:
    rows = [row.flat() for row in table.rows]
    assert len({tuple(row) for row in rows}) == 1
    assert {row["remark"] == "" for row in rows} == {True, False}


def test_the_yarn_is_a_material_that_predicts(table: YarnTable, tmp_path) -> None:
    made = material_of(table)
    assert made.record(Fabric.GARTER).loop_length_mm == 14.0  # nearest to its own, 14.2 on average
    file = tmp_path / "cotton.json"
    save_material_file(made, file)
    read = load_material_file(file)
    prediction = predict(StitchChart.of_fabric("garter", 4, 4), read)
    assert prediction.provenance is Source.SWEPT
    law = table.of(Fabric.GARTER)[1].law
    assert prediction.modulus_n_per_mm(Direction.WALE) == pytest.approx(law.modulus_wale, rel=1e-6)


def test_a_setting_without_a_law_makes_no_material(table: YarnTable) -> None:
    with pytest.raises(InputError, match="too short"):
        material_of(table, "5mm")
    with pytest.raises(InputError, match="14mm, 15mm"):
        material_of(table, "16mm")


def test_impossible_plans_are_refused() -> None:
    with pytest.raises(InputError, match="no length is given"):
        plan_for_yarn("mine", COTTON.yarn, [])
    with pytest.raises(InputError, match="above 0"):
        plan_for_yarn("mine", COTTON.yarn, [12.0, -1.0])
    with pytest.raises(InputError, match="at least one"):
        plan_for_yarn("mine", COTTON.yarn, [12.0], fabrics=[])


USUAL = "acrylic", "glove-wool"


@pytest.mark.parametrize(
    "name",
    [
        name if name in USUAL else pytest.param(name, marks=pytest.mark.slow)
        for name in sorted(load_library())
    ],
)
@pytest.mark.slow
def test_every_yarn_of_the_library_can_be_characterised(name: str) -> None:
    """Other yarns than acrylic and cotton have labelled estimates of radius, core, k and p."""
    plan = plan_for_material(material(name), fabrics=[Fabric.RIB], tensions=[1.0])
    assert plan.estimated == (name not in ("acrylic", "cotton"))
    assert ("estimated" in plan.provenance) == plan.estimated
    (table,) = characterise_yarns([plan], workers=1)
    (row,) = table.rows
    assert row.law is not None, row.flat()["remark"]
    record = material(name).record(Fabric.RIB)
    assert row.document["cell_course_mm"] == pytest.approx(record.stitch_course_mm, rel=0.2)
    assert row.document["cell_wale_mm"] == pytest.approx(record.stitch_wale_mm, rel=0.2)
