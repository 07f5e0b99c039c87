"""Tests of the page wait for what they expect: a busy machine shows it later."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

BROWSER = Path(__file__).parent / "browser"
AT_THE_MOMENT = frozenset(
    {
        "all_inner_texts", "all_text_contents", "get_attribute", "inner_html", "inner_text",
        "input_value", "is_checked", "is_disabled", "is_editable", "is_enabled", "is_hidden",
        "is_visible", "text_content",
    }
)  # fmt: skip
"""Methods of Playwright that do not wait; each has its `expect(…)`, which waits."""


@cache
def trees() -> tuple[tuple[Path, ast.Module], ...]:
    return tuple((file, ast.parse(file.read_text("utf-8"))) for file in BROWSER.rglob("*.py"))


def called(tree: ast.AST) -> Iterator[str]:
    """Names of the functions and methods called in code; `count` only as of a locator."""
    for node in ast.walk(tree):
        match node:
            case ast.Call(func=ast.Attribute(attr="count"), args=[]):
                yield "inner_text"
            case ast.Call(func=ast.Attribute(attr=name) | ast.Name(id=name)):
                yield name


def readers() -> frozenset[str]:
    """Names of our own functions that read the page without waiting."""
    functions = (
        node for _, tree in trees() for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)
    )
    names = {function.name: set(called(function)) for function in functions}
    return frozenset(
        name
        for name, calls in names.items()
        if not name.startswith("test_")
        and calls & AT_THE_MOMENT
        and not any(call.startswith(("expect", "wait_for")) for call in calls)
    )


def momentary(code: ast.AST, read: frozenset[str]) -> list[int]:
    """Lines of assertions about what the page shows at the moment."""
    return [
        node.lineno
        for node in ast.walk(code)
        if isinstance(node, ast.Assert) and read & set(called(node.test))
    ]


def test_nothing_is_asserted_of_the_moment() -> None:
    read = AT_THE_MOMENT | readers()
    assert "number" in read
    faults = [f"{file.name}:{line}" for file, tree in trees() for line in momentary(tree, read)]
    assert faults == []


@pytest.mark.parametrize(
    ("line", "is_fault"),
    [
        ("assert not page.locator('.part').count()", True),
        ("assert part.inner_text() == 'Cuff'", True),
        ("assert number(page, '#width') < 2", True),
        ("assert chart.count('P') == 2", False),
        ("expect(part).to_have_text('Cuff')", False),
    ],
)
def test_assertions_of_the_moment_are_seen(line: str, is_fault: bool) -> None:
    assert bool(momentary(ast.parse(line), AT_THE_MOMENT | {"number"})) == is_fault
