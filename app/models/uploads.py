"""Files that come inside a JSON request, as base64."""

from __future__ import annotations

import contextlib
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath

from pydantic import Base64Bytes, BaseModel, ConfigDict, Field, PrivateAttr


class UploadedFile(BaseModel):
    """A file's name and its content."""

    model_config = ConfigDict(extra="forbid")

    name: str = Field(min_length=1, max_length=200, examples=["course.csv"])
    content: Base64Bytes = Field(description="The file, base64.")
    _path: Path | None = PrivateAttr(None)

    @classmethod
    def at(cls, path: Path) -> UploadedFile:
        """A file of this machine, read where it is."""
        file = cls.model_construct(name=path.name, content=b"")
        file._path = path
        return file


@contextlib.contextmanager
def stored(files: Sequence[UploadedFile]) -> Iterator[list[Path]]:
    """The files in a folder that exists for the time of the context, each in one of its own."""
    with tempfile.TemporaryDirectory(prefix="knitcore-") as folder:
        paths = []
        for index, file in enumerate(files):
            if file._path is not None:
                paths.append(file._path)
                continue
            place = Path(folder) / str(index)
            place.mkdir()
            # only the last part, so that a name cannot lead out of the folder
            name = PurePosixPath(file.name.replace("\\", "/").replace("\0", "")).name
            path = place / (name if name not in ("", ".", "..") else "file")
            path.write_bytes(file.content)
            paths.append(path)
        yield paths
