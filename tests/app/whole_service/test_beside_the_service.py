"""Every command of the command line beside a service at work: nothing is lost by it.

A process that closes an SQLite file and takes itself for the last one removes the log in which the
newest changes are. It may do so only if no service has the file open.
"""

import contextlib
import gzip
import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import click
import httpx2 as httpx

from app.cli.main import Commands, main
from app.service.designs.store import DesignStore
from app.service.store.database import Database
from tests.app.clients import bearing
from tests.app.painter import Painter, painting, until_painted
from tests.app.running import Service, wait_until
from tests.app.terminal import Terminal, terminal

PAINTERS = 3
PREDICT = "predict"
"""In the place of all operations: none of them opens the database."""
REFUSED = {"serve": "another service", "restore": "already"}
"""Commands that must not succeed beside a service, and what they say."""


def own_commands(group: click.Command = main, path: tuple[str, ...] = ()) -> Iterator[str]:
    """All commands that are no operation, with their groups."""
    if not isinstance(group, click.Group):
        yield " ".join(path)
        return
    context = click.Context(group)
    for name in group.list_commands(context):
        if not isinstance(group, Commands) or group.entries[name][0].startswith("."):
            command = group.get_command(context, name)
            assert command is not None
            yield from own_commands(command, (*path, name))


def arguments_of(folder: Path, token: str) -> dict[str, list[str]]:
    """What each command is given; one that is not here fails the test."""
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


def _elsewhere(file: Path) -> None:
    """Another program opens and closes the file."""
    code = (
        "import sqlite3, sys; c = sqlite3.connect(sys.argv[1])\n"
        "c.execute('SELECT * FROM designs').fetchone(); c.close()"
    )
    subprocess.run([sys.executable, "-c", code, str(file)], check=True, timeout=120)


def _until_refused(client: httpx.Client, token: str) -> None:
    wait_until(lambda: client.get("/api/v1/designs", headers=bearing(token)).status_code == 401)


def _made(shell: Terminal, user: str) -> dict[str, str]:
    code, out, err = shell.run("token", "create", user, "--json")
    assert code == 0, err
    made: dict[str, str] = json.loads(out)
    return made


def _revisions(backup: Path) -> dict[str, int]:
    with gzip.open(backup, "rt") as lines:
        rows = [json.loads(line) for line in lines]
    return {r["row"]["id"]: r["row"]["revision"] for r in rows if r.get("table") == "designs"}


def test_commands_beside_the_service_lose_nothing(tmp_path: Path) -> None:
    service = Service(tmp_path, require_login="true", requests_per_s="100000")
    file = tmp_path / "data" / "knitcore.sqlite3"
    log = file.with_name(f"{file.name}-wal")
    with terminal(service.environment) as shell:
        client = service.start()
        try:
            ada = _made(shell, "ada")
            client.headers.update(bearing(ada["token"]))
            painters = [Painter.with_a_design(client, n) for n in range(PAINTERS)]
            leaver = _made(shell, "leaver")
            assert client.get("/api/v1/designs", headers=bearing(leaver["token"])).is_success
            ours = log.stat().st_ino
            given = arguments_of(tmp_path, leaver["id"])
            assert {*own_commands(), PREDICT} == set(given), "a new command: say what it is given"
            with painting(service.url, painters):
                for name, arguments in given.items():
                    before = {p.design: p.acknowledged for p in painters}
                    code, out, err = shell.run(*name.split(), *arguments)
                    told = REFUSED.get(name)
                    assert (code == 0) is (told is None), f"{name}: {out} {err}"
                    assert told is None or told in err
                    assert log.stat().st_ino == ours, name
                    if name == "backup":
                        saved = _revisions(tmp_path / "backup.gz")
                        assert all(saved[d] >= revision for d, revision in before.items())
                _elsewhere(file)
                assert log.stat().st_ino == ours
                _until_refused(client, leaver["token"])
                late = _made(shell, "late")
                assert client.get("/api/v1/designs", headers=bearing(late["token"])).is_success
                assert client.get("/readyz").status_code == 200
                until_painted(painters, sum(p.acknowledged for p in painters) + PAINTERS)
                service.kill()
            with contextlib.closing(Database(f"sqlite:///{file}")) as database:
                with database.read() as connection:
                    whole = connection.exec_driver_sql("PRAGMA integrity_check").scalar()
                assert whole == "ok"
                for painter in painters:
                    kept = DesignStore(database).get("ada", painter.design)
                    painter.check(kept.revision, kept.document.chart)
        finally:
            client.close()
            service.kill()
