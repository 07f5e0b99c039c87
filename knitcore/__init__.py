"""Mechanics of knitted fabric, stitch by stitch.

The public names are listed in ``__init__.pyi``, which type checkers read as well. Each is imported
when it is first used, so that ``import knitcore`` costs little.
"""

import re as _re
from importlib import import_module as _import_module
from pathlib import Path as _Path
from typing import Any as _Any

_HOMES = {
    name: module
    for module, name in _re.findall(
        r"^from (\S+) import (\w+) as \2$",
        _Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8"),
        _re.MULTILINE,
    )
}
__all__ = list(_HOMES)


def __getattr__(name: str) -> _Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("knitcore")
    if name not in _HOMES:
        raise AttributeError(f"module 'knitcore' has no attribute {name!r}")
    public = getattr(_import_module(_HOMES[name]), name)
    globals()[name] = public
    return public


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
