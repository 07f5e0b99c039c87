"""Two hundred files that are not what they say: every reader refuses them in words.

KNITCORE_HOSTILE_FILES sets how many each reader gets.
"""

import base64
import io
import os
import random
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from pydantic import ValidationError

from app.context import Context
from app.operations.files.imports import ImportRequest, import_
from app.operations.measure.bending import BendingRequest, bending
from app.operations.measure.compression import CompressionRequest, compression
from app.operations.measure.fields import CompareRequest, compare
from app.operations.measure.fit import FitRequest, fit
from app.requests.uploads import UploadedFile, stored
from knitcore.base.errors import InputError, KnitcoreError

FILES = int(os.environ.get("KNITCORE_HOSTILE_FILES", "40"))


def _png(width: int, height: int) -> bytes:
    out = io.BytesIO()
    Image.new("L", (width, height), 255).save(out, "PNG")
    return out.getvalue()


def _bomb() -> bytes:
    """A PNG that says it has 60,000 x 60,000 pixels, with a checksum that agrees."""
    image = bytearray(_png(2, 2))
    image[16:24] = (60_000).to_bytes(4, "big") * 2
    image[29:33] = zlib.crc32(image[12:29]).to_bytes(4, "big")
    return bytes(image)


def _npz(**arrays: Any) -> bytes:
    out = io.BytesIO()
    np.savez(out, **arrays)
    return out.getvalue()


def _zip_bomb() -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("displacement.npy", b"\x93NUMPY\x01\x00" + b"0" * 5_000_000)
    return out.getvalue()


SEEDS = [
    b"",
    b"\x89HDF\r\n\x1a\n" + bytes(200),
    b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600),
    b"PK\x03\x04" + bytes(100),
    b"\x1f\x8b" + bytes(50),
    b"strain,force\n1,2\nx,y\n",
    b"\xff\xfe\x00\x00",
    b'{"format": "knitcore-design", "version": 2, "chart": ' + b"[" * 2000,
    b'<?xml version="1.0"?><!DOCTYPE a [<!ENTITY b SYSTEM "file:///etc/passwd">]><a>&b;</a>',
    _png(40, 40),
    _bomb(),
    _npz(displacement=np.zeros((1, 2, 3, 3)), frame=np.zeros(1)),
    _npz(displacement=np.array([{}], dtype=object), frame=np.zeros(1)),
    _zip_bomb(),
]
NAMES = ["a.csv", "a.h5", "a.png", "a.xls", "a.xlsx", "a.npz", "a.json", "a.txt", "a.k", "../../a"]


def _hostile(rng: random.Random) -> dict[str, Any]:
    content = bytearray(rng.choice(SEEDS))
    for _ in range(rng.randrange(4)):
        if content:
            content[rng.randrange(len(content))] = rng.randrange(256)
    if rng.random() < 0.3:
        content = content[: rng.randrange(len(content) + 1)]
    return {"name": rng.choice(NAMES), "content": bytes(content)}


def _request(kind: type[Any], **fields: Any) -> Any:
    def coded(value: Any) -> Any:
        if isinstance(value, bytes):
            return base64.b64encode(value).decode()
        if isinstance(value, dict):
            return {key: coded(inner) for key, inner in value.items()}
        return [coded(v) for v in value] if isinstance(value, list) else value

    return kind.model_validate({name: coded(value) for name, value in fields.items()})


HERE = Context(Path())
READERS: dict[str, Callable[[dict[str, Any], dict[str, Any]], Any]] = {
    "fit": lambda a, b: fit(_request(FitRequest, test_course=a, test_wale=b), HERE),
    "bending": lambda a, _: bending(
        _request(BendingRequest, images=[a], linear_density_g_per_m=0.5, length_mm=30.0), HERE
    ),
    "compression": lambda a, _: compression(_request(CompressionRequest, file=a), HERE),
    "compare": lambda a, _: compare(
        _request(CompareRequest, field=a, direction="course", material="acrylic", fabric="garter"),
        HERE,
    ),
    "import": lambda a, _: import_(_request(ImportRequest, file=a), HERE),
}


@pytest.mark.parametrize("reader", list(READERS))
@pytest.mark.filterwarnings("ignore")
def test_a_hostile_file_is_refused_in_words(reader: str) -> None:
    rng = random.Random(reader)  # noqa: S311 - repeatable, not secret
    refused = 0
    for _ in range(FILES):
        first, second = _hostile(rng), _hostile(rng)
        try:
            READERS[reader](first, second)
        except KnitcoreError as error:
            refused += len(str(error)) > 10
        except Exception as error:
            file = f"{first['name']} {first['content'][:40]!r}"
            raise AssertionError(f"{file} gives {type(error).__name__}: {error}") from error
    assert refused > FILES * 0.8


def _text_bomb() -> bytes:
    """A PNG with a compressed text of 80 MB."""
    chunk = b"zTXt" + b"a\0\0" + zlib.compress(b"0" * 80_000_000, 9)
    size, check = (len(chunk) - 4).to_bytes(4, "big"), zlib.crc32(chunk).to_bytes(4, "big")
    image = _png(2, 2)
    return image[:33] + size + chunk + check + image[33:]


LONG_NUMBER = b'{"format": "knitcore-design", "version": ' + b"1" * 5_000 + b"}"
UNCHANGING = b"strain_along,strain_across,force_n,width_mm\n" + b"0.1,0.02,0.5,50\n" * 60


@pytest.mark.parametrize(
    ("reader", "name", "content", "says"),
    [
        ("import", "a.png", _bomb(), "more pixels than"),
        ("import", "a.png", _text_bomb(), "not a readable PNG"),
        ("import", "a.json", LONG_NUMBER, "not valid JSON"),
        ("bending", "a.png", _text_bomb(), "cannot be read as an image"),
        ("fit", "a.csv", UNCHANGING, "the same in every row"),
    ],
    ids=["pixels", "text", "number", "photo", "unchanging"],
)
def test_a_file_beyond_the_limits_of_its_reader_is_refused(
    reader: str, name: str, content: bytes, says: str
) -> None:
    file = {"name": name, "content": content}
    with pytest.raises(InputError, match=says):
        READERS[reader](file, file)


@pytest.mark.parametrize("name", ["é" * 196 + ".txt", "🧶" * 190, "a" * 200, "." + "a" * 199, "/"])
def test_a_long_name_is_shortened(name: str) -> None:
    with stored([_request(UploadedFile, name=name, content=b"KP")]) as (path,):
        assert path.read_bytes() == b"KP"
        assert path.suffix == (".txt" if name.endswith(".txt") else path.suffix)


@pytest.mark.parametrize("content", ["%%%%", "S1A-S1A_", "S1BL UEs=", "S1A", "K\nA=="])
def test_damaged_base64_is_refused(content: str) -> None:
    with pytest.raises(ValidationError, match="not base64"):
        UploadedFile(name="a.txt", content=content)
