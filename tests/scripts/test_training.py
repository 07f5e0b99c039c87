"""The training library: its charts, its tasks, and what is packaged of it."""

import json
from pathlib import Path

import numpy as np
import pytest

from knitcore import StitchChart
from knitcore.chart.fabric import Direction
from scripts.training.build import characterise, pack, tasks
from scripts.training.charts import YARN_POINTS, training_charts
from scripts.training.entries import RawCurve, read_library, training_entries


def test_charts_are_distinct_repeats_and_any_beginning_holds_all_kinds() -> None:
    charts = training_charts()
    assert len(charts) > 240
    assert all(chart == chart.canonical() for chart in charts)
    kinds = list(charts.values())
    assert set(kinds[:16]) == set(kinds)


def test_yarn_points_have_the_numbers_that_they_are_named_for() -> None:
    thick = next(point for point in YARN_POINTS if point.name == "thick")
    yarn, loop = thick.yarn, thick.loop_length_mm
    assert yarn.radius_mm / loop == pytest.approx(0.066)
    contact = yarn.contact_stiffness_n_per_mm3 * yarn.radius_mm**4 * loop
    assert contact / yarn.bending_modulus_n_mm2 == pytest.approx(0.25)
    assert yarn.bending_modulus_n_mm2 / loop**3 == pytest.approx(1.5e-5)


@pytest.mark.slow
def test_tasks_name_yarn_and_chart() -> None:
    named = tasks()
    assert all(key.count(".") == 2 for key in named)
    assert {task.yarn_name for task in named.values()} >= {"acrylic", "cotton", "middle", "thick"}


def test_packing_adds_entries_and_later_builds_skip_them(tmp_path: Path) -> None:
    keep, packed = tmp_path / "keep", tmp_path / "packed"
    keep.mkdir()
    task = next(t for t in tasks().values() if not t.stretched and len(t.repeat.chart) < 12)
    kept = keep / f"{task.key}.json"
    kept.write_text(json.dumps(characterise(task)), encoding="utf-8")
    assert pack(keep, packed) == 1
    assert task.key not in tasks(packed)
    assert len(tasks(packed)) == len(tasks()) - 1

    again = json.loads(kept.read_text(encoding="utf-8"))
    again["cell_course_mm"] = 9.0
    kept.write_text(json.dumps(again), encoding="utf-8")
    assert pack(keep, packed) == 1  # in the place of the earlier one
    assert read_library(packed)[0]["cell_course_mm"] == 9.0


def test_every_packaged_entry_has_a_size_or_a_reason() -> None:
    entries = training_entries()
    assert len(entries) > 100
    for entry in entries:
        assert (entry.cell_mm is None) == bool(entry.failure)
    swept = [entry for entry in entries if entry.curves]
    stockinette = next(e for e in swept if e.chart == StitchChart.parse("K"))
    strain = stockinette.curves[Direction.COURSE].strain_at(np.array([0.01, 0.05, 0.2]))
    assert np.all(np.diff(strain) > 0)


def test_a_strain_is_read_where_the_stress_is_first_reached() -> None:
    curve = RawCurve(
        strain=np.array([0.0, 0.1, 0.2, 0.3]),
        transverse_strain=np.array([0.0, -0.03, -0.06, -0.09]),
        stress_n_per_mm=np.array([0.0, 0.04, 0.02, 0.08]),  # it jumps
    )
    assert curve.strain_at(np.array([0.02, 0.06, 0.2])) == pytest.approx(
        [0.05, 0.2 + 0.1 * 4 / 6, np.nan], nan_ok=True
    )
    assert curve.poisson() == pytest.approx(0.3)
