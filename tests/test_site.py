"""The documentation site: pages made from code, formulas, run cells, and the build itself."""

import importlib.util
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import click
import pytest
import yaml

import knitcore
from app.cli.main import main

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="module")
def site() -> ModuleType:
    spec = importlib.util.spec_from_file_location("site_hooks", ROOT / "scripts" / "site.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_cell_shows_what_it_prints_and_its_last_value(site: ModuleType) -> None:
    cells = ["x = 2\nprint('<x>')\nx + 1", "x = x + 3", "x"]
    page = site.run("".join(f"```python\n{cell}\n```\n" for cell in cells))
    assert re.findall(r"<pre>(.*?)</pre>", page, re.DOTALL) == ["&lt;x&gt;\n", "3", "5"]


def test_a_result_shows_itself_below_its_cell(site: ModuleType) -> None:
    page = "```python\nfrom knitcore import StitchChart\nStitchChart.parse('KP')\n```\n"
    assert "<svg" in site.run(page)


def test_formulas_become_mathml(site: ModuleType) -> None:
    html = '<p><span class="arithmatex">\\(a &lt; \\frac{1}{2}\\)</span></p>'
    made = site.on_page_content(html, None, None, None)
    assert "<mfrac>" in made
    assert "arithmatex" not in made


def test_formulas_on_their_own_scroll_on_narrow_screens(site: ModuleType) -> None:
    html = '<div class="arithmatex">\\[a = b\\]</div>'
    assert site.on_page_content(html, None, None, None).startswith('<div class="formula"><math')


def test_references_of_docstrings_are_plain_names(site: ModuleType) -> None:
    html = "see :func:<code>~knitcore.prediction.curve.curve</code> and :class:<code>Fit</code>"
    shown = "see <code>curve</code> and <code>Fit</code>"
    assert site.on_page_content(html, None, None, None) == shown


def test_the_library_begins_with_its_public_names(site: ModuleType) -> None:
    listed, _ = site.library_pages()
    assert [name for name in knitcore.__all__ if f"| [`{name}`](library/" not in listed] == []


def test_lists_of_the_changelog_are_lists(site: ModuleType) -> None:
    made = site.LIST_AFTER_TEXT.sub(r"\1\n", "Head\n- one\n  more\n- two\n")
    assert made == "Head\n\n- one\n  more\n- two\n"


def test_every_command_and_option_is_in_its_reference(site: ModuleType) -> None:
    page = site.commands_page()
    assert "## knitcore predict" in page
    assert "## knitcore measure bending" in page
    command = main.get_command(click.Context(main), "stretch")  # type: ignore[attr-defined]
    options = [opt for param in command.params for opt in param.opts if opt.startswith("--")]
    part = page.partition("## knitcore stretch\n")[2].partition("\n## ")[0]
    assert [option for option in options if option not in part] == []


def test_every_room_of_the_library_has_a_page(site: ModuleType) -> None:
    listed, pages = site.library_pages()
    files = (ROOT / "knitcore").glob("[a-z]*")
    rooms = {f.stem for f in files if f.suffix == ".py" or (f / "__init__.py").exists()}
    assert {Path(name).stem for name in pages} == rooms
    assert [room for room in rooms if f"](library/{room}.md)" not in listed] == []
    assert "::: knitcore.law.constitutive" in pages["reference/library/law.md"]


def test_issue_templates_are_forms() -> None:
    for file in (ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.yml"):
        form = yaml.safe_load(file.read_text())
        if file.stem != "config":
            assert {"name", "description", "body"} <= form.keys()


@pytest.mark.slow
def test_the_site_builds_in_strict_mode_and_loads_nothing_from_elsewhere(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "mkdocs", "build", "--quiet", "--strict", "-d", str(tmp_path)]
    built = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stdout + built.stderr
    foreign = re.compile(
        r"<(?:script|img|iframe)[^>]+src=\"?https?:|<link[^>]+stylesheet[^>]+https?:"
    )
    pages = list(tmp_path.rglob("*.html"))
    assert len(pages) > 50
    assert [page for page in pages if foreign.search(page.read_text())] == []
    shown = re.findall(r'(?:href|src)="(gallery/[^"]+)"', (tmp_path / "gallery.html").read_text())
    assert len(set(shown)) == 40
    assert [name for name in shown if not (tmp_path / name).is_file()] == []
    theory = (tmp_path / "theory.html").read_text()
    assert theory.count("<math") > 40
    assert "arithmatex" not in theory
