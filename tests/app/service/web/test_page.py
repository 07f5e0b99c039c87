"""The page's files: which are served, how they are cached and packed."""

import asyncio
import gzip
import os
from pathlib import Path

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.service.web import page as page_module
from app.service.web.page import FOR_EVER, PageFiles, page_folder, serve_page

SCRIPT = b"export const stitches = 'KP';\n" * 20


@pytest.fixture
def sources(tmp_path: Path) -> Path:
    """A page of one script, its test, and a build of it."""
    (tmp_path / "core").mkdir()
    (tmp_path / "tests").mkdir()
    (tmp_path / "dist").mkdir()
    for name in ("index.html", "app.js", "core/grid.js", "tests/grid.test.js", "package.json"):
        (tmp_path / name).write_bytes(SCRIPT)
    (tmp_path / "dist/index.html").write_bytes(SCRIPT)
    (tmp_path / "dist/app-AB12CD.js").write_bytes(SCRIPT)
    (tmp_path / "dist/app-AB12CD.js.gz").write_bytes(gzip.compress(SCRIPT))
    return tmp_path


def served(folder: Path) -> TestClient:
    app = FastAPI()
    app.mount("/static", PageFiles(folder, FOR_EVER))
    return TestClient(app)


def test_a_fresh_bundle_is_served(sources: Path) -> None:
    assert page_folder(sources) == sources / "dist"


def test_a_wheel_brings_its_page(sources: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page_module, "IN_WHEEL", sources / "dist")
    monkeypatch.setattr(page_module, "SOURCES", sources / "not-there")
    app = FastAPI()
    app.state.visited = asyncio.Event()
    serve_page(app)
    with TestClient(app) as client:
        assert client.get("/").content == SCRIPT
        kept = client.get("/static/app-AB12CD.js")
        assert (kept.content, kept.headers["cache-control"]) == (SCRIPT, FOR_EVER)


def test_an_old_bundle_gives_way_to_its_sources(
    sources: Path, caplog: pytest.LogCaptureFixture
) -> None:
    later = (sources / "dist/index.html").stat().st_mtime + 5
    os.utime(sources / "tests/grid.test.js", (later, later))
    assert page_folder(sources) == sources / "dist"
    os.utime(sources / "core/grid.js", (later, later))
    assert page_folder(sources) == sources
    assert "make page" in caplog.text


def test_without_a_bundle_the_sources_are_served(
    sources: Path, caplog: pytest.LogCaptureFixture
) -> None:
    (sources / "dist/index.html").unlink()
    assert page_folder(sources) == sources
    assert "not built" in caplog.text
    with served(sources) as client:
        assert client.get("/static/core/grid.js").content == SCRIPT


@pytest.mark.parametrize(
    "path",
    [
        "tests/grid.test.js",
        "package.json",
        "dist/app-AB12CD.js",
        "nothing.js",
        "",
        "../secret.js",
        "a%00.js",
    ],
)
def test_nothing_but_the_page_is_served(sources: Path, path: str) -> None:
    (sources.parent / "secret.js").write_text("secret")
    with served(sources) as client:
        assert client.get(f"/static/{path}").status_code == 404


def test_files_named_by_content_are_packed_and_kept_for_ever(sources: Path) -> None:
    with served(sources / "dist") as client:
        packed = client.get("/static/app-AB12CD.js", headers={"Accept-Encoding": "gzip"})
        assert packed.headers["Content-Encoding"] == "gzip"
        assert packed.headers["Cache-Control"] == FOR_EVER
        assert packed.headers["Content-Type"].startswith("text/javascript")
        assert int(packed.headers["Content-Length"]) < len(SCRIPT)
        assert packed.content == SCRIPT
        plain = client.get("/static/app-AB12CD.js", headers={"Accept-Encoding": "identity"})
        assert "Content-Encoding" not in plain.headers
        assert plain.content == SCRIPT
        known = {"If-None-Match": packed.headers["ETag"], "Accept-Encoding": "gzip"}
        assert client.get("/static/app-AB12CD.js", headers=known).status_code == 304


def test_other_files_are_requested_again(sources: Path) -> None:
    with served(sources) as client:
        assert client.get("/static/app.js").headers["Cache-Control"] == "no-cache"
