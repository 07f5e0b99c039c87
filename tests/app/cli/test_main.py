"""The help of the command line."""

import click
import pytest
from click.testing import CliRunner

from app.cli.commands import command_of
from app.cli.main import SECTIONS, main
from app.operations.registry import operations
from scripts.site import every_command
from tests.app.operations.test_registry import ECHOING
from tests.app.running import python

NAMES_SO_FAR = frozenset(
    """
    atlas backup bend bias biaxial border calibrate characterise compare curl curve doctor drape
    estimate export extensions fill find fit garment glove hang hysteresis import limb materials
    measure overhang piece predict pressure relax restore rs serve shape stretch sweep token
    trellis tube warm-up whole
    """.split()  # noqa: SIM905 - names are easier to read than strings
)


EVERY = dict(every_command(main, click.Context(main)))


def test_the_help_has_sections_and_every_command_is_in_one() -> None:
    text = CliRunner().invoke(main, ["--help"]).output
    titles = [line.removesuffix(":") for line in text.splitlines() if line[:1].isalpha()]
    assert [title for title in titles if title in SECTIONS] == list(SECTIONS)
    listed = {words.split()[-1].replace("-", "_") for words in EVERY}
    assert {name for name, of in operations().items() if of.command is not None} <= listed
    assert len(main.list_commands(click.Context(main))) == sum(map(len, SECTIONS.values()))


def test_names_of_commands_stay() -> None:
    assert {words.partition(" ")[0] for words in EVERY} >= NAMES_SO_FAR


@pytest.mark.parametrize(
    ("words", "loaded", "absent"),
    [
        (["--help"], set(), {"app.context", "fastapi", "scipy"}),
        (["rs", "--help"], {"yarn", "yarn.rs"}, {"fastapi"}),
    ],
)
def test_the_help_loads_no_other_operation(
    words: list[str], loaded: set[str], absent: set[str]
) -> None:
    code = (
        "import atexit, sys; from app.cli.main import main;"
        "atexit.register(lambda: print(*sys.modules, sep='\\n')); main(sys.argv[1:])"
    )
    modules = set(python("-c", code, *words).stdout.splitlines())
    subjects = {m.removeprefix("app.operations.") for m in modules if "app.operations." in m}
    assert subjects - {"perform", "registry"} == loaded
    assert not modules & absent


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
    asking = command_of(ECHOING, "ask")
    assert "[default: 3]" in asking.get_help(click.Context(asking))


def test_options_follow_the_fields_of_every_request() -> None:
    for operation in operations().values():
        if operation.command is not None:
            options = [n for p in command_of(operation, "a").params for n in p.opts]
            assert len(options) == len(set(options)), operation.name
