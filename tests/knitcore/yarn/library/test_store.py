"""The packaged relaxed repeats."""

import json
from importlib.resources import files

import numpy as np
import pytest

from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.library.store import stored_charts, stored_failure, stored_stitch
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.solve.clasps import is_knitted
from knitcore.yarn.study.relax import relax
from scripts import stored_stitches
from scripts.stored_stitches import COMMON, charts_of_the_store

FREE = set(COMMON) - {"basket 2x2", "3x3 welt"}


@pytest.mark.parametrize("material", ["acrylic", "cotton"])
@pytest.mark.parametrize("name", COMMON)
def test_common_repeats_are_packaged(material, name):
    stored = stored_stitch(StitchChart.parse(COMMON[name]), material)
    assert stored is not None
    if name in FREE:
        assert stored.free is not None
        assert stored.free.energy_n_mm <= stored.energy_n_mm * (1 + 1e-3)  # fewer symmetries
    lines = stored.centre_lines()
    assert lines.shape[0] == stored.chart.rows
    step = np.linalg.norm(np.diff(lines, axis=1), axis=2).sum(axis=1)
    stitches = stored.chart.columns
    assert step.mean() / stitches == pytest.approx(stored.loop_length_mm, rel=0.04)


@pytest.mark.parametrize("text", ["KKP", "PPK", "PKK", "KPP"])
def test_turned_and_moved_charts_are_found_with_their_own_shape(text):
    """The stored curve, carried over by symmetry, has the crossings of a fresh relaxation."""
    chart = StitchChart.parse(text)
    stored = stored_stitch(chart, "cotton")
    assert stored is not None
    fresh = relax(chart, stored.yarn, stored.loop_length_mm, branch="mirrored")
    assert fresh.convention is Convention.PUBLISHED
    assert stored.cell_course_mm == pytest.approx(fresh.cell_course_mm, rel=0.01)
    a, b = stored.centre_lines(3)[0], fresh.centre_lines[0]
    b = b[np.linspace(0, len(b) - 1, len(a)).round().astype(int)]
    a, b = a - a.mean(axis=0), b - b.mean(axis=0)
    assert np.sqrt(((a - b) ** 2).sum(axis=1).mean()) < 0.35


def test_two_by_two_rib_is_narrower_than_one_by_one():
    one, two = (stored_stitch(StitchChart.parse(t), "cotton") for t in ("KP", "KKPP"))
    assert one is not None
    assert two is not None
    assert two.cell_course_mm < one.cell_course_mm
    assert two.free.cell_course_mm < one.free.cell_course_mm


def test_unknown_repeats_and_yarns_are_not_in_the_store():
    large = StitchChart(np.random.default_rng(0).random((5, 5)) < 0.5)
    assert stored_stitch(large, "acrylic") is None
    assert stored_stitch(StitchChart.parse("K"), "lace-bamboo") is None


@pytest.mark.parametrize("name", ["acrylic", "cotton"])
def test_all_small_repeats_are_packaged(name):
    """Up to eight stitches and 3x3, with a law, or else with the reason."""
    wanted = charts_of_the_store()
    assert len(wanted) == 116 + 19 + 1
    stored = [stored_stitch(chart, name) for chart in wanted]
    missing = [chart for chart, found in zip(wanted, stored, strict=True) if found is None]
    assert all(stored_failure(chart, name) for chart in missing)
    found = [entry for entry in stored if entry is not None]
    assert len(found) == len(stored_charts(name)) >= 130
    assert all(bool(entry.law_failure) == (entry.law is None) for entry in found)
    assert sum(entry.law is not None and entry.converged for entry in found) >= 120
    assert stored_failure(StitchChart.parse("K"), name) is None


def test_the_packaged_files_are_small():
    folder = files("knitcore.yarn.library") / "data"
    sizes = [len((folder / file).read_bytes()) for file in ("stitches.json", "stitches.npz")]
    assert sum(sizes) < 3_000_000


def test_a_welt_upside_down_is_the_same_cloth():
    one = stored_stitch(StitchChart.parse("P\nK\nP\nP\nK\nK\nK"), "cotton")
    other = stored_stitch(StitchChart.parse("K\nK\nK\nP\nP\nK\nP"), "cotton")
    assert one is not None
    assert other is not None
    assert one.energy_n_mm == pytest.approx(other.energy_n_mm, rel=1e-3)
    assert one.cell_wale_mm == pytest.approx(other.cell_wale_mm, rel=5e-3)


def test_a_build_is_reproducible_and_resumes(tmp_path, monkeypatch):
    """With a stand-in for the solver, which gives no shape to garter."""
    calls = []

    def solve(task):
        calls.append(task.chart)
        if task.chart == "P/K":
            return {"failure": "no room"}
        size = {"cell_course_mm": 2.0 + len(task.chart), "cell_wale_mm": 2.0, "energy_n_mm": 0.1}
        shares = {"bending_share": 0.9, "contact_share": 0.1, "converged": True}
        empty = {"course": {"stress_n_per_mm": [0.0, 0.4], "jumps": [1]}}
        law = {"law": None, "law_failure": "too soft", "curves": empty}
        columns = task.chart.index("/") if "/" in task.chart else len(task.chart)
        rows = task.chart.count("/") + 1
        points = np.zeros((rows, columns * 16, 3)).tolist()
        return {**size, **shares, **law, "controls": points}

    monkeypatch.setattr(stored_stitches, "characterise_repeat", solve)
    made = []
    for folder in (tmp_path / "a", tmp_path / "b"):
        folder.mkdir()
        stored_stitches.build(folder, keep=tmp_path / "keep", most_stitches=1, workers=1)
        made.append({file.name: file.read_bytes() for file in folder.iterdir()})
    assert made[0] == made[1]
    assert len(calls) == 2 * 2 * len(COMMON)  # yarns, branches; nothing was done twice
    entries = json.loads(made[0]["stitches.json"])["stitches"]
    assert entries["acrylic/P/K"]["failure"] == "no room"
    assert entries["cotton/KKP"]["law_failure"] == "too soft"
    assert entries["cotton/KKP"]["law_jumps"] == [0, 0]


@pytest.mark.parametrize("name", ["acrylic", "cotton"])
def test_every_stored_shape_is_knotted_like_its_chart(name):
    for chart in stored_charts(name):
        stored = stored_stitch(chart, name)
        assert stored is not None
        lines = stored.centre_lines()
        assert is_knitted(stored.chart, lines, stored.cell_course_mm, stored.cell_wale_mm)


@pytest.mark.parametrize("name", ["acrylic", "cotton"])
def test_every_stored_repeat_says_whether_it_stays_without_its_mirrors(name):
    stored = [stored_stitch(chart, name) for chart in stored_charts(name)]
    for entry in stored:
        assert entry.unmirrored is not None
        assert entry.unmirrored.converged
        assert entry.unmirrored.energy_n_mm < entry.energy_n_mm * (1.0 + 1e-3)
        if entry.unmirrored.minimum:
            assert entry.lowest_energy_n_mm > 0.999 * entry.energy_n_mm or entry.free is not None
    assert 10 < sum(entry.unmirrored.minimum for entry in stored) < len(stored)
