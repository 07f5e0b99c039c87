"""Pages that sign in: with a token, and after a link, if another site led here."""

from html import escape
from urllib.parse import parse_qs

from starlette.requests import ClientDisconnect, Request
from starlette.responses import HTMLResponse
from starlette.types import Receive, Scope

from .reference import page

PATH = "/sign-in"
MAX_BYTES = 4_000
POLICY = (
    "default-src 'none'; style-src 'unsafe-inline'; form-action 'self'; frame-ancestors 'none'; "
    "base-uri 'none'"
)
HEADERS = {
    "Content-Security-Policy": POLICY,
    "Referrer-Policy": "same-origin",  # without it the form's Origin would be "null"
    "Cache-Control": "no-store",
}
ASK = """<p>A link asks this browser to sign in as <strong>{user}</strong>{instead}. The person who
gave you the link may see what you design there.</p>
<form method="post" action="{path}">
<input type="hidden" name="token" value="{token}"><input type="hidden" name="to" value="{to}">
<button>Sign in as {user}</button></form><p><a href="/">Cancel</a></p>"""
FORM = """<form method="post" action="{path}">
<p role="alert">{problem}</p>
<p><label>Token <input type="password" name="token" required autocomplete="off"></label>
<button>Sign in</button></p></form>
<p>The operator of this service issues tokens. A link that ends in <code>/?token=…</code> signs in,
too.</p>"""


def sign_in_page(user: str, before: str, token: str, to: str) -> HTMLResponse:
    """Ask for a click before a session begins, or replaces that of the user ``before``."""
    instead = f", instead of <strong>{escape(before)}</strong>" if before else ""
    content = ASK.format(
        user=escape(user), instead=instead, path=PATH, token=escape(token), to=escape(to)
    )
    return HTMLResponse(page(f"Sign in as {user}?", content), headers=HEADERS)


def token_page(status: int, problem: str = "") -> HTMLResponse:
    """Ask for a token, and say what was wrong with the last one."""
    content = FORM.format(path=PATH, problem=escape(problem))
    return HTMLResponse(page("Sign in to Knitcore", content), status, HEADERS)


async def sign_in_form(scope: Scope, receive: Receive) -> tuple[str, str]:
    """(token, address to go to) of a submitted form; empty strings if it is malformed or cut."""
    content = b""
    try:
        async for part in Request(scope, receive).stream():
            content += part
            if len(content) > MAX_BYTES:
                return "", ""
    except ClientDisconnect:
        return "", ""
    fields = parse_qs(content.decode("latin-1"))
    return fields.get("token", [""])[0], fields.get("to", ["/"])[0]
