"""Passes: the holder of one may watch one view, even from a frame without cookies or origin.

The 3D view runs in a sandboxed frame: a process of its own in browsers that isolate such frames,
and a place from which a message of viser's cannot reach our page. Browsers send no cookie from
there and call its origin "null", as they do for the frames of any other site; so the page that
asked for the view hands this secret to its frame.
"""

import hmac
import secrets
import threading
from collections import OrderedDict
from dataclasses import dataclass
from urllib.parse import parse_qs

from starlette.types import Scope

from ..identity import current_session, current_user

MAX_PASSES = 10_000
"""Largest number of passes that are remembered; the oldest makes room for a new one."""


@dataclass(frozen=True)
class Opener:
    """Holder of a pass: user, session, and token and session as access control notes them."""

    user: str
    session: str
    opened_by: tuple[str, str] | None


class ViewPasses:
    """The passes given since the service started."""

    def __init__(self, most: int = MAX_PASSES) -> None:
        self._most = most
        self._secret = secrets.token_bytes(32)
        self._given: OrderedDict[tuple[str, str], Opener] = OrderedDict()
        self._lock = threading.Lock()

    def give(self, path: str, opened_by: tuple[str, str] | None) -> str:
        """A pass to the websocket at a path, for the user of this request; the same each time."""
        opener = Opener(current_user.get(), current_session.get(), opened_by)
        text = repr((path, opener)).encode()
        code = hmac.digest(self._secret, text, "sha256").hex()
        with self._lock:
            self._given[path, code] = opener
            self._given.move_to_end((path, code))
            while len(self._given) > self._most:
                self._given.popitem(last=False)
        return code

    def holder(self, scope: Scope) -> Opener | None:
        """Holder of a websocket's pass; None if it has none, or one to another path."""
        query: bytes = scope.get("query_string", b"")
        if scope["type"] != "websocket" or not query.startswith(b"pass="):
            return None
        code = parse_qs(query.decode("latin-1")).get("pass", [""])[0]
        with self._lock:
            return self._given.get((scope["path"], code))
