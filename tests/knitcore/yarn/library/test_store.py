"""The packaged relaxed repeats."""

import json
from dataclasses import astuple, replace
from importlib.resources import files

import numpy as np
import pytest

from knitcore import StitchChart, material
from knitcore.yarn.library.store import (
    MATERIALS,
    StoredStitch,
    document_of,
    of_document,
    stored_charts,
    stored_for,
    stored_stitch,
)
from knitcore.yarn.library.yarns import yarn_for
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.solve.clasps import is_knitted
from knitcore.yarn.study.bending import FabricBending, bending_response
from knitcore.yarn.study.relax import relax
from scripts import stored_stitches
from scripts.stored_stitches import COMMON, charts_of_the_store

FREE = set(COMMON) - {"basket 2x2", "3x3 welt"}


@pytest.mark.parametrize("material", ["acrylic", "cotton"])
@pytest.mark.parametrize("name", COMMON)
def test_common_repeats_are_packaged(material, name):
    stored = stored_stitch(StitchChart.parse(COMMON[name]), material)
    if name in FREE:
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
    fresh = relax(chart, stored.yarn, stored.loop_length_mm, branch="mirrored")
    assert fresh.convention is Convention.PUBLISHED
    assert stored.cell_course_mm == pytest.approx(fresh.cell_course_mm, rel=0.01)
    a, b = stored.centre_lines(3)[0], fresh.centre_lines[0]
    b = b[np.linspace(0, len(b) - 1, len(a)).round().astype(int)]
    a, b = a - a.mean(axis=0), b - b.mean(axis=0)
    assert np.sqrt(((a - b) ** 2).sum(axis=1).mean()) < 0.35


def test_unknown_repeats_and_yarns_are_not_in_the_store():
    large = StitchChart(np.random.default_rng(0).random((5, 5)) < 0.5)
    assert stored_stitch(large, "acrylic") is None
    assert stored_stitch(StitchChart.parse("K"), "lace-bamboo") is None


@pytest.mark.parametrize("name", ["acrylic", "cotton"])
def test_all_small_repeats_are_packaged(name):
    """Up to eight stitches and 3x3; six of a yarn's 136 may have no shape."""
    charts = charts_of_the_store()
    assert len(charts) == 116 + 19 + 1
    entries = [stored_stitch(chart, name) for chart in charts]
    stored = [entry for entry in entries if entry is not None]
    assert len(stored) == len(stored_charts(name)) >= 130
    assert all(bool(entry.law_failure) == (entry.law is None) for entry in stored)
    assert sum(entry.law is not None and entry.converged for entry in stored) >= 120


def test_the_packaged_files_are_small():
    folder = files("knitcore.yarn.library") / "data"
    sizes = [len((folder / file).read_bytes()) for file in ("stitches.json", "stitches.npz")]
    assert sum(sizes) < 3_000_000


def test_a_welt_upside_down_is_the_same_cloth():
    welt, turned = (_stored(text, "cotton") for text in ("P/K/P/P/K/K/K", "K/K/K/P/P/K/P"))
    assert welt.energy_n_mm == pytest.approx(turned.energy_n_mm, rel=1e-3)
    assert welt.cell_wale_mm == pytest.approx(turned.cell_wale_mm, rel=5e-3)


def test_a_build_is_reproducible_and_resumes(tmp_path, monkeypatch):
    """A stand-in for the solver gives no shape to garter."""
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
@pytest.mark.slow
def test_every_stored_shape_is_knotted_like_its_chart(name):
    for chart in stored_charts(name):
        stored = stored_stitch(chart, name)
        lines = stored.centre_lines()
        assert is_knitted(stored.chart, lines, stored.cell_course_mm, stored.cell_wale_mm)


@pytest.mark.parametrize("name", ["acrylic", "cotton"])
def test_every_stored_repeat_says_whether_it_stays_without_its_mirrors(name):
    stored = [stored_stitch(chart, name) for chart in stored_charts(name)]
    for entry in stored:
        assert entry.unmirrored.converged
        assert entry.unmirrored.energy_n_mm < entry.energy_n_mm * (1.0 + 1e-3)
        if entry.unmirrored.minimum:
            near = entry.unmirrored.energy_n_mm > 0.999 * entry.energy_n_mm
            assert near or entry.free is not None
    assert 10 < sum(entry.unmirrored.minimum for entry in stored) < len(stored)


def _stored(text: str, material_id: str) -> StoredStitch:
    return stored_stitch(StitchChart.parse(text), material_id)


def _mirrored(text: str, material_id: str) -> FabricBending:
    return _stored(text, material_id).bending.mirrored


PURE = ["K", "P", "P/K", "PK"]
MIXED = ["KKP", "PPK", "KPP", "KKKP", "PPKP", "K/P/P", "PPK/PKP/KPP"]


@pytest.mark.parametrize("text", PURE + MIXED)
@pytest.mark.slow
def test_it_is_that_of_the_chart_relaxed_as_it_was_asked_for(text: str) -> None:
    """Shifts, mirror images and the other side of the fabric have their own signs.

    The twill is soft, and so known to 1e-3; the others agree within 1e-4.
    """
    stored, bending = _stored(text, "acrylic"), _mirrored(text, "acrylic")
    fresh = bending_response(
        relax(stored.chart, stored.yarn, stored.loop_length_mm, branch="mirrored")
    )
    for kept, computed in ((bending.course, fresh.course), (bending.wale, fresh.wale)):
        assert astuple(kept)[:3] == pytest.approx(astuple(computed)[:3], rel=2e-3, abs=1e-6)
        assert kept.strain_across_mm == pytest.approx(computed.strain_across_mm, abs=1e-3)
    assert bending.thickness_mm == pytest.approx(fresh.thickness_mm, rel=1e-4)
    if bending.minimum:
        for kept, computed in zip(bending.oblique, fresh.oblique, strict=True):
            assert astuple(kept)[:2] == pytest.approx(astuple(computed)[:2], rel=2e-3, abs=1e-6)
        shear = fresh.shear_modulus_n_per_mm
        assert bending.shear_modulus_n_per_mm == pytest.approx(shear, rel=2e-3)


def test_the_diagonals_change_places_in_a_mirror() -> None:
    twill, mirror = _mirrored("PKK/KPK/KKP", "acrylic"), _mirrored("KKP/KPK/PKK", "acrylic")
    assert twill.oblique == mirror.oblique[::-1]
    rising, falling = twill.oblique
    assert rising.rigidity_n_mm > 2.0 * falling.rigidity_n_mm  # along the ribs of the twill
    assert twill.twist_n_mm == mirror.twist_n_mm


@pytest.mark.parametrize("material_id", MATERIALS)
def test_every_repeat_is_bent_or_refused_with_the_reason(material_id: str) -> None:
    for chart in stored_charts(material_id):
        stored = _stored(chart.key, material_id)
        bending = stored.bending
        assert (bending.mirrored is None) == bool(bending.failure)
        if bending.mirrored is not None and bending.mirrored.minimum:
            assert bending.unmirrored is None
            lowest = stored.unmirrored.energy_n_mm
            assert lowest == pytest.approx(stored.energy_n_mm, rel=1e-3)
        elif not stored.unmirrored.minimum:
            assert (bending.unmirrored is None) == bool(bending.unmirrored_failure)
        for state in filter(None, (bending.mirrored, bending.unmirrored)):
            for response in (state.course, state.wale):
                assert min(response.rigidity_n_mm, response.held_n_mm) > 0.0
            assert (state.oblique is not None) == state.minimum


def test_other_yarns_and_loop_lengths_are_not_in_the_store() -> None:
    chart = StitchChart.parse("KPP")
    used = yarn_for(material("cotton"), chart)
    stored = stored_for(chart, used)
    assert stored.material == "cotton"
    assert stored_for(chart, replace(used, loop_length_mm=1.01 * used.loop_length_mm)) is None
    assert stored_for(chart, yarn_for(material("glove-wool"), chart)) is None


def test_what_is_written_is_read() -> None:
    for text in ("K", "P/K", "KP/KK"):
        bending = _stored(text, "acrylic").bending
        assert bending is not None
        assert of_document(document_of(bending)) == bending
