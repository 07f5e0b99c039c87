"""JSON that somebody sent."""

import json

import pytest

from app.requests.base import (
    MAX_LISTED,
    MAX_NAMES,
    InvalidRequestError,
    RequestModel,
    decoded,
    read,
)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_no_text_holds_a_nul_wherever_it_stands(encoding: str) -> None:
    for value in ("\0", {"a": "b\0"}, {"\0": 1}, ["a", ["\\\0"]]):
        with pytest.raises(json.JSONDecodeError, match="NUL"):
            decoded(json.dumps(value).encode(encoding))
    for value in ("\\u0000", ["\\\\u0000", "u0000", "\u0001"], "KP"):
        assert decoded(json.dumps(value).encode(encoding)) == value


def test_a_name_comes_once_and_characters_are_whole() -> None:
    assert decoded('{"a": {"a": 1}}') == {"a": {"a": 1}}
    for text, why in (('{"a": 1, "a": 2}', "twice"), ('{"a": "\\ud800"}', "half of a character")):
        with pytest.raises(json.JSONDecodeError, match=why):
            decoded(text)


class _Numbers(RequestModel):
    numbers: list[int]


def test_a_great_many_faults_are_told_as_one() -> None:
    faults = []
    for count in (MAX_LISTED, MAX_LISTED + 1):
        with pytest.raises(InvalidRequestError) as refused:
            read(_Numbers, json.dumps({"numbers": ["x"] * count}))
        faults.append(len(refused.value.errors()))
    assert faults == [MAX_LISTED, 1]


def test_an_object_has_few_names() -> None:
    names = dict.fromkeys(map(str, range(MAX_NAMES)), 1)
    assert decoded(json.dumps(names)) == names
    with pytest.raises(json.JSONDecodeError, match="names"):
        decoded(json.dumps(names | {"another": 1}))
