"""Results of the yarn level kept by their inputs."""

import logging
import os
from collections.abc import Callable
from itertools import count
from pathlib import Path

import pytest
from pydantic import BaseModel

from app.service.results.on_disk import KeptResults
from knitcore.yarn.library import fingerprint
from tests.app.command_line import run


class Answer(BaseModel):
    value: float


def counting() -> Callable[[], Answer]:
    """A computation that answers with the number of its calls."""
    calls = count(1)
    return lambda: Answer(value=next(calls))


def test_the_same_inputs_are_computed_once(tmp_path: Path) -> None:
    kept, make = KeptResults(tmp_path / "new"), counting()
    assert kept.get_or_make(Answer, {"a": 1}, make) == (Answer(value=1), False)
    assert kept.get_or_make(Answer, {"a": 1}, make) == (Answer(value=1), True)
    assert kept.get_or_make(Answer, {"a": 2}, make) == (Answer(value=2), False)
    assert kept.get_or_make(Answer, {"a": 1}, make, fresh=True) == (Answer(value=3), False)
    assert kept.get_or_make(Answer, {"a": 1}, make) == (Answer(value=3), True)


def test_a_result_of_other_code_is_computed_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept, make = KeptResults(tmp_path), counting()
    kept.get_or_make(Answer, {"a": 1}, make)
    monkeypatch.setattr(fingerprint, "code_version", lambda *modules: str(__name__ in modules))
    assert kept.get_or_make(Answer, {"a": 1}, make) == (Answer(value=2), False)


@pytest.mark.parametrize("damage", [b"", b'{"value": 1', b'{"other": 1}', b"\xff\xfe"])
def test_a_damaged_result_is_logged_and_computed_again(
    tmp_path: Path, damage: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    kept, make = KeptResults(tmp_path), counting()
    kept.get_or_make(Answer, {}, make)
    (file,) = tmp_path.iterdir()
    file.write_bytes(damage)
    with caplog.at_level(logging.WARNING, logger="knitcore.kept"):
        assert kept.get_or_make(Answer, {}, make) == (Answer(value=2), False)
    assert "damaged" in caplog.text
    assert kept.get_or_make(Answer, {}, make) == (Answer(value=2), True)


def test_the_longest_unused_result_makes_room(tmp_path: Path) -> None:
    size = len(Answer(value=1.0).model_dump_json())
    kept, make = KeptResults(tmp_path, max_bytes=2 * size), counting()
    for name in ("first", "second"):
        kept.get_or_make(Answer, {"name": name}, make)
    for file in tmp_path.iterdir():  # clocks of file systems are coarse
        os.utime(file, (1, 1))
    assert kept.get_or_make(Answer, {"name": "first"}, make)[1]
    kept.get_or_make(Answer, {"name": "third"}, make)
    assert len(list(tmp_path.iterdir())) == 2
    assert kept.get_or_make(Answer, {"name": "first"}, make)[1]
    assert not kept.get_or_make(Answer, {"name": "second"}, make)[1]


def test_a_read_only_folder_loses_no_result(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    file = tmp_path / "file"
    file.touch()
    kept = KeptResults(file / "folder")
    with caplog.at_level(logging.WARNING, logger="knitcore.kept"):
        assert kept.get_or_make(Answer, {}, counting()) == (Answer(value=1), False)
    assert "cannot be kept" in caplog.text


@pytest.mark.parametrize(
    "arguments",
    [
        ("relax", "stockinette", "--material", "cotton"),
        pytest.param(
            ("sweep", "stockinette", "--material", "cotton", "--direction", "course",
             "--max-strain", "0.1", "--points", "3"),
            marks=pytest.mark.slow,
        ),
    ],
)  # fmt: skip
def test_commands_remember_and_forget_on_request(
    arguments: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("KNITCORE_DATA_DIR", str(tmp_path))
    first, second, third = (run(*arguments, *more) for more in ((), (), ("--fresh",)))
    assert (first.pop("known"), second.pop("known"), third.pop("known")) == (False, True, False)
    assert first == second
    assert not run(*arguments, "--loop-length-mm", "12.5")["known"]
    assert len(list((tmp_path / "yarn-level").iterdir())) == 2
