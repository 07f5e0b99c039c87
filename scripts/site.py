"""Hooks of the documentation site (mkdocs.yml): pages made from code, formulas, run notebooks.

- The command, REST and library references are made from the parsers, the OpenAPI document and the
  docstrings, the gallery from the library; CONTRIBUTING.md and CHANGELOG.md become pages.
- Formulas between dollars become MathML, so that no script has to draw them.
- Notebooks (docs/notebooks) are run, and what their cells show is put below them.
"""

from __future__ import annotations

import ast
import contextlib
import inspect
import io
import os
import pkgutil
import re
import tempfile
from html import escape, unescape
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

    import click
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files
    from mkdocs.structure.pages import Page

ROOT = Path(__file__).resolve().parent.parent
FENCE = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FORMULA = re.compile(r'<(span|div) class="arithmatex">\\([(\[])(.*?)\\[)\]]</\1>', re.DOTALL)
LATER_IN_SEARCH = "---\nsearch:\n  boost: 0.2\n---\n\n"
"""References have every word; pages that explain them come first."""
ROLE = re.compile(r":(?:py:)?[a-z]+:<code>(~?)([^<]*)</code>")
SPHINX = re.compile(r":(?:py:)?[a-z]+:`(~?)([^`]*)`")
"""A reference of Sphinx in a docstring, which Markdown shows as it is; ROLE once it is HTML."""
LIST_AFTER_TEXT = re.compile(r"^([^\s|#-].*\n)(?=- )", re.MULTILINE)
"""GitHub begins a list there; MkDocs wants an empty line before it."""
ROOT_PAGES = {"contributing.md": "CONTRIBUTING.md", "changelog.md": "CHANGELOG.md"}


# -- pages made from code --------------------------------------------------------------------------


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages that are not in docs/."""
    from mkdocs.structure.files import File

    from scripts.gallery import gallery

    made = {
        name: LIST_AFTER_TEXT.sub(r"\1\n", (ROOT / source).read_text())
        for name, source in ROOT_PAGES.items()
    }
    made["reference/commands.md"] = commands_page()
    made["reference/rest.md"] = rest_page()
    made["reference/library.md"], modules = library_pages()
    for name, text in (made | modules).items():
        meta = LATER_IN_SEARCH if name.startswith("reference/") else ""
        files.append(File.generated(config, name, content=meta + text))
    for name, content in gallery().items():
        files.append(File.generated(config, name, content=content))
    return files


def commands_page() -> str:
    """Every command with its options, from the parsers of the command line."""
    import click

    from app.cli.main import main

    head = "Every command takes `--help`. Made from the command line's own parsers."
    parts = ["# Commands", "", head]
    for words, command in every_command(main, click.Context(main), "knitcore"):
        parts += ["", f"## {words}", "", (command.help or "").strip(), ""]
        context = click.Context(command, info_name=words)
        parts += ["```sh", command.get_usage(context).removeprefix("Usage: "), "```", ""]
        rows = [p.get_help_record(context) for p in command.params if isinstance(p, click.Option)]
        named = [row for row in rows if row is not None]
        if named:
            parts += ["| option | |", "|---|---|"]
            parts += [f"| {_code(name)} | {_cell(text)} |" for name, text in named]
    return "\n".join(parts)


def every_command(
    group: click.Group, context: click.Context, words: str = ""
) -> Iterator[tuple[str, click.Command]]:
    """All commands of a group with the words that call them."""
    import click

    for name in group.list_commands(context):
        command, called = group.get_command(context, name), f"{words} {name}".lstrip()
        if isinstance(command, click.Group):
            yield from every_command(command, context, called)
        elif command is not None:
            yield called, command


def _cell(text: str) -> str:
    """Escape a text for a cell; Markdown shows the backslash of an escaped bar inside code."""
    return escape(re.sub(r"\s+", " ", text), quote=False).replace("|", "&#124;")


def _code(text: str) -> str:
    """Code in a cell of a table, where a backslash before a bar would show."""
    return f"<code>{escape(' '.join(text.split())).replace('|', '&#124;')}</code>"


def rest_page() -> str:
    """Every operation of the service, from its OpenAPI document, by its own reference."""
    from app.service.main import create_app
    from app.service.settings import Settings
    from app.service.web.reference import reference

    with tempfile.TemporaryDirectory() as folder:
        page = reference(create_app(Settings(data_dir=Path(folder))).openapi())
    body = page.partition("</h1>")[2].rpartition("</html>")[0]
    here = re.sub(r'<a href="/[^"]*">(.*?)</a>', r"\1", body)  # only the service has those
    lines = [line for line in here.splitlines() if line.strip()]
    return "\n".join(["# REST API", "", '<div class="rest">', *lines, "</div>", ""])


def library_pages() -> tuple[str, dict[str, str]]:
    """A page for each room of the library, which mkdocstrings fills, and their list."""
    import knitcore

    names = sorted(vars(knitcore)["__all__"])
    listed = "\n".join(f"| {_public(name)} | {_cell(_summary(name))} |" for name in names)
    head = f"""\
# Library

`from knitcore import …` gives these names; the pages below have everything, by package.
Units are part of the names.

| name | what it is |
|---|---|
{listed}

## Packages
"""
    lines, pages = [head], {}
    rooms: dict[str, list[str]] = {}
    for module in pkgutil.walk_packages(knitcore.__path__, "knitcore."):
        if not any(part.startswith("_") for part in module.name.split(".")):
            rooms.setdefault(module.name.split(".")[1], []).append(module.name)
    for room, modules in sorted(rooms.items()):
        documented = ast.get_docstring(ast.parse(_source(f"knitcore.{room}")))
        first = (documented or "").partition("\n\n")[0].replace("\n", " ")
        lines.append(f"- [`knitcore.{room}`](library/{room}.md): {first}")
        body = "\n\n".join(f"::: {module}" for module in sorted(modules))
        pages[f"reference/library/{room}.md"] = f"# knitcore.{room}\n\n{body}\n"
    return "\n".join(lines), pages


def _public(name: str) -> str:
    """A public name, linked to its place in the page of its package."""
    home = getattr(__import__("knitcore"), name)
    where = f"{home.__module__}.{home.__qualname__}"
    return f"[`{name}`](library/{where.split('.')[1]}.md#{where})"


def _summary(name: str) -> str:
    """The first sentence of what a public name says about itself."""
    documented = inspect.getdoc(getattr(__import__("knitcore"), name)) or ""
    return SPHINX.sub(r"`\2`", documented.partition("\n\n")[0])


def _source(module: str) -> str:
    path = ROOT / module.replace(".", "/")
    return (path / "__init__.py" if path.is_dir() else path.with_suffix(".py")).read_text()


# -- links, notebooks, formulas --------------------------------------------------------------------


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Links that lead out of docs/ find their page; notebooks are run."""
    del config, files
    name = page.file.src_uri
    if name in ROOT_PAGES:
        return re.sub(r"\]\(docs/", "](", markdown)
    up = "../" * name.count("/")
    for target, source in ROOT_PAGES.items():
        markdown = markdown.replace(f"]({up}../{source}", f"]({up}{target}")
    markdown = re.sub(
        rf"\]\({up}\.\./knitcore/(\w+)(?:\.py|/\S*?)?\)",
        rf"]({up}reference/library/\1.md)",
        markdown,
    )
    return run(markdown) if name.startswith("notebooks/") else markdown


def run(markdown: str) -> str:
    """A notebook with what each cell prints and shows below it; cells share their names."""
    names: dict[str, Any] = {"__name__": "notebook"}
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        os.environ.setdefault("KNITCORE_DATA_DIR", folder)
        return FENCE.sub(lambda cell: f"{cell[0]}\n\n{_shown(cell[1], names)}", markdown)


def _shown(code: str, names: dict[str, Any]) -> str:
    """The output of a cell and the picture of its last expression, as HTML."""
    *statements, last = ast.parse(code).body
    printed = io.StringIO()
    value = None
    with contextlib.redirect_stdout(printed):
        if not isinstance(last, ast.Expr):
            statements.append(last)
        exec(compile(ast.Module(statements, []), "notebook", "exec"), names)
        if isinstance(last, ast.Expr):
            value = eval(compile(ast.Expression(last.value), "notebook", "eval"), names)
    parts = [f"<pre>{escape(printed.getvalue())}</pre>"] if printed.getvalue() else []
    if value is not None:
        show = getattr(value, "_repr_html_", None)
        parts.append(show() if show else f"<pre>{escape(repr(value))}</pre>")
    return f'<div class="shown">{"".join(parts)}</div>' if parts else ""


def on_page_content(html: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Formulas as MathML, references of docstrings as plain names."""
    del page, config, files
    from latex2mathml.converter import convert

    def formula(match: re.Match[str]) -> str:
        display = "block" if match[2] == "[" else "inline"
        made = str(convert(unescape(match[3]).strip(), display=display))
        return f'<div class="formula">{made}</div>' if display == "block" else made

    html = ROLE.sub(lambda role: f"<code>{_short(role[2]) if role[1] else role[2]}</code>", html)
    return FORMULA.sub(formula, html)


def _short(name: str) -> str:
    """The last part of a dotted name."""
    return name.rpartition(".")[2]
