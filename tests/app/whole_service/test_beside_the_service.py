"""Every command of the command line beside a service at work: nothing is lost by it.

A process that closes an SQLite file and takes itself for the last one removes the log in which the
newest changes are. It may do so only if no service has the file open.
"""

import gzip
import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from app.cli.main import main
from app.service.designs.store import DesignStore
from tests.app.cli.test_main import EVERY
from tests.app.clients import bearing
from tests.app.databases import is_whole, opened
from tests.app.painter import Painter, painting, until_painted
from tests.app.running import Service, knitcore, python, wait_until

PAINTERS = 3
PREDICT = "predict"
"""In the place of all operations: none of them opens the database."""
REFUSED = {"serve": "another service", "restore": "already"}
"""Commands that must not succeed beside a service, and what they say."""
ELSEWHERE = """
import sqlite3, sys
connection = sqlite3.connect(sys.argv[1])
connection.execute("SELECT * FROM designs").fetchone()
connection.close()
"""
"""Another program that opens and closes the file."""


def arguments_of(folder: Path, token: str) -> dict[str, list[str]]:
    """Arguments of each command; a command that is not here fails the test."""
    return {
        "token create": ["bob"],
        "token list": [],
        "token revoke": [token],
        "backup": [str(folder / "backup.gz")],
        "doctor": [],
        PREDICT: ["seed", "--size", "4x4", "--material", "acrylic"],
        "restore": [str(folder / "backup.gz")],
        "serve": ["--port", "0"],
        "warm-up": ["--help"],  # does not touch the data, and takes a minute
    }


def _run(service: Service, *words: str) -> tuple[int, str, str]:
    """Exit code and words of a command: of one that ends here as elsewhere, without a start."""
    if words[0] in {*REFUSED, "backup"}:
        done = knitcore(*words, env=service.environment)
        return done.returncode, done.stdout, done.stderr
    own = {name: v for name, v in service.environment.items() if name.startswith("KNITCORE_")}
    result = CliRunner().invoke(main, words, env=own)
    return result.exit_code, result.stdout, result.stderr


def _made(service: Service, user: str) -> dict[str, str]:
    code, words, problem = _run(service, "token", "create", user, "--json")
    assert code == 0, problem
    made: dict[str, str] = json.loads(words)
    return made


def _revisions(backup: Path) -> dict[str, int]:
    with gzip.open(backup, "rt") as lines:
        rows = [json.loads(line) for line in lines]
    return {r["row"]["id"]: r["row"]["revision"] for r in rows if r.get("table") == "designs"}


@pytest.mark.slow
def test_commands_beside_the_service_lose_nothing(tmp_path: Path) -> None:
    service = Service(tmp_path, require_login="true", requests_per_s="100000")
    file = tmp_path / "data" / "knitcore.sqlite3"
    log = file.with_name(f"{file.name}-wal")
    with service.running() as client:
        ada = _made(service, "ada")
        client.headers.update(bearing(ada["token"]))
        painters = [Painter.with_a_design(client, n) for n in range(PAINTERS)]
        leaver = _made(service, "leaver")
        assert client.get("/api/v1/designs", headers=bearing(leaver["token"])).is_success
        ours = log.stat().st_ino
        given = arguments_of(tmp_path, leaver["id"])
        own = {words for words in EVERY if main.entries[words.split()[0]][0].startswith(".")}
        assert {*own, PREDICT} == set(given), "a new command: say what it is given"
        with painting(service.url, painters):
            for name, arguments in given.items():
                before = {p.design: p.acknowledged for p in painters}
                code, words, problem = _run(service, *name.split(), *arguments)
                refusal = REFUSED.get(name)
                assert (code == 0) is (refusal is None), f"{name}: {words}{problem}"
                assert refusal is None or refusal in problem
                assert log.stat().st_ino == ours, name
                if name == "backup":
                    saved = _revisions(tmp_path / "backup.gz")
                    assert all(saved[d] >= revision for d, revision in before.items())
            python("-c", ELSEWHERE, file)
            assert log.stat().st_ino == ours
            left = bearing(leaver["token"])
            wait_until(lambda: client.get("/api/v1/designs", headers=left).status_code == 401)
            late = _made(service, "late")
            assert client.get("/api/v1/designs", headers=bearing(late["token"])).is_success
            assert client.get("/readyz").status_code == 200
            until_painted(painters, sum(p.acknowledged for p in painters) + PAINTERS)
            service.kill()
    assert is_whole(file)
    with opened(tmp_path / "data", migrated=False) as database:
        for painter in painters:
            kept = DesignStore(database).get("ada", painter.design)
            painter.check(kept.revision, kept.document.chart)
