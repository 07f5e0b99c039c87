"""Context of an operation: all it needs besides its request, in the service and on the command
line."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from knitcore.materials import Material, load_material_file, material

from .service.results.on_disk import KeptResults
from .service.results.own_materials import KINDS, PREFIX, GivenMaterials, OwnMaterials

if TYPE_CHECKING:
    from knitcore.design.atlas import Atlas

    from .service.results.atlases import Extent


class Context:
    """Materials, stored results, cancellation and progress.

    Parameters
    ----------
    data_dir : folder of stored results, or a function that returns it.
    own : materials of users; none by default.
    local : whether the caller works on this machine: materials may then be files, and charts may be
        as large as the library accepts.
    cancelled : whether the caller has given up.
    progress : called with (done, total).
    before : what a 3D view shows of the result that the request names in ``after``, if any.
    """

    def __init__(
        self,
        data_dir: Path | Callable[[], Path],
        *,
        own: OwnMaterials | None = None,
        local: bool = False,
        cancelled: Callable[[], bool] = lambda: False,
        progress: Callable[[float, float], None] = lambda done, total: None,
        before: object = None,
    ) -> None:
        self._data_dir = data_dir
        self.own = own or GivenMaterials()
        self.local = local
        self.cancelled = cancelled
        self.progress = progress
        self.before = before

    @cached_property
    def data_dir(self) -> Path:
        """Folder of stored results."""
        return self._data_dir if isinstance(self._data_dir, Path) else self._data_dir()

    @property
    def kept(self) -> KeptResults:
        """Yarn-level results that were computed before."""
        return KeptResults(self.data_dir / "yarn-level")

    def material(self, name: str) -> Material:
        """A material from the library, the user's own materials or, on this machine, a file.

        Raises
        ------
        InputError
            If there is none.
        """
        if self.local and name.lower().endswith(KINDS):
            return load_material_file(name)
        return self.own.find(name) if name.startswith(PREFIX) else material(name)

    def atlas(self, name: str, extent: Extent, file: Path | None = None) -> Atlas:
        """The atlas of a material, built if it is not kept; or that of a file.

        Raises
        ------
        InputError
            If there is no such material, or the file cannot be read.
        """
        # most operations need none
        from knitcore.design.atlas import load_atlas

        from .service.results.atlases import atlas_of

        if file is not None:
            return load_atlas(file)
        return atlas_of(
            self.material(name),
            extent,
            self.data_dir,
            cancelled=self.cancelled,
            progress=self.progress,
        )

    def share(self, done: float) -> None:
        """Report progress, from 0 to 1."""
        self.progress(done, 1.0)

    def within(self, start: float, share: float) -> Context:
        """A context for part of the work, which makes up ``share`` of the whole."""

        def progress(done: float, total: float) -> None:
            self.progress(start + share * done / total, 1.0)

        return Context(
            self._data_dir,
            own=self.own,
            local=self.local,
            cancelled=self.cancelled,
            progress=progress,
        )


@dataclass(frozen=True)
class Supplies:
    """Things that a worker, here or on another machine, gets with a request.

    Attributes
    ----------
    data_dir : folder of stored results.
    own : JSON of the users' materials that the request names, by identifier.
    """

    data_dir: Path
    own: Mapping[str, str] = field(default_factory=dict)

    def context(self, **more: Any) -> Context:
        """The context of an operation, with other arguments of a :class:`Context`."""
        return Context(self.data_dir, own=GivenMaterials(self.own), **more)
