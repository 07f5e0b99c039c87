"""A second process, in which somebody types commands beside the service."""

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from click.testing import CliRunner

from app.cli.main import main


class Terminal:
    """A process that runs one command after the other."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process

    def run(self, *arguments: str) -> tuple[int, str, str]:
        """Exit code, output and errors of a command."""
        answer = self._ask(arguments)
        return answer["code"], answer["out"], answer["err"]

    def _ask(self, arguments: tuple[str, ...]) -> Any:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps(arguments) + "\n")
        self._process.stdin.flush()
        return json.loads(self._process.stdout.readline())


@contextmanager
def terminal(environment: dict[str, str]) -> Iterator[Terminal]:
    """Such a process with an environment of its own."""
    process = subprocess.Popen(
        [sys.executable, "-m", __name__],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        env=environment,
    )
    with process:
        yield Terminal(process)
        assert process.stdin is not None
        process.stdin.close()


def _obey() -> None:
    for line in sys.stdin:
        done = CliRunner().invoke(main, json.loads(line))
        answer = {"code": done.exit_code, "out": done.stdout, "err": done.stderr}
        print(json.dumps(answer), flush=True)  # noqa: T201 - it is read by the test


if __name__ == "__main__":
    _obey()
