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
FRAGMENT = re.compile(
    r"(Of|So|As|Those|That|What|Which|Whether|With|The same (of|for|where|on|with|within))\b"
)
"""Beginnings of docstrings that do not stand alone."""
BARE_NUMBER = re.compile(r"(?<![\w.)\]}/*:-])[-−]?\.\d")
"""A number without the zero before its point."""
CODE = re.compile(r"^```.*?^```$|``.*?``|`[^`\n]*`", re.MULTILINE | re.DOTALL)
"""Parts of prose that are not prose."""
DOCTEST = re.compile(r"^ *>>> .*(?:\n *\S.*)*", re.MULTILINE)
_LIST = r"((?:[^()]|\([^()]*\))*)"
PAGE_NAMES = re.compile(
    rf"\b(?:const|let|var)\s+([\w$]+(?:,\s*[\w$]+)*|[{{[][^;]*?[}}\]](?=\s*(?:=(?![=>])|of\b)))"
    rf"|\({_LIST}\)\s*=>"
    rf"|(?:[\w$]|\bfunction\*? |\bcatch )\({_LIST}\) \{{"
)
"""Declared names in the page's code, and parameters: of arrow functions, of other functions."""
PAGE_VAGUE = re.compile(rf"(?<![\w$-])(?<![^.]\.)({'|'.join(sorted(VAGUE))})(?![\w$-]|\s*[:(.\[])")
"""A vague name among such names, not the name of a field."""
PAGE_PARAMETER = re.compile(rf"@param \{{.*?\}} \[?({'|'.join(sorted(VAGUE))})\b")
"""The description of a parameter with a vague name."""
PAGE_PROSE = re.compile(r"/\*.*?\*/|(?<![:\\])//[^\n]*|\"(?:[^\"\\\n]|\\.)*\"", re.DOTALL)
"""Comments and strings of the page's code."""

NAMES: dict[type[ast.AST], str] = {
    ast.Name: "id", ast.Attribute: "attr", ast.arg: "arg", ast.FunctionDef: "name",
    ast.AsyncFunctionDef: "name", ast.ClassDef: "name",
}  # fmt: skip
"""Nodes that make a name, and their field for it."""

ALLOWED: dict[str, dict[str, int]] = {}
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
    for top in ("knitcore", "app", "scripts", "studies", "tests"):
        for file in sorted((ROOT / top).rglob("*.py")):
            every += faults_of_code(file)
    for file in page_files():
        lines = vague_page_names(file.read_text(encoding="utf-8"))
        every += (fault("names", file, line, name) for line, name in lines)
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
        if (name := bound_name(node)).strip("_") in VAGUE:
            yield fault("names", file, node.lineno, name)  # type: ignore[attr-defined]
        for string in docstrings(node):
            text = str(string.value)
            if FRAGMENT.match(text.lstrip()):
                yield fault("docstrings", file, string.lineno, text.strip().partition("\n")[0])
            prose = blanked(CODE, blanked(DOCTEST, text))
            for line, what in bare_numbers(prose):
                yield fault("numbers", file, string.lineno + line - 1, what)


def bound_name(node: ast.AST) -> str:
    """The name of the variable, parameter, attribute, function or class that a node makes."""
    if isinstance(getattr(node, "ctx", None), ast.Load):
        return ""
    return str(getattr(node, NAMES.get(type(node), ""), ""))


def page_files() -> Iterator[Path]:
    """The page's code, tests included, without what is installed or built."""
    page = ROOT / "frontend"
    yield from sorted(page.glob("*.js"))
    for folder in sorted(page.iterdir()):
        if folder.is_dir() and folder.name not in {"node_modules", "dist"}:
            yield from sorted(folder.rglob("*.js"))


def vague_page_names(text: str) -> Iterator[tuple[int, str]]:
    """Lines and names of the vague variables and parameters in JavaScript."""
    for match in PAGE_PARAMETER.finditer(text):
        yield text.count("\n", 0, match.start()) + 1, match[1]
    code = blanked(PAGE_PROSE, text)
    for declared in PAGE_NAMES.finditer(code):
        for name in PAGE_VAGUE.finditer(code, *declared.span(declared.lastindex or 0)):
            yield code.count("\n", 0, name.start()) + 1, name[1]


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


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("const found = 1;\nlet low, told;\nfor (const one of ones) {}", ["found", "told", "one"]),
        ("const { a = 1, found, asked: b, c: told } = one; [one] = found;", ["found", "told"]),
        ("const [a,\n  wanted] = pairs.map(([one, two]) => one);", ["wanted", "one"]),
        ("set(a, ...told) { if (found) { tell(one); } }", ["told"]),
        ("function* of(a, asked = f()) {}\ntry {} catch (wanted) {}", ["asked", "wanted"]),
        ("/** @param {{a: 1}} one @param {B} [told] */\nlet b = c.found;", ["one", "told"]),
        ('say("let one (one) => 1"); // const found\nlet a = { found, one: 1 };', []),
    ],
)
def test_vague_names_in_the_page_are_seen(text: str, names: list[str]) -> None:
    assert [name for _, name in vague_page_names(text)] == names


def _report(folder: str | None) -> str:
    if folder is None:
        import pprint

        return f"ALLOWED = {pprint.pformat(counts(), width=100)}"
    rows = [each for each in faults() if each.folder == folder]
    return "\n".join(f"{each.place}: {each.rule}: {each.text}" for each in rows)


if __name__ == "__main__":
    sys.stdout.write(_report(sys.argv[1] if len(sys.argv) > 1 else None) + "\n")
