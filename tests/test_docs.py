"""Every Python example in the documentation runs, page by page, top to bottom."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGES = sorted([*ROOT.glob("docs/**/*.md"), ROOT / "README.md"])
NOTEBOOKS = ROOT / "docs" / "notebooks"
MADE = (ROOT / "docs" / "reference", ROOT / "docs" / "gallery.md")
"""Pages of the site that are made from code; the strict build checks links to them."""
FENCE = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def _id(page: Path) -> str:
    return str(page.relative_to(ROOT))


def _with_examples(page: Path) -> object:
    marks = [pytest.mark.slow] if page.parent == NOTEBOOKS else []
    return pytest.param(page, marks=marks, id=_id(page))


@pytest.mark.parametrize("page", [_with_examples(p) for p in PAGES if FENCE.search(p.read_text())])
def test_examples_run(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    namespace: dict[str, object] = {"__name__": "example"}
    for block in FENCE.findall(page.read_text()):
        exec(compile(block, _id(page), "exec"), namespace)  # noqa: S102 - our own pages


@pytest.mark.parametrize("page", PAGES, ids=_id)
def test_links_between_pages_lead_somewhere(page: Path) -> None:
    targets = re.findall(r"\]\(((?!https?:|mailto:|#)[^)#\s]+)", page.read_text())
    found = [(page.parent / target).resolve() for target in targets]
    assert not [to for to in found if not to.exists() and not {to, *to.parents} & {*MADE}]
