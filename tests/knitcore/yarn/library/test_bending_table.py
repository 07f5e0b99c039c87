"""Bending of the packaged repeats."""

from __future__ import annotations

from dataclasses import astuple, replace

import pytest

from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials import material
from knitcore.yarn.library.bending_table import document_of, of_document
from knitcore.yarn.library.store import MATERIALS, StoredStitch, stored_charts, stored_for
from knitcore.yarn.library.store import stored_stitch as stored_or_none
from knitcore.yarn.library.yarns import yarn_for
from knitcore.yarn.study.bending import FabricBending, bending_response
from knitcore.yarn.study.relax import relax


def _stored(text: str, material_id: str) -> StoredStitch:
    found = stored_or_none(StitchChart.parse(text), material_id)
    assert found is not None
    return found


def _mirrored(text: str, material_id: str) -> FabricBending:
    bending = _stored(text, material_id).bending
    assert bending is not None
    assert bending.mirrored is not None
    return bending.mirrored


@pytest.mark.parametrize(
    "text",
    [
        "K",
        "P",
        "P/K",
        "PK",
        "KKP",
        "PPK",
        "KPP",
        "KKKP",
        "PPKP",
        "K/P/P",
        "PKK/KPK/KKP",
        "PPK/PKP/KPP",
    ],
)
def test_it_is_that_of_the_chart_relaxed_as_it_was_asked_for(text: str) -> None:
    """Shifts, mirror images and the other side of the fabric have their own signs.

    The twill is soft, and so known to 1e-3; the others agree within 1e-4.
    """
    stored, found = _stored(text, "acrylic"), _mirrored(text, "acrylic")
    fresh = bending_response(
        relax(stored.chart, stored.yarn, stored.loop_length_mm, branch="mirrored")
    )
    for one, other in ((found.course, fresh.course), (found.wale, fresh.wale)):
        assert astuple(one)[:3] == pytest.approx(astuple(other)[:3], rel=2e-3, abs=1e-6)
        assert one.strain_across_mm == pytest.approx(other.strain_across_mm, abs=1e-3)
    assert found.thickness_mm == pytest.approx(fresh.thickness_mm, rel=1e-4)
    if found.minimum:
        assert found.oblique is not None
        assert fresh.oblique is not None
        for one, other in zip(found.oblique, fresh.oblique, strict=True):
            assert astuple(one)[:2] == pytest.approx(astuple(other)[:2], rel=2e-3, abs=1e-6)
        shear = fresh.shear_modulus_n_per_mm
        assert found.shear_modulus_n_per_mm == pytest.approx(shear, rel=2e-3)


def test_the_diagonals_change_places_in_a_mirror() -> None:
    one, other = _mirrored("PKK/KPK/KKP", "acrylic"), _mirrored("KKP/KPK/PKK", "acrylic")
    assert one.oblique is not None
    assert other.oblique is not None
    assert one.oblique == other.oblique[::-1]
    rising, falling = one.oblique
    assert rising.rigidity_n_mm > 2.0 * falling.rigidity_n_mm  # along the ribs of the twill
    assert one.twist_n_mm == other.twist_n_mm


def test_the_back_curls_the_other_way() -> None:
    front, back = _mirrored("KKP", "cotton"), _mirrored("PPK", "cotton")
    assert back.course.moment_n == -front.course.moment_n > 0.0
    assert back.wale.strain_across_mm == -front.wale.strain_across_mm
    assert back.course.rigidity_n_mm == front.course.rigidity_n_mm
    assert back.swapped() == front


@pytest.mark.parametrize("material_id", MATERIALS)
def test_every_repeat_is_bent_or_refused_with_the_reason(material_id: str) -> None:
    for chart in stored_charts(material_id):
        stored = _stored(chart.key, material_id)
        bending = stored.bending
        assert bending is not None
        assert (bending.mirrored is None) == bool(bending.failure)
        assert stored.unmirrored is not None
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
    found = stored_for(chart, used)
    assert found is not None
    assert found.material == "cotton"
    assert stored_for(chart, replace(used, loop_length_mm=1.01 * used.loop_length_mm)) is None
    assert stored_for(chart, yarn_for(material("glove-wool"), chart)) is None


def test_what_is_written_is_read() -> None:
    for text in ("K", "P/K", "KP/KK"):
        bending = _stored(text, "acrylic").bending
        assert bending is not None
        assert of_document(document_of(bending)) == bending
