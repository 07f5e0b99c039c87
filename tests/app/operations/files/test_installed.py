"""Additions of extensions, over REST and on the command line."""

import base64
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.context import Context
from app.operations.files.export import MAX_STITCHES, ExportRequest, export
from knitcore.base.errors import InputError
from knitcore.base.extensions import Group
from knitcore.cloth.space.curl import MAX_STITCHES as LARGEST_CURLED
from tests.app.command_line import printed, run
from tests.extension_package import install, install_example


@pytest.fixture(autouse=True)
def house(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    install_example(monkeypatch, tmp_path / "site")


def test_the_commands_take_its_yarn_and_its_format(tmp_path: Path) -> None:
    predicted = run("predict", "moss", "--size", "24x6", "--material", "house-dk")
    assert (predicted["columns"], predicted["rows"]) == (24, 6)
    assert predicted["modulus_course_n_per_mm"] > 0

    out = tmp_path / "card.txt"
    printed("export", "moss", "--size", "24x6", "--to", "punchcard", "-o", str(out))
    assert out.read_text().splitlines()[1] == ".o" * 12


def test_the_service_has_its_yarns(client: TestClient) -> None:
    assert "house-dk" in [m["id"] for m in client.get("/api/v1/materials").json()["materials"]]


def test_a_request_for_its_format_is_a_file(tmp_path: Path) -> None:
    request = ExportRequest(chart="KP/KK", to="punchcard", name="Card")
    file = export(request, Context(tmp_path))
    assert (file.name, file.media_type) == ("Card.txt", "text/plain; charset=utf-8")
    assert b".o.o" in base64.b64decode(file.content)
    with pytest.raises(InputError, match="is not a format"):
        export(ExportRequest(chart="KP", to="no-such-format"), Context(tmp_path))


def test_the_list_shows_what_is_wrong(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, client: TestClient
) -> None:
    install(monkeypatch, tmp_path / "bad", "bad", "2.0", {Group.EXPORTERS: {"gone": "gone:all"}})
    answer = client.get("/api/v1/extensions").json()
    listed = {extension["name"]: extension for extension in answer["extensions"]}
    assert listed["knit-house"]["problem"] is None
    assert "ModuleNotFoundError" in listed["gone"]["problem"]
    assert answer["largest_exports"] == MAX_STITCHES
    assert answer["largest_charts"]["curl"] == LARGEST_CURLED
    assert "gone (bad 2.0)" in printed("extensions").stdout
