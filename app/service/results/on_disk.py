"""Results in files of the data folder, named by everything that determines them.

A name is the digest of all inputs and of the code (:mod:`knitcore.yarn.library.fingerprint`), so a
result is never found for other inputs, nor after the solver or the operation has changed. Files
appear as a whole or not at all, so any number of processes may share the folder.
"""

import logging
import os
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from knitcore.yarn.library.fingerprint import SOLVERS, content_key

log = logging.getLogger("knitcore.kept")

MAX_BYTES = 200_000_000
"""Room for all results; the least recently used are removed first."""

Result = TypeVar("Result", bound=BaseModel)


class KeptResults:
    """A folder of results.

    Parameters
    ----------
    folder : made when the first result is kept.
    max_bytes : room for all of them.
    """

    def __init__(self, folder: Path, max_bytes: int = MAX_BYTES) -> None:
        self.folder = folder
        self.max_bytes = max_bytes

    def get_or_make(
        self,
        kind: type[Result],
        inputs: Mapping[str, Any],
        make: Callable[[], Result],
        *,
        fresh: bool = False,
    ) -> tuple[Result, bool]:
        """The kept result of these inputs, or a new one.

        Parameters
        ----------
        kind : model of the result, from the module of what makes it.
        inputs : all that decides it, JSON-able.
        make : computes it.
        fresh : compute it although it may be there, and keep the new one.

        Returns
        -------
        The result, and whether it had been kept.
        """
        if not fresh and (kept := self.stored(kind, inputs)) is not None:
            return kept, True
        result = make()
        self.keep(inputs, result)
        return result, False

    def stored(self, kind: type[Result], inputs: Mapping[str, Any]) -> Result | None:
        """The kept result of these inputs."""
        file = self._file(kind, inputs)
        try:
            result = kind.model_validate_json(file.read_bytes())
            os.utime(file)  # the least recently used are removed first
        except FileNotFoundError:
            return None
        except ValidationError:
            log.warning("%s is damaged and is computed again", file)
            return None
        except OSError as error:
            log.warning("%s cannot be read (%s): it is computed again", file, error)
            return None
        return result

    def keep(self, inputs: Mapping[str, Any], result: BaseModel) -> None:
        """Keep a result if there is room for it, in place of an earlier one of the same inputs."""
        file, content = self._file(type(result), inputs), result.model_dump_json().encode()
        if len(content) > self.max_bytes:
            return
        try:
            self.folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            handle, name = tempfile.mkstemp(dir=self.folder, suffix=".part")
            try:
                with os.fdopen(handle, "wb") as stream:
                    stream.write(content)
                Path(name).replace(file)
            finally:
                Path(name).unlink(missing_ok=True)
            self._make_room()
        except OSError as error:
            log.warning("a result cannot be kept in %s: %s", self.folder, error)

    def _file(self, kind: type[BaseModel], inputs: Mapping[str, Any]) -> Path:
        modules = (*SOLVERS, kind.__module__)
        return self.folder / f"{content_key({'kind': kind.__name__, **inputs}, modules)}.json"

    def _make_room(self) -> None:
        files = []
        for entry in os.scandir(self.folder):
            try:
                files.append((entry.stat().st_mtime_ns, entry.stat().st_size, Path(entry.path)))
            except FileNotFoundError:  # another process made room
                continue
        excess = sum(size for _, size, _ in files) - self.max_bytes
        for _, size, file in sorted(files):
            if excess <= 0:
                return
            file.unlink(missing_ok=True)
            excess -= size
