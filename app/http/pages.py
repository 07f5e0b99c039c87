"""What the pages about the API share: their style, and text with `names` in it."""

from __future__ import annotations

import re
from html import escape

STYLE = """
:root { color-scheme: light dark; }
:root { --line: light-dark(#d8d3cb, #46423c); --soft: light-dark(#f4f1ec, #26241f); }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 0 auto; padding: 1rem; }
code, pre { font: 14px/1.45 ui-monospace, monospace; overflow-wrap: anywhere; }
pre { background: var(--soft); padding: .7rem; overflow: auto; white-space: pre-wrap; }
details { border-top: 1px solid var(--line); padding: .4rem 0; }
summary { cursor: pointer; }
summary b { display: inline-block; min-width: 4.5rem; }
table { border-collapse: collapse; width: 100%; }
td, th { border-top: 1px solid var(--line); padding: .25rem .8rem .25rem 0; }
td, th { text-align: left; vertical-align: top; }
nav a { margin-right: 1rem; }
"""


def page(title: str, content: str) -> str:
    """A page without scripts and other hosts.

    Parameters
    ----------
    title : as text.
    content : as HTML.
    """
    return f"""<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(title)}</title>
<style>{STYLE}</style>
<h1>{escape(title)}</h1>
{content}
</html>
"""


def prose(text: str, tag: str = "p") -> str:
    """Text with `names` and **words** in it; a paragraph each, or without a tag in a line."""
    marked = re.sub(r"`+([^`]+)`+", r"<code>\1</code>", escape(text))
    marked = re.sub(r"\*\*([^*]+)\*\*", r"<b>\1</b>", marked)
    if not tag:
        return marked
    return "".join(f"<{tag}>{part}</{tag}>" for part in marked.split("\n\n") if part)
