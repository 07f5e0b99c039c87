"""A page about each kind of problem."""

from __future__ import annotations

from fastapi import FastAPI, HTTPException
from fastapi.responses import HTMLResponse

from app.http.pages import page, prose
from app.problems.kinds import FOLDER, KINDS

ALL = f'<p><a href="{FOLDER}">All problems</a> · <a href="/docs">REST API</a></p>'
PAGES = frozenset({FOLDER, *(f"{FOLDER}/{name}" for name in KINDS)})


def serve_kinds(app: FastAPI) -> None:
    """Add the pages."""

    @app.get(FOLDER, include_in_schema=False)
    def kinds() -> HTMLResponse:
        return HTMLResponse(page("Knitcore: problems", "".join(map(_part, KINDS))))

    @app.get(FOLDER + "/{name}", include_in_schema=False)
    def kind(name: str) -> HTMLResponse:
        if name not in KINDS:
            raise HTTPException(404)
        return HTMLResponse(page(f"Knitcore: problem {name}", _part(name) + ALL))


def _part(name: str) -> str:
    kind = KINDS[name]
    return (
        f'<h2><a href="{FOLDER}/{name}">{name}</a></h2>{prose(kind.means)}{prose(kind.remedy)}'
        f"<p>Status: {kind.statuses}</p>"
    )
