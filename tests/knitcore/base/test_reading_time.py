"""Readers end when they have used their time, wherever they are."""

import contextlib
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from knitcore.base import reading_time
from knitcore.base.errors import InputError
from knitcore.base.reading_time import ReadingTimeError, in_reading_time
from knitcore.measure.photos.hanging_swatch import read_photo
from studies.speed.readers import CASES


@pytest.fixture(autouse=True)
def little_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reading_time, "READING_S", 0.02)
    monkeypatch.setattr(reading_time, "AGAIN_S", 0.02)


def work_for_ever() -> None:
    while True:
        pass


@in_reading_time
def read_for_ever(path: Path) -> None:
    """Never give up, whatever happens that a reader may expect."""
    while True:
        with contextlib.suppress(Exception):
            work_for_ever()


def check_refusal() -> None:
    with pytest.raises(ReadingTimeError, match=r"takes more than 0\.02 s to read") as refusal:
        read_for_ever(Path("folder/photo.png"))
    assert refusal.value.field == "photo.png"
    assert "smaller" in refusal.value.remedy


def test_a_reader_without_end_is_ended_in_any_thread() -> None:
    check_refusal()
    with ThreadPoolExecutor(1) as executor:
        executor.submit(check_refusal).result()


def test_a_reader_that_catches_everything_is_ended_too() -> None:
    caught = []

    @in_reading_time
    def read(path: Path) -> None:
        for _ in range(3):
            try:
                work_for_ever()
            except BaseException as error:
                caught.append(error)
        work_for_ever()

    with pytest.raises(ReadingTimeError):
        read(Path("photo.png"))
    assert len(caught) == 3


def test_readers_share_the_time_of_the_one_that_calls_them() -> None:
    @in_reading_time
    def read(path: str) -> None:
        with contextlib.suppress(InputError):
            read_for_ever(Path(path))

    with pytest.raises(ReadingTimeError, match=r"^outer\.csv: "):
        read("folder/outer.csv")


def test_time_ends_with_the_reader() -> None:
    """Leave what comes after it all its time, and results and errors as they are."""
    read = in_reading_time(lambda path: path.upper())
    assert read("photo.png") == "PHOTO.PNG"
    with pytest.raises(AttributeError):
        read(3)
    threads = [thread.name for thread in threading.enumerate()]
    assert "reading time" not in threads
    assert sum(i % 7 for i in range(1_000_000)) > 0


@pytest.mark.parametrize("name", CASES)
def test_all_readers_are_limited(name: str) -> None:
    read = read_photo if name.startswith("photo, ") else CASES[name].read
    assert hasattr(read, "__wrapped__")
