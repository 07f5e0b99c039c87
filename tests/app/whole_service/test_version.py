"""One version, wherever it is asked for."""

import tomllib
from pathlib import Path

from click.testing import CliRunner
from fastapi.testclient import TestClient

import knitcore
from app.cli.main import main

PROJECT = Path(__file__).resolve().parents[3] / "pyproject.toml"


def test_library_commands_and_service_have_the_version_of_pyproject(client: TestClient) -> None:
    version = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"]["version"]
    assert knitcore.__version__ == version
    assert CliRunner().invoke(main, ["--version"]).stdout.split()[-1] == version
    assert client.get("/api/v1/version").json() == {"version": version, "api": "v1"}
    assert client.get("/openapi.json").json()["info"]["version"] == version
