"""Atlases kept in the data folder."""

from pathlib import Path

import pytest

from app.context import Context
from app.service.results import atlases
from app.service.results.atlases import FOLDER
from knitcore.chart.stitch_chart import StitchChart


@pytest.fixture
def context(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Context:
    repeats = tuple(StitchChart.parse(text) for text in ("K", "KP", "K\nP"))
    monkeypatch.setattr(atlases, "repeats_of", lambda _: repeats)
    monkeypatch.setattr(atlases, "built_here", dict)
    return Context(tmp_path)


def files(context: Context) -> list[str]:
    return sorted(file.name for file in (context.data_dir / FOLDER).iterdir())


def test_an_atlas_is_read_by_the_next_process(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    built = context.atlas("acrylic", "small")
    assert len(files(context)) == 1
    monkeypatch.setattr(atlases, "build_atlas", None)
    assert context.atlas("acrylic", "small").keys == built.keys


def test_an_atlas_of_other_code_is_built_again_and_replaces_it(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    context.atlas("acrylic", "small")
    context.atlas("cotton", "small")
    before = files(context)
    monkeypatch.setattr(atlases, "code_version", lambda *_: "of another program")
    context.atlas("acrylic", "small")
    after = files(context)
    assert len(after) == 2
    assert len(set(after) & set(before)) == 1


def test_a_damaged_file_is_built_again(context: Context) -> None:
    built = context.atlas("acrylic", "small")
    (file,) = (context.data_dir / FOLDER).iterdir()
    file.write_bytes(b"not an atlas")
    assert context.atlas("acrylic", "small").keys == built.keys
    assert file.stat().st_size > 100
