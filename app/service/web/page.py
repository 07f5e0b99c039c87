"""The page: the bundle that `make` builds, or its sources where there is no fresh bundle."""

import gzip
import logging
from functools import cache
from pathlib import Path, PurePosixPath

import plotly
from fastapi import FastAPI, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import FileResponse, Response
from starlette.background import BackgroundTask
from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from .packed import takes_gzip

log = logging.getLogger("knitcore.app")

IN_WHEEL = Path(__file__).resolve().parents[2] / "page"
SOURCES = Path(__file__).resolve().parents[3] / "frontend"
PLOTLY_SCRIPT = Path(plotly.__file__).parent / "package_data" / "plotly.min.js"
SUFFIXES = frozenset({".js", ".css", ".svg", ".map"})
NOT_OURS = frozenset({"dist", "node_modules", "tests"})
"""Folders next to the sources that browsers do not need."""
CHECK_AGAIN = "no-cache"
FOR_EVER = "public, max-age=31536000, immutable"
ONE_DAY = "public, max-age=86400"


def serve_page(app: FastAPI) -> None:
    """Add the page, its files and plotly to a service."""
    folder = page_files()
    built = folder != SOURCES

    @app.get("/", include_in_schema=False)
    async def page(request: Request) -> Response:
        answer = packed(folder / "index.html", request.headers, CHECK_AGAIN)
        answer.background = BackgroundTask(_note_visit, request.app)
        return answer

    if not built:  # the bundle has a smaller one

        @app.get("/static/plotly.min.js", include_in_schema=False)
        async def plotly_script(request: Request) -> Response:
            if not takes_gzip(request.headers):
                return FileResponse(PLOTLY_SCRIPT, headers={"Cache-Control": ONE_DAY})
            content = await run_in_threadpool(_packed_plotly)
            headers = {"Content-Encoding": "gzip", "Vary": "Accept-Encoding"}
            headers["Cache-Control"] = ONE_DAY
            return Response(content, media_type="text/javascript", headers=headers)

    app.mount("/static", PageFiles(folder, FOR_EVER if built else CHECK_AGAIN), name="static")


async def _note_visit(app: FastAPI) -> None:
    """Tell the service that its page is sent; in its own loop, as an event demands."""
    app.state.visited.set()


def page_files() -> Path:
    """The folder of the page's files."""
    return IN_WHEEL if IN_WHEEL.is_dir() else page_folder(SOURCES)


def script_tag(name: str) -> str:
    """A plain script of the page's files, to stand in a page of viser's client."""
    return f"<script>{(page_files() / name).read_text(encoding='utf-8')}</script>"


def page_folder(sources: Path) -> Path:
    """The folder to serve: the bundle, unless it is missing or older than the sources."""
    bundle = sources / "dist"
    try:
        built_at = (bundle / "index.html").stat().st_mtime
    except FileNotFoundError:
        log.warning("The page is not built and is served as its sources; `make page` builds it.")
        return sources
    if built_at < max(file.stat().st_mtime for file in _sources(sources)):
        log.warning("The page's sources are newer than its bundle; `make page` builds it again.")
        return sources
    return bundle


def _sources(folder: Path) -> list[Path]:
    files = [folder / "index.html"]
    for part in folder.iterdir():
        if part.is_dir() and part.name not in NOT_OURS:
            files += (file for file in part.rglob("*") if file.suffix in SUFFIXES)
        elif part.suffix in SUFFIXES:
            files.append(part)
    return files


class PageFiles(StaticFiles):
    """The page's files and nothing else in their folder, compressed for clients that accept it.

    Parameters
    ----------
    folder : the bundle or the sources.
    caching : Cache-Control of files whose name changes with their content.
    """

    def __init__(self, folder: Path, caching: str) -> None:
        super().__init__(directory=folder)
        self.folder = folder
        self.caching = caching

    async def get_response(self, path: str, scope: Scope) -> Response:
        """The file, or 404."""
        name = PurePosixPath(path)
        if name.suffix not in SUFFIXES or name.parts[0] in NOT_OURS or "\0" in path:
            raise HTTPException(404)
        named_by_content = "-" in name.stem and len(name.parts) == 1
        caching = self.caching if named_by_content else CHECK_AGAIN
        try:
            file, _ = self.lookup_path(path)  # refuses to leave the folder
        except OSError:  # longer than any name
            raise HTTPException(404) from None
        if file:
            return packed(Path(file), Headers(scope=scope), caching)
        raise HTTPException(404)


def packed(file: Path, headers: Headers, caching: str) -> Response:
    """A file, or the gzip of it that the build left next to it; 304 if the client has it."""
    answer = {"Cache-Control": caching, "Vary": "Accept-Encoding"}
    small = file.with_name(f"{file.name}.gz")
    if takes_gzip(headers) and small.is_file():
        answer["Content-Encoding"] = "gzip"
        file = small
    response = FileResponse(file, headers=answer, stat_result=file.stat())
    tag = response.headers["ETag"]
    if tag in headers.get("If-None-Match", ""):
        return Response(status_code=304, headers=answer | {"ETag": tag})
    return response


@cache
def _packed_plotly() -> bytes:
    return gzip.compress(PLOTLY_SCRIPT.read_bytes(), 6)
