"""Every Python example in the documentation runs, page by page, top to bottom.

A section with measured numbers names what makes them: its example, a program, or an invisible line
``<!-- from: tests/test_x.py::test_name, studies/x.py, knitcore/x.py::NAME, paper Table 5 -->``.
"""

import ast
import contextlib
import importlib.util
import io
import json
import pkgutil
import re
import shlex
import tomllib
from collections.abc import Iterable
from functools import cache
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from click.testing import CliRunner
from fastapi.testclient import TestClient
from httpx2 import Response

from app.cli.main import main
from app.service.main import create_app
from app.service.settings import Settings
from knitcore.base.extensions import Group

ROOT = Path(__file__).resolve().parent.parent
PAGES = sorted([*ROOT.glob("docs/**/*.md"), ROOT / "README.md"])
MORE_PAGES = [
    *(ROOT / name for name in ("CHANGELOG.md", "CONTRIBUTING.md", "frontend/README.md")),
    *ROOT.glob("examples/*/README.md"),
]
NOTEBOOKS = ROOT / "docs" / "notebooks"
"""Pages that the site runs when it is built."""
LONG = ("fit-a-law.md", "inverse-design.md")
"""Pages whose examples take seconds."""
MADE = (ROOT / "docs" / "reference", ROOT / "docs" / "gallery.md")
"""Pages of the site that are made from code; the strict build checks links to them."""
FENCE = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SHELL = re.compile(r"^```sh\n(.*?)^```$", re.MULTILINE | re.DOTALL)

ROOMS = "app|deploy|docs|examples|frontend|knitcore|scripts|studies|tests"
PATH = re.compile(rf"`((?:[\w.-]+/)*[\w.-]+\.(?:js|mjs|py)|(?:[\w.-]+/)+|(?:{ROOMS})/[\w./-]+)`")
"""A program, a folder with its slash, or a path that begins in one of our folders."""
DOTTED = re.compile(r"`((?:knitcore|app|scripts|studies)(?:\.\w+)+)`")
BUILT = {"frontend/dist"}
"""Folders that are made."""
MOST_WORDS = 35_000


def _id(page: Path) -> str:
    return str(page.relative_to(ROOT))


def _with_examples(page: Path) -> object:
    marks = [pytest.mark.slow] if page.name in LONG else []
    return pytest.param(page, marks=marks, id=_id(page))


@pytest.mark.parametrize(
    "page",
    [_with_examples(p) for p in PAGES if p.parent != NOTEBOOKS and FENCE.search(p.read_text())],
)
def test_examples_run(page: Path) -> None:
    _printed(page)


@cache
def _printed(page: Path) -> dict[str, str]:
    """Run the examples of a page, and keep what each of them prints."""
    printed = {}
    namespace: dict[str, object] = {"__name__": "example"}
    with TemporaryDirectory() as folder, contextlib.chdir(folder):
        for block in FENCE.findall(page.read_text()):
            with contextlib.redirect_stdout(io.StringIO()) as output:
                exec(compile(block, _id(page), "exec"), namespace)  # noqa: S102 - our own pages
            printed[block] = output.getvalue()
    return printed


MEASURED = re.compile(r"(?<![\w.,/])(?:\d+\.\d+(?![\w.]*\d)|\d[\d,]*(?= ?%| m?s(?!\w)))")
"""A decimal, a pair of them such as 1.05/1.19, a percentage or a time."""
NUMERAL = re.compile(r"(?<![\w.])\d+(?:,\d{3})*(?:\.\d+)?(?:e-?\d+)?")
UNMEASURED = re.compile(
    r"^```.*?^```$|^ {4}.*?$|`[^`]*`|<!--.*?-->|\$\$.*?\$\$|\$[^$\n]*\$|(?<=\])\([^)]*\)"
    r"|(?:Python|WCAG|CC BY|arXiv) \d[\d.]*",
    re.MULTILINE | re.DOTALL,
)
"""Code, formulas, addresses, and numbers of versions."""
SECTION = re.compile(r"^```.*?^```$|^#+ ", re.MULTILINE | re.DOTALL)
SENTENCE = re.compile(r"(?<=[.|])\s+|\n\n|^```.*?^```$", re.MULTILINE | re.DOTALL)
MAKERS = re.compile(r"<!-- from: (.*?) -->", re.DOTALL)
PROGRAM = re.compile(r"`(make [a-z-]+|python -m (?:scripts|studies)[\w.]*)")
WRITTEN = {"docs/evidence.md": "studies.evidence"}
"""Pages that a program writes, and names."""
UNTRACED = 2
"""Largest number of numbers in a section without a maker."""


def _sections(text: str) -> list[str]:
    """Split a page at its headings, which comments in code are not."""
    starts = [head.start() for head in SECTION.finditer(text) if head[0].startswith("#")]
    return [text[begin:end] for begin, end in pairwise([0, *starts, len(text)])]


def _values(text: str) -> set[float]:
    """Numbers of an example or of its output, also as percentages."""
    values = {float(numeral.replace(",", "")) for numeral in NUMERAL.findall(text)}
    return values | {round(100 * value, 9) for value in values}


def _about_evidence(text: str) -> list[str]:
    """Sentences, and rows of tables, that refer to the page of evidence."""
    return [sentence for sentence in SENTENCE.split(text) if "evidence.md" in sentence]


def _untraced(section: str, page: Path) -> list[str]:
    """Measured numbers of a section that neither its examples nor the evidence hold."""
    for sentence in _about_evidence(section):
        section = section.replace(sentence, "")
    held = _values("".join(FENCE.findall(section)))
    numbers = [number.replace(",", "") for number in MEASURED.findall(UNMEASURED.sub("", section))]
    left = [number for number in numbers if float(number) not in held]
    if len(left) > UNTRACED and page.parent != NOTEBOOKS:
        held = _values("".join(_printed(page)[block] for block in FENCE.findall(section)))
    return [number for number in left if float(number) not in held]


@pytest.mark.parametrize("page", PAGES, ids=_id)
def test_measured_numbers_have_a_maker(page: Path) -> None:
    if program := WRITTEN.get(_id(page)):
        assert f"python -m {program}" in page.read_text()
        return
    without = {
        section.partition("\n")[0]: untraced
        for section in _sections(page.read_text())
        if not MAKERS.search(section) and not PROGRAM.search(section)
        if len(untraced := _untraced(section, page)) > UNTRACED
    }
    assert not without


def _tests_of(path: Path) -> set[str]:
    nodes = ast.walk(ast.parse(path.read_text()))
    return {node.name for node in nodes if isinstance(node, ast.FunctionDef)}


def _makes(maker: str, section: str) -> bool:
    """Return whether a maker exists and, if it is a constant, is the number in the section."""
    path, _, name = maker.partition("::")
    if re.fullmatch(r"paper (?:Fig\.|Note|Table) \w+", maker):
        return True
    if maker.startswith(("knitcore ", "make ", "python ")):
        return not _missing([maker])
    if not (ROOT / path).is_file():
        return False
    if name.startswith("test_"):
        return name in _tests_of(ROOT / path)
    if not name:
        return "__main__" in (ROOT / path).read_text()
    constant = pkgutil.resolve_name(f"{path.removesuffix('.py').replace('/', '.')}:{name}")
    values = {constant, round(100 * constant, 9)} if isinstance(constant, int | float) else set()
    return not values or bool(values & _values(UNMEASURED.sub("", section)))


@pytest.mark.parametrize("page", PAGES, ids=_id)
def test_makers_of_numbers_exist(page: Path) -> None:
    for section in _sections(page.read_text()):
        makers = [maker.strip() for line in MAKERS.findall(section) for maker in line.split(",")]
        assert not [maker for maker in makers if not _makes(maker, section)]


@pytest.mark.parametrize("page", PAGES, ids=_id)
def test_numbers_of_the_evidence_are_its_numbers(page: Path) -> None:
    evidence = set(NUMERAL.findall((ROOT / "docs" / "evidence.md").read_text()))
    for sentence in _about_evidence(page.read_text()):
        numbers = MEASURED.findall(UNMEASURED.sub("", sentence))
        missing = {number for number in numbers if "." in number} - evidence
        assert not missing, sentence


@pytest.mark.parametrize("page", PAGES, ids=_id)
def test_links_between_pages_lead_somewhere(page: Path) -> None:
    targets = re.findall(r"\]\(((?!https?:|mailto:|#)[^)#\s]+)", page.read_text())
    places = [(page.parent / target).resolve() for target in targets]
    assert not [to for to in places if not to.exists() and not {to, *to.parents} & {*MADE}]


def test_pages_show_every_picture() -> None:
    shown = "".join(page.read_text() for page in PAGES)
    pictures = [*ROOT.glob("docs/images/*"), *ROOT.glob("docs/figures/*")]
    assert not [picture.name for picture in pictures if picture.name not in shown]


def test_the_docs_are_no_longer_than_a_person_reads() -> None:
    words = sum(len(page.read_text().split()) for page in ROOT.glob("docs/*.md"))
    assert words <= MOST_WORDS


@pytest.mark.parametrize("page", [*PAGES, *MORE_PAGES], ids=_id)
def test_files_folders_and_modules_that_pages_name_exist(page: Path) -> None:
    text = page.read_text()
    homes = (ROOT, page.parent)
    paths = set(PATH.findall(text)) - BUILT
    assert not {path for path in paths if not any((home / path).exists() for home in homes)}
    for name in set(DOTTED.findall(text)) - set(map(str, Group)):
        assert pkgutil.resolve_name(name) is not None


def test_the_files_that_mutation_tests_change_and_run_exist() -> None:
    mutmut = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["mutmut"]
    for name in mutmut["only_mutate"] + mutmut["pytest_add_cli_args_test_selection"]:
        assert list(ROOT.glob(name)), name


def _send(client: TestClient, command: str) -> Response:
    """Send what a `curl` command of the page would send."""
    words = shlex.split(command, comments=True)
    headers: dict[str, str] = {}
    method: str | None = None
    body: str | None = None
    for option, value in pairwise(words):
        if option == "-H":
            name, _, content = value.partition(": ")
            headers[name] = content
        elif option == "-X":
            method = value
        elif option == "-d":
            body = value
    (address,) = (word for word in words if word.startswith("/api/"))
    return client.request(
        method or ("GET" if body is None else "POST"), address, headers=headers, content=body
    )


SHOWN = re.compile(r"^(curl .*?)(?=^curl |^```$)|^```json\n(.*?)^```$", re.MULTILINE | re.DOTALL)
"""A request of the quickstart, or the response to it."""


def test_the_requests_of_the_quickstart_get_the_responses_that_it_shows(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "http.md").read_text().replace("\\\n", " ")
    responses: list[Response] = []
    app = create_app(Settings(data_dir=tmp_path))
    with TestClient(app, base_url="http://127.0.0.1") as client:
        job = ""
        for command, response in SHOWN.findall(text.replace("$API", "/api/v1")):
            if response:
                _compare(json.loads(response), responses[-1].json())
                continue
            responses.append(_send(client, command.replace("JOB", job)))
            accepted = {200, 202, 204, 409} if "/jobs/" in command else {200, 202}
            status = responses[-1].status_code
            assert status in ({422} if "acryllic" in command else accepted), command
            job = responses[-1].headers.get("location", job).rsplit("/", 1)[-1]
    assert len(responses) >= 8


def _compare(shown: dict[str, Any], answered: dict[str, Any]) -> None:
    """Compare fields that a page shows with the response; dots stand for what it leaves out."""
    for name, value in shown.items():
        if name == "…" or value == ["…"]:
            continue
        if isinstance(value, str):
            assert answered[name].startswith(value.rstrip("…")), name
        else:
            assert answered[name] == pytest.approx(value, rel=5e-3), name


@cache
def _help(*command: str) -> str:
    return CliRunner().invoke(main, [*command, "--help"]).output


def _missing(commands: Iterable[str]) -> list[str]:
    """Commands, targets and programs that do not exist, or lack an option that is named."""
    targets = re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
    missing = []
    for command in commands:
        words = shlex.split(command, comments=True)
        if words[0] == "make":
            exists = words[1] in targets
        elif words[:2] == ["python", "-m"]:
            exists = importlib.util.find_spec(words[2]) is not None
        else:
            path = [word for word in words[1:3] if re.fullmatch(r"[a-z-]+", word)]
            shown = _help(*path[: 2 if path[0] in {"measure", "token"} else 1])
            options = [word for word in words if word.startswith("--")]
            exists = "Usage" in shown and all(option in shown for option in options)
        missing += [] if exists else [command]
    return missing


@pytest.mark.parametrize("page", [*PAGES, *MORE_PAGES], ids=_id)
def test_commands_and_their_options_exist(page: Path) -> None:
    text = page.read_text().replace("\\\n", " ")
    lines = "\n".join(SHELL.findall(text)).splitlines()
    commands = [line for line in lines if line.startswith(("knitcore ", "make ", "python -m "))]
    assert not _missing([*commands, *PROGRAM.findall(text)])
