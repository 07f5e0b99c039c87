"""Licences of what is shipped with the service, and the list of packages."""

from email.message import Message
from importlib.metadata import Distribution
from pathlib import Path
from typing import Any

import pytest

from scripts import audit

LOCK = """# --- product: what `knitcore serve` needs
first==1.2 \\
    --hash=sha256:{0} \\
    --hash=sha256:{1}
second[extra]==3 ; python_version < "4" \\
    --hash=sha256:{0}
# --- installer
third==4 \\
    --hash=sha256:{0}
""".format("a" * 64, "b" * 64)


class Package(Distribution):
    """A package with a licence, as if it were installed."""

    def __init__(self, version: str, **facts: str) -> None:
        self._facts = {"Version": version} | facts

    @property
    def metadata(self) -> Any:
        message = Message()
        for name, value in self._facts.items():
            message[name.replace("_", "-")] = value
        return message

    def read_text(self, filename: str) -> str | None:
        return None

    def locate_file(self, path: Any) -> Path:
        return Path(path)


def faults_of(monkeypatch: pytest.MonkeyPatch, first: Package, second: Package) -> list[str]:
    """The faults of two installed packages."""
    monkeypatch.setattr(audit, "distribution", {"first": first, "second": second}.__getitem__)
    return audit.examined(LOCK)[1]


def test_only_the_pins_of_the_product_count_each_with_its_hashes() -> None:
    assert audit.pins(LOCK) == {"first": ("1.2", ["a" * 64, "b" * 64]), "second": ("3", ["a" * 64])}


@pytest.mark.parametrize(
    ("facts", "accepted"),
    [
        ({"License_Expression": "MIT"}, True),
        ({"License_Expression": "LGPL-3.0-only"}, True),
        ({"License_Expression": "GPL-3.0-only"}, False),
        ({"License_Expression": "BSD-3-Clause AND GPL-2.0-only"}, False),
        ({"License_Expression": "GPL-2.0-only OR MIT"}, True),
        ({"Classifier": "License :: OSI Approved :: BSD License"}, True),
        ({"Classifier": "License :: OSI Approved :: GNU Affero General Public License v3"}, False),
        ({"License": "Apache 2.0"}, True),
        ({}, False),
    ],
)
def test_a_licence_that_asks_for_more_than_its_text_is_refused(
    monkeypatch: pytest.MonkeyPatch, facts: dict[str, str], accepted: bool
) -> None:
    faults = faults_of(monkeypatch, Package("1.2", **facts), Package("3", License="MIT"))
    assert (faults == []) is accepted


def test_another_version_than_the_pinned_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    faults = faults_of(monkeypatch, Package("1.1", License="MIT"), Package("3", License="MIT"))
    assert faults == ["first is installed as 1.1, pinned as 1.2"]
