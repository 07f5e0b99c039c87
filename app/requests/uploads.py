"""Files inside a JSON request, as base64."""

from __future__ import annotations

import base64
import contextlib
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath
from typing import Annotated

from pydantic import BaseModel, EncodedBytes, EncoderProtocol, Field, PrivateAttr
from pydantic_core import PydanticCustomError

from .base import RequestModel

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
"""Files of the API's examples (``tests/example_files.py``)."""
MAX_NAME_BYTES = 200
"""A length that every file system accepts."""


class _Strict(EncoderProtocol):
    """Strict base64: a file arrives whole, or not at all."""

    @classmethod
    def decode(cls, data: bytes) -> bytes:
        try:
            return base64.b64decode(data, validate=True)
        except ValueError as error:
            raise PydanticCustomError(
                "base64", "This is not base64: {error}", {"error": str(error)}
            ) from None

    @classmethod
    def encode(cls, value: bytes) -> bytes:
        return base64.b64encode(value)

    @classmethod
    def get_json_format(cls) -> str:
        return "base64"


Content = Annotated[bytes, EncodedBytes(encoder=_Strict)]


class UploadedFile(RequestModel):
    """A file's name and its content."""

    name: str = Field(min_length=1, max_length=200, examples=["course.csv"])
    content: Content = Field(description="The file, base64.")
    _path: Path | None = PrivateAttr(None)

    @classmethod
    def at(cls, path: Path) -> UploadedFile:
        """A file of this machine, read in place."""
        file = cls.model_construct(name=path.name, content=b"")
        file._path = path
        return file


def has_files(request: BaseModel) -> bool:
    """Say whether a request brings files."""
    lists = (value if isinstance(value, list) else [value] for _, value in request)
    return any(isinstance(part, UploadedFile) for parts in lists for part in parts)


def example_file(name: str) -> dict[str, str]:
    """A file of the API's examples, as a request holds it."""
    content = base64.b64encode((EXAMPLES / name).read_bytes()).decode()
    return {"name": name, "content": content}


@contextlib.contextmanager
def stored(files: Sequence[UploadedFile]) -> Iterator[list[Path]]:
    """The files in a temporary folder, each in a subfolder, for the duration of the context."""
    with tempfile.TemporaryDirectory(prefix="knitcore-") as folder:
        paths = []
        for index, file in enumerate(files):
            if file._path is not None:
                paths.append(file._path)
                continue
            place = Path(folder) / str(index)
            place.mkdir()
            path = place / _name(file.name)
            path.write_bytes(file.content)
            paths.append(path)
        yield paths


def _name(given: str) -> str:
    """The last part of a name, which cannot lead out of its folder, cut to the permitted length."""
    name = PurePosixPath(given.replace("\\", "/").replace("\0", ""))
    room = MAX_NAME_BYTES - len(name.suffix.encode())
    if name.name in ("", ".", "..") or room < 1:
        return "file"
    return name.stem.encode()[:room].decode(errors="ignore") + name.suffix
