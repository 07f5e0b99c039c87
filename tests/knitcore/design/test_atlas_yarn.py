from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest

from knitcore import CancelledError, Fabric, InputError, StitchChart, material
from knitcore.chart.repeats import repeats_up_to
from knitcore.design.atlas import Atlas, load_atlas
from knitcore.design.atlas_build import build_atlas
from knitcore.design.atlas_yarn import (
    improve_atlas,
    key_of_pure,
    yarn_level_folder,
    yarn_level_tasks,
)
from knitcore.yarn.library.characterise import RepeatTask
from knitcore.yarn.library.store import stored_stitch

WOOL = material("glove-wool")
"""Not in the packaged store, so its atlas is a composite to begin with."""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A small composite atlas."""
    atlas_file = tmp_path / "wool.npz"
    build_atlas(WOOL, repeats_up_to(2, 3), file=atlas_file)
    return atlas_file


class Relaxing:
    """Documents of the packaged acrylic in place of minutes of work."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.done: list[str] = []
        monkeypatch.setattr("knitcore.design.atlas_yarn.characterise_repeat", self)

    def __call__(self, task: RepeatTask) -> dict[str, Any]:
        stored = stored_stitch(StitchChart.parse(task.chart), "acrylic")
        self.done.append(task.chart)
        return {
            "cell_course_mm": stored.cell_course_mm,
            "cell_wale_mm": stored.cell_wale_mm,
            "converged": stored.converged,
            "law": None if stored.law is None else asdict(stored.law),
        }


def yarn_level_keys(atlas: Atlas) -> set[str]:
    return {k for k, source in zip(atlas.keys, atlas.provenance, strict=True) if source == "swept"}


def test_small_repeats_come_first_after_the_pure_fabrics(file: Path) -> None:
    tasks = yarn_level_tasks(WOOL, load_atlas(file).entries(), 6)
    order = [len(key.replace("/", "")) for key in tasks]
    assert set(list(tasks)[:4]) == {key_of_pure(fabric) for fabric in Fabric}
    assert order[4:] == sorted(order[4:])
    assert len(yarn_level_tasks(WOOL, load_atlas(file).entries(), 4)) < len(tasks)


def test_a_stopped_run_resumes_with_finished_repeats_in_the_atlas(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    relaxing = Relaxing(monkeypatch)
    composite = load_atlas(file)
    with pytest.raises(CancelledError):
        improve_atlas(
            WOOL, file, most_stitches=6, workers=1, cancelled=lambda: len(relaxing.done) >= 6
        )
    assert len(relaxing.done) == 6
    part = load_atlas(file)
    assert yarn_level_keys(part) == set(relaxing.done[4:])

    whole = improve_atlas(WOOL, file, most_stitches=6, workers=1)
    assert len(relaxing.done) == len(set(relaxing.done))  # nothing twice
    assert yarn_level_keys(whole) == set(relaxing.done[4:])
    assert len(whole) == len(composite)
    for key in whole.keys:
        row = whole.only((key,))
        changed = key in yarn_level_keys(whole)
        assert (row.values != composite.only((key,)).values).any() or not changed
        assert (row.column("relaxed_course_mm") > 0).all() or not changed


def test_results_of_a_killed_run_are_used(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Finished documents lie in the folder; the atlas was never written."""
    relaxing = Relaxing(monkeypatch)
    untouched = file.read_bytes()
    improve_atlas(WOOL, file, most_stitches=4, workers=1)
    file.write_bytes(untouched)
    damaged = next(iter(yarn_level_folder(file).iterdir()))
    damaged.write_text("{", encoding="utf-8")
    before = len(relaxing.done)
    again = improve_atlas(WOOL, file, most_stitches=4, workers=1)
    assert len(relaxing.done) == before + 1
    assert yarn_level_keys(again)


def test_there_must_be_an_atlas_first(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no file"):
        improve_atlas(WOOL, tmp_path / "none.npz", most_stitches=4)
