"""Every Python example in the documentation runs, page by page, top to bottom."""

import pkgutil
import re
import shlex
import tomllib
from itertools import pairwise
from pathlib import Path

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
MADE = (ROOT / "docs" / "reference", ROOT / "docs" / "gallery.md")
"""Pages of the site that are made from code; the strict build checks links to them."""
FENCE = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SHELL = re.compile(r"^```sh\n(.*?)^```$", re.MULTILINE | re.DOTALL)

ROOMS = "app|client|deploy|docs|examples|frontend|knitcore|scripts|studies|tests"
PATH = re.compile(rf"`((?:[\w.-]+/)*[\w.-]+\.(?:js|mjs|py)|(?:[\w.-]+/)+|(?:{ROOMS})/[\w./-]+)`")
"""A program, a folder with its slash, or a path that begins in one of our folders."""
DOTTED = re.compile(r"`((?:knitcore|app|scripts|studies)(?:\.\w+)+)`")
BUILT = {"frontend/dist"}
"""Folders that are made."""


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


def test_the_requests_of_the_quickstart_run(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "http.md").read_text().replace("\\\n", " ")
    commands = [
        command.replace("$API", "/api/v1")
        for block in SHELL.findall(text)
        for command in re.split(r"^(?=curl )", block, flags=re.MULTILINE)
        if command.startswith("curl ")
    ]
    assert len(commands) >= 8
    app = create_app(Settings(data_dir=tmp_path))
    with TestClient(app, base_url="http://127.0.0.1") as client:
        job = ""
        for command in commands:
            response = _send(client, command.replace("JOB", job))
            accepted = {200, 202, 204, 409} if "/jobs/" in command else {200, 202}
            assert response.status_code in ({422} if "acryllic" in command else accepted), command
            job = response.headers.get("location", job).rsplit("/", 1)[-1]


@pytest.mark.parametrize("page", PAGES, ids=_id)
def test_commands_and_their_options_exist(page: Path) -> None:
    text = "\n".join(SHELL.findall(page.read_text().replace("\\\n", " ")))
    for line in text.splitlines():
        if not line.startswith("knitcore "):
            continue
        words = shlex.split(line, comments=True)
        options = [word for word in words if word.startswith("--")]
        path = [word for word in words[1:3] if re.fullmatch(r"[a-z-]+", word)]
        group = path[:2] if path[0] in {"measure", "token"} else path[:1]
        shown = CliRunner().invoke(main, [*group, "--help"]).output
        assert "Usage" in shown
        assert [option for option in options if option not in shown] == [], line
