"""Installs packages with entry points for a test, without pip: a folder on ``sys.path``."""

import sys
import tomllib
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).resolve().parent.parent / "examples" / "extensions"


def install_example(monkeypatch: pytest.MonkeyPatch, site: Path) -> None:
    """The example package, as an editable install would."""
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text())["project"]
    install(monkeypatch, site, project["name"], project["version"], project["entry-points"])
    monkeypatch.syspath_prepend(str(EXAMPLE))
    for module in [name for name in sys.modules if name.split(".")[0] == "knit_house"]:
        monkeypatch.delitem(sys.modules, module)


def install(
    monkeypatch: pytest.MonkeyPatch,
    site: Path,
    name: str,
    version: str,
    points: dict[str, dict[str, str]],
) -> None:
    """A package's metadata: its name, version and entry points by group."""
    info = site / f"{name.replace('-', '_')}-{version}.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    lines = [
        line
        for group, named in points.items()
        for line in (f"[{group}]", *(f"{point} = {target}" for point, target in named.items()))
    ]
    (info / "entry_points.txt").write_text("\n".join([*lines, ""]))
    monkeypatch.syspath_prepend(str(site))
