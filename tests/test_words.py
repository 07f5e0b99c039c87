"""Words in the code and numbers in prose: how many still break the rules of CONTRIBUTING.md.

``ALLOWED`` has a number for each folder, which may only go down; a folder that it does not name
may have none. ``python -m tests.test_words`` prints the table as it would be today, and
``python -m tests.test_words FOLDER`` where a folder's faults are.
"""

import ast
import re
import sys
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).resolve().parent.parent
VAGUE = frozenset({"found", "told", "asked", "wanted", "one"})
"""Names that do not say what a variable holds."""
FRAGMENT = re.compile(r"(Of|So|As|Those|That|What|Which|Whether)\b")
"""Beginnings of docstrings that do not stand alone."""
BARE_NUMBER = re.compile(r"(?<![\w.)\]}/*:-])[-−]?\.\d")
"""A number without the zero before its point."""
CODE = re.compile(r"^```.*?^```$|``.*?``|`[^`\n]*`", re.MULTILINE | re.DOTALL)
"""Parts of prose that are not prose."""
DOCTEST = re.compile(r"^ *>>> .*(?:\n *\S.*)*", re.MULTILINE)

ALLOWED: dict[str, dict[str, int]] = {"names": {"app/operations": 1}}
"""Faults that each folder may still have, by rule."""


class Fault(NamedTuple):
    """A place that breaks a rule."""

    rule: str
    folder: str
    place: str
    text: str


@cache
def faults() -> tuple[Fault, ...]:
    """All faults in code and prose."""
    every: list[Fault] = []
    for top in ("knitcore", "app", "scripts", "tests"):
        for file in sorted((ROOT / top).rglob("*.py")):
            if not file.name.startswith("test_"):
                every += faults_of_code(file)
    for file in sorted((ROOT / "docs").glob("*.md")):
        text = blanked(CODE, file.read_text(encoding="utf-8"))
        every += (fault("numbers", file, line, what) for line, what in bare_numbers(text))
    return tuple(every)


def fault(rule: str, file: Path, line: int, text: str) -> Fault:
    path = file.relative_to(ROOT)
    folder = "/".join(path.parts[:-1][:2])
    return Fault(rule, folder, f"{path}:{line}", text)


def faults_of_code(file: Path) -> Iterator[Fault]:
    """Faults in a module: vague names, fragments of docstrings and bare numbers in them."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) and node.id in VAGUE:
            yield fault("names", file, node.lineno, node.id)
        if isinstance(node, ast.arg) and node.arg in VAGUE:
            yield fault("names", file, node.lineno, node.arg)
        for string in docstrings(node):
            text = str(string.value)
            if FRAGMENT.match(text.lstrip()):
                yield fault("docstrings", file, string.lineno, text.strip().partition("\n")[0])
            prose = blanked(CODE, blanked(DOCTEST, text))
            for line, what in bare_numbers(prose):
                yield fault("numbers", file, string.lineno + line - 1, what)


def docstrings(node: ast.AST) -> Iterator[ast.Constant]:
    """Strings that stand alone in a body: docstrings, and notes below an assignment."""
    if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
        for statement in node.body:
            value = statement.value if isinstance(statement, ast.Expr) else None
            if isinstance(value, ast.Constant) and isinstance(value.value, str):
                yield value


def blanked(pattern: re.Pattern[str], text: str) -> str:
    """A text without what matches, its lines kept."""
    return pattern.sub(lambda match: "\n" * match[0].count("\n"), text)


def bare_numbers(text: str) -> Iterator[tuple[int, str]]:
    """Lines and texts of the numbers that are written without a zero."""
    for number, line in enumerate(text.split("\n"), start=1):
        for match in BARE_NUMBER.finditer(line):
            yield number, line[max(0, match.start() - 20) : match.end() + 20].strip()


def counts() -> dict[str, dict[str, int]]:
    """Faults of each folder, by rule."""
    made: dict[str, Counter[str]] = {}
    for each in faults():
        made.setdefault(each.rule, Counter())[each.folder] += 1
    return {rule: dict(sorted(folders.items())) for rule, folders in sorted(made.items())}


@pytest.mark.parametrize("rule", ["docstrings", "names", "numbers"])
def test_no_folder_has_more_faults_than_it_is_allowed(rule: str) -> None:
    allowed = ALLOWED.get(rule, {})
    more = {
        folder: f"{count}, allowed {allowed.get(folder, 0)}"
        for folder, count in counts().get(rule, {}).items()
        if count > allowed.get(folder, 0)
    }
    assert not more, f"python -m tests.test_words FOLDER lists them: {more}"


def test_the_command_line_has_no_vague_names_nor_fragments() -> None:
    assert not [each for each in faults() if each.folder in {"app/cli", "tests/app/cli"}]


@pytest.mark.parametrize(
    ("text", "count"),
    [("by .1 or -.25 mm", 2), ("0.1, 1.5, v1.2, a.0, ../.1x", 0), ("(.5 to .7)", 2)],
)
def test_bare_numbers_are_seen(text: str, count: int) -> None:
    assert len(list(bare_numbers(text))) == count


def _report(folder: str | None) -> str:
    if folder is None:
        import pprint

        return f"ALLOWED = {pprint.pformat(counts(), width=100)}"
    rows = [each for each in faults() if each.folder == folder]
    return "\n".join(f"{each.place}: {each.rule}: {each.text}" for each in rows)


if __name__ == "__main__":
    sys.stdout.write(_report(sys.argv[1] if len(sys.argv) > 1 else None) + "\n")
