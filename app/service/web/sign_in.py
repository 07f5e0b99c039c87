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
MARK = """<svg viewBox="0 0 32 32" width="44" height="44" aria-hidden="true">
<rect width="32" height="32" rx="7" fill="#2b2622"/>
<g fill="none" stroke="#f3ece1" stroke-width="3.4" stroke-linecap="round">
<path d="M6 6.500q3.500 6 9 9M26 6.500q-3.500 6-9 9"/>
<path d="M6 16.500q3.500 6 9 9M26 16.500q-3.500 6-9 9" stroke="#d9584a"/></g></svg>"""
STYLE = """
html { background: var(--page); min-height: 100%; display: grid; place-items: center; }
body { box-sizing: border-box; width: min(27rem, 100vw - 2rem); margin: 1rem; padding: 2rem; }
body { background: var(--panel); border: 1px solid var(--line); border-radius: 14px; }
h1 { margin: .8rem 0 .4rem; font-size: 1.5rem; line-height: 1.25; overflow-wrap: anywhere; }
p { margin: .6rem 0; color: var(--muted); }
strong { color: var(--text); overflow-wrap: anywhere; }
[role=alert] { color: var(--danger); }
[role=alert]:empty { display: none; }
label { display: grid; gap: .3rem; margin-top: 1.2rem; font-weight: 600; }
input, button { box-sizing: border-box; width: 100%; padding: .65rem .8rem; font: inherit; }
input { background: var(--raised); color: inherit; }
input, button { border: 1px solid var(--line-strong); border-radius: 8px; }
button { margin: .9rem 0; background: var(--accent); border-color: transparent; cursor: pointer; }
button { color: var(--on-accent); font-weight: 600; }
button:hover { background: var(--accent-hover); }
:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
"""
ASK = """<p>A link asks this browser to sign in as <strong>{user}</strong>{instead}. The person who
gave you the link may see what you design there.</p>
<form method="post" action="{path}">
<input type="hidden" name="token" value="{token}"><input type="hidden" name="to" value="{to}">
<button>Sign in as {user}</button></form><p><a href="/">Cancel</a></p>"""
FORM = """<form method="post" action="{path}">
<p>Design how knitted fabric stretches, curls and fits.</p>
<label>Token <input type="password" name="token" required autofocus autocomplete="off"></label>
<p role="alert">{problem}</p>
<button>Sign in</button></form>
<p>Whoever runs this service gives you a token, or a link that signs you in.</p>"""


def sign_in_page(user: str, before: str, token: str, to: str) -> HTMLResponse:
    """Ask for a click before a session begins, or replaces that of the user ``before``."""
    instead = f", instead of <strong>{escape(before)}</strong>" if before else ""
    content = ASK.format(
        user=escape(user), instead=instead, path=PATH, token=escape(token), to=escape(to)
    )
    return HTMLResponse(page(f"Sign in as {user}?", content, STYLE, MARK), headers=HEADERS)


def token_page(status: int, problem: str = "") -> HTMLResponse:
    """Ask for a token, and say what was wrong with the last one."""
    content = FORM.format(path=PATH, problem=escape(problem))
    return HTMLResponse(page("Sign in to Knitcore", content, STYLE, MARK), status, HEADERS)


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
