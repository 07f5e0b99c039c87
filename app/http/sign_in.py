"""The page that asks before a link with a token begins a session, if another site led here."""

from __future__ import annotations

from html import escape
from urllib.parse import parse_qs

from starlette.requests import Request
from starlette.responses import HTMLResponse
from starlette.types import Receive, Scope

PATH = "/sign-in"
MOST_BYTES = 4_000
POLICY = "default-src 'none'; form-action 'self'; frame-ancestors 'none'; base-uri 'none'"
PAGE = """<!doctype html><html lang="en"><meta charset="utf-8"><title>Knitcore: sign in</title>
<h1>Sign in as {user}?</h1>
<p>A link asks this browser to sign in as <strong>{user}</strong>{instead}. The person who gave
you the link may see what you design there.</p>
<form method="post" action="{path}">
<input type="hidden" name="token" value="{token}"><input type="hidden" name="to" value="{to}">
<button>Sign in as {user}</button></form><p><a href="/">Do not</a></p></html>"""


def sign_in_page(user: str, before: str, token: str, to: str) -> HTMLResponse:
    """Ask for a click before a session begins, or replaces that of the user ``before``."""
    instead = f", instead of <strong>{escape(before)}</strong>" if before else ""
    page = PAGE.format(
        user=escape(user), instead=instead, path=PATH, token=escape(token), to=escape(to)
    )
    headers = {
        "Content-Security-Policy": POLICY,
        "Referrer-Policy": "same-origin",  # without it the form's Origin would be "null"
        "Cache-Control": "no-store",
    }
    return HTMLResponse(page, headers=headers)


async def sign_in_form(scope: Scope, receive: Receive) -> tuple[str, str]:
    """(token, address to go to) of a submitted form; empty strings if it is malformed."""
    content = b""
    async for part in Request(scope, receive).stream():
        content += part
        if len(content) > MOST_BYTES:
            return "", ""
    fields = parse_qs(content.decode("latin-1"))
    return fields.get("token", [""])[0], fields.get("to", ["/"])[0]
