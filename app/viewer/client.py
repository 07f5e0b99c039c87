"""viser's client page, with our scripts before its own."""

import hashlib
from dataclasses import dataclass
from pathlib import Path

import viser

from ..service.web.page import script_tag

CLIENT_PAGE = Path(viser.__file__).parent / "client" / "build" / "index.html"
SCRIPTS = ("viser/notices.js", "viser/yarn.js", "viser/aside.js", "viser/frame.js")
STYLE = """<style>
  /* viser's notes are about the computer, not about the fabric. */
  .mantine-Notifications-root { display: none !important; }
  /* viser fades the scene while it loads pictures of surroundings, of which there are none. */
  canvas { opacity: 1 !important; }
  /* Where viser draws rectangles to select with: one more layer that every frame would blend. */
  canvas[width="0"] { display: none !important; }
</style>"""
VIEW_STYLE = """<style>
  /* The page around the view has all controls; viser's own would repeat them. */
  .mantine-Paper-root { display: none !important; }
  /* The page's theme shows through. */
  html, body, #root, #root div { background-color: transparent !important; }
</style>"""


@dataclass(frozen=True)
class ViewerPage:
    """The page of a view, without viser's control panel."""

    content: bytes
    tag: str


def viewer_page() -> ViewerPage:
    """Put it together."""
    page = with_scripts(CLIENT_PAGE.read_text(encoding="utf-8"), VIEW_STYLE).encode()
    return ViewerPage(page, f'"{hashlib.sha256(page).hexdigest()[:16]}"')


def with_scripts(page: str, more: str = "") -> str:
    """A page of viser's client that draws as ours do, with more for its head."""
    scripts = "".join(map(script_tag, SCRIPTS))
    return page.replace("<head>", f"<head>{more}{scripts}{STYLE}", 1)
