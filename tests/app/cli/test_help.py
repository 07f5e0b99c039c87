"""The help of the command line."""

from __future__ import annotations

from collections.abc import Iterator

import click
import pytest
from click.testing import CliRunner

from app.cli.commands import command_of
from app.cli.main import LAST_SECTION, SECTIONS, SERVICE, Commands, main
from app.operations.registry import commands, operations
from tests.app.operations.test_registry import ASKING

NAMES_SO_FAR = frozenset(
    """
    atlas backup bend bias biaxial border calibrate characterise compare curl curve doctor drape
    estimate export extensions fill find fit garment glove hang hysteresis import limb materials
    measure overhang piece predict pressure relax restore rs serve shape stretch sweep token
    trellis tube warm-up whole
    """.split()  # noqa: SIM905 - names are easier to read than strings
)


def every_command(
    group: click.Command = main, path: tuple[str, ...] = ()
) -> Iterator[tuple[str, click.Command]]:
    """All commands with the words that call them."""
    if not isinstance(group, click.Group):
        yield " ".join(path), group
        return
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        yield from every_command(command, (*path, name))


EVERY = dict(every_command())


def test_the_help_has_sections_and_every_command_is_in_one() -> None:
    text = CliRunner().invoke(main, ["--help"]).output
    titles = [line.removesuffix(":") for line in text.splitlines() if line[:1].isalpha()]
    assert [title for title in titles if title in SECTIONS] == list(SECTIONS)
    assert LAST_SECTION not in titles
    listed = [name for names in SECTIONS.values() for name in names]
    assert len(listed) == len(set(listed))
    assert {*commands(), *SERVICE, "measure"} == set(listed)


def test_names_of_commands_stay() -> None:
    assert {words.partition(" ")[0] for words in EVERY} >= NAMES_SO_FAR


def test_a_command_that_no_section_names_comes_last(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(SECTIONS, "Files", ("import",))
    assert isinstance(main, Commands)
    sections = main.sections(click.Context(main))
    assert list(sections)[-1] == LAST_SECTION
    assert sections[LAST_SECTION] == ["export"]


def test_the_line_of_each_command_is_whole_and_begins_with_a_verb() -> None:
    text = CliRunner().invoke(main, ["--help"], terminal_width=80).output
    rows = [line.split(maxsplit=1) for line in text.splitlines() if line.startswith("  ")]
    lines = {name: line for name, line in rows if name in NAMES_SO_FAR}
    assert set(lines) == NAMES_SO_FAR
    for name, line in lines.items():
        assert line.endswith("."), name
        assert not line.endswith("..."), name
        assert line.split()[0] not in {"A", "How", "The", "What", "Who"}, name


@pytest.mark.parametrize("words", sorted(EVERY))
def test_every_command_takes_json(words: str) -> None:
    assert "--json" in {name for option in EVERY[words].params for name in option.opts}


@pytest.mark.parametrize("words", sorted(EVERY))
def test_defaults_are_shown_as_they_are(words: str) -> None:
    context = click.Context(EVERY[words], info_name=words)
    assert "[default: (" not in EVERY[words].get_help(context)


def test_a_default_is_shown_with_its_option() -> None:
    relax = EVERY["relax"].get_help(click.Context(EVERY["relax"]))
    assert "[default: published]" in " ".join(relax.split())
    asking = command_of(ASKING, "ask")
    assert "[default: 3]" in asking.get_help(click.Context(asking))


def test_options_follow_the_fields_of_every_request() -> None:
    for operation in operations().values():
        if operation.command is not None:
            options = [n for p in command_of(operation, "a").params for n in p.opts]
            assert len(options) == len(set(options)), operation.name
