"""The composition of compose.yaml on a machine without containers, until Ctrl+C.

    python -m scripts.composition [--folder FOLDER] [--port 8737]

Starts nginx, the service, PostgreSQL, a Dask scheduler and its workers on loopback, with the
commands, settings and secrets of compose.yaml and the configuration of deploy/nginx.conf. Needs
Debian's nginx-light and postgresql. Data and logs are in the folder, which is kept if it is given.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import re
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml

from scripts.serving import Service

ROOT = Path(__file__).resolve().parent.parent
COMPOSE: dict[str, Any] = yaml.safe_load((ROOT / "compose.yaml").read_text(encoding="utf-8"))
PATHS = f"/usr/sbin:/usr/local/sbin:{os.environ.get('PATH', '/usr/bin:/bin')}"
PATIENCE_S = 150.0
DATABASE = "knitcore"


def missing() -> list[str]:
    """Packages of Debian that the composition needs and this machine lacks."""
    needed = {"nginx-light": nginx(), "postgresql": postgres_programs()}
    return [package for package, program in needed.items() if program is None]


class Composition:
    """The programs that run, and how to reach them.

    Attributes
    ----------
    url : of the proxy.
    service : behind it.
    folder : of data, secrets and logs.
    """

    def __init__(self, folder: Path, url: str, service: Service) -> None:
        self.folder, self.url, self.service = folder, url, service

    def knitcore(self, *arguments: str | Path, **settings: str) -> str:
        """Output of a command beside the service, with its settings or others.

        Raises
        ------
        subprocess.CalledProcessError
            If it fails.
        """
        own = {f"KNITCORE_{name.upper()}": value for name, value in settings.items()}
        command = [sys.executable, "-m", "app.cli.main", *arguments]
        return subprocess.check_output(command, text=True, env=self.service.environment | own)

    def sql(self, statement: str, database: str = DATABASE) -> None:
        """Run a statement as whoever runs the database."""
        as_owner = ["-h", str(self.folder / "socket"), "-p", self._port, "-U", "knitcore"]
        postgres("psql", "-q", "-v", "ON_ERROR_STOP=1", *as_owner, "-d", database, "-c", statement)

    def database_url(self, database: str) -> str:
        """The URL of another database on the same server, without its password."""
        return self.service.environment["KNITCORE_DATABASE_URL"].rpartition("/")[0] + f"/{database}"

    @property
    def _port(self) -> str:
        return self.database_url("").rpartition(":")[2].rstrip("/")


@contextlib.contextmanager
def composition(folder: Path, port: int = 0) -> Iterator[Composition]:
    """Run all programs while the block runs.

    Parameters
    ----------
    folder : of data, secrets and logs.
    port : of the proxy; 0 takes a free one.
    """
    folder.chmod(0o711)  # the database runs as another user
    port = port or free_port()
    passwords = _secrets(folder / "secrets")
    with contextlib.ExitStack() as stack:
        database = stack.enter_context(_database(folder, passwords / "knitcore_database_password"))
        scheduler = f"127.0.0.1:{free_port()}"
        words = {"8786": scheduler.rpartition(":")[2], "tcp://scheduler:8786": f"tcp://{scheduler}"}
        data = folder / "data"
        data.mkdir(exist_ok=True, mode=0o700)
        stack.enter_context(dask("scheduler", folder, words, "--host=127.0.0.1"))
        _wait(lambda: listens(int(words["8786"])))
        worker = words | {"/tmp": str(folder)}
        stack.enter_context(dask("worker", folder, worker, KNITCORE_DATA_DIR=str(data)))
        settings = {
            name.removeprefix("KNITCORE_").lower(): value
            for name, value in COMPOSE["services"]["app"]["environment"].items()
        }
        host, _, rest = settings["database_url"].rpartition("@")
        settings |= {
            "host": "127.0.0.1",
            "allowed_hosts": "[]",
            "trusted_proxies": '["127.0.0.1"]',
            "database_url": f"{host}@127.0.0.1:{database}/{rest.partition('/')[2]}",
            "scheduler": f"tcp://{scheduler}",
            "data_dir": str(data),
            "secrets_dir": str(passwords),
        }
        del settings["port"]
        service = stack.enter_context(Service(folder, **settings))
        stack.enter_context(proxied(folder, service, port))
        yield Composition(folder, f"http://127.0.0.1:{port}", service)


@contextlib.contextmanager
def proxied(
    folder: Path, service: Service, port: int, changes: Mapping[str, str] | None = None
) -> Iterator[None]:
    """Run nginx in front of a service.

    Parameters
    ----------
    folder : of its configuration and its log.
    changes : of the shipped configuration, patterns and what replaces them.

    Raises
    ------
    RuntimeError
        If the configuration has nothing like one of them.
    """
    text = (ROOT / "deploy" / "nginx.conf").read_text(encoding="utf-8")
    here = {
        "server app:8737;": f"server {service.url.removeprefix('http://')};",
        "listen 8737;": f"listen 127.0.0.1:{port};",
        "/tmp/nginx": f"{folder}/nginx",
    }
    for shipped, changed in (here | dict(changes or {})).items():
        text, count = re.subn(shipped, changed, text)
        if not count:
            raise RuntimeError(f"deploy/nginx.conf has no {shipped!r}")
    file = folder / "nginx.conf"
    file.write_text(text, encoding="utf-8")
    command = [str(nginx()), "-p", str(folder), "-e", "stderr", "-c", str(file)]
    if os.geteuid() == 0:  # its workers could not write into a folder of root
        command += ["-g", "user root;"]
    with _running(command, folder / "proxy.log"):
        _wait(lambda: listens(port))
        yield


def repointed(folder: Path, service: Service) -> None:
    """Let the proxy in a folder ask a service that has started again, at another address."""
    file = folder / "nginx.conf"
    lines = file.read_text(encoding="utf-8").splitlines()
    named = f"        server {service.url.removeprefix('http://')};"
    changed = [named if line.startswith("        server 127") else line for line in lines]
    file.write_text("\n".join(changed), encoding="utf-8")
    os.kill(int((folder / "nginx.pid").read_text()), signal.SIGHUP)


@contextlib.contextmanager
def _database(folder: Path, password: Path) -> Iterator[str]:
    """Run PostgreSQL, which asks for a password; yields its port."""
    place, sockets, port = folder / "database", folder / "socket", str(free_port())
    for made in place, sockets:
        made.mkdir(exist_ok=True)
        if os.geteuid() == 0:
            shutil.chown(made, "postgres")
    if not (place / "PG_VERSION").exists():
        place.chmod(0o700)
        given = folder / "password"
        given.write_text(password.read_text(encoding="utf-8"), encoding="utf-8")
        given.chmod(0o644)
        access = "--auth-local=trust", "--auth-host=scram-sha-256", f"--pwfile={given}"
        postgres("initdb", "-D", str(place), "-U", "knitcore", *access)
        given.unlink()
    where = f"-p {port} -c listen_addresses=127.0.0.1 -c unix_socket_directories={sockets}"
    log = str(place / "log")
    postgres("pg_ctl", "-w", "-D", str(place), "-o", where, "-l", log, "start")
    try:
        to = "-h", str(sockets), "-p", port, "-U", "knitcore"
        with contextlib.suppress(subprocess.CalledProcessError):  # it is there already
            postgres("createdb", *to, DATABASE)
        yield port
    finally:
        postgres("pg_ctl", "-w", "-D", str(place), "-m", "fast", "stop")


@contextlib.contextmanager
def dask(
    name: str, folder: Path, changed: dict[str, str], *options: str, **more: str
) -> Iterator[None]:
    """Run a Dask program of the compose file, with some of its words changed and options added.

    Its environment has ``more``, its log is in the folder.
    """
    described = COMPOSE["services"][name]
    program, *words = (changed.get(word, word) for word in described["command"])
    environment = os.environ | described["environment"] | {"PYTHONPATH": str(ROOT)} | more
    command = [sys.executable, "-m", program, *words, *options]
    with _running(command, folder / f"{name}.log", environment):
        yield


@contextlib.contextmanager
def _running(
    command: list[str], log: Path, environment: dict[str, str] | None = None
) -> Iterator[None]:
    with log.open("a", encoding="utf-8") as out:
        process = subprocess.Popen(command, stdout=out, stderr=out, env=environment)
    try:
        yield
    finally:
        process.terminate()
        process.wait(PATIENCE_S)


def _secrets(folder: Path) -> Path:
    """Make the secrets of the compose file, under the names that the service reads."""
    folder.mkdir(exist_ok=True, mode=0o700)
    for secret in COMPOSE["services"]["app"]["secrets"]:
        file = folder / secret["target"]
        if not file.exists():
            file.write_text(f"{secrets.token_hex(24)}\n", encoding="utf-8")
    return folder


def postgres(program: str, *arguments: str) -> None:
    """Run a program of PostgreSQL, which refuses to run as root."""
    as_user = ["runuser", "-u", "postgres", "--"] if os.geteuid() == 0 else []
    command = [*as_user, str((postgres_programs() or Path()) / program), *arguments]
    quiet = subprocess.DEVNULL
    subprocess.run(command, check=True, stdout=quiet, stderr=quiet, cwd="/")


def postgres_programs() -> Path | None:
    """Folder with the programs of PostgreSQL, or None."""
    packaged = sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True)
    program = shutil.which("pg_ctl", path=PATHS)
    return packaged[0] if packaged else Path(program).parent if program else None


def nginx() -> str | None:
    """The program, or None."""
    return shutil.which("nginx", path=PATHS)


def free_port() -> int:
    """A port that nobody listens on now."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        return int(free.getsockname()[1])


def listens(port: int) -> bool:
    """Tell whether somebody listens on a port."""
    with socket.socket() as client:
        return client.connect_ex(("127.0.0.1", port)) == 0


def _wait(true: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE_S
    while not true():
        if time.monotonic() > deadline:
            raise RuntimeError("a program of the composition does not answer; see its log")
        time.sleep(0.05)


def main() -> None:
    """Run the composition until Ctrl+C."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=Path, help="for data, secrets and logs; kept")
    parser.add_argument("--port", type=int, default=8737, help="of the proxy")
    given = parser.parse_args()
    if lacking := missing():
        sys.exit(f"Install first: apt-get install -y --no-install-recommends {' '.join(lacking)}")
    stopped = threading.Event()
    for ending in signal.SIGINT, signal.SIGTERM:
        signal.signal(ending, lambda *_: stopped.set())
    with contextlib.ExitStack() as stack:
        if given.folder is None:
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="knitcore-")))
        else:
            folder = given.folder.resolve()
            folder.mkdir(parents=True, exist_ok=True)
        running = stack.enter_context(composition(folder, given.port))
        made = running.knitcore("token", "create", "me", "--label", "composition").split()[0]
        print(f"Knitcore is at {running.url}/?token={made}  (Ctrl+C stops it; logs in {folder})")
        stopped.wait()


if __name__ == "__main__":
    main()
