"""Dockerfile and compose file, as far as they can be checked without a container engine."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import yaml

from app.settings import Settings

ROOT = Path(__file__).resolve().parent.parent
DOCKERFILE = (ROOT / "Dockerfile").read_text()
COMPOSE: dict[str, Any] = yaml.safe_load((ROOT / "compose.yaml").read_text())


def _filled(value: str) -> str:
    """A value of the compose file with variables as an .env file would give them."""
    given = {"KNITCORE_TOKEN": "x" * 32, "POSTGRES_PASSWORD": "secret"}
    defaulted = re.sub(r"\$\{(\w+):-(.*)\}", r"\2", value)
    return re.sub(r"\$\{(\w+):\?[^}]*\}", lambda m: given[m[1]], defaulted)


def test_the_environment_of_the_service_is_valid(monkeypatch: pytest.MonkeyPatch) -> None:
    given = COMPOSE["services"]["app"]["environment"]
    for name, value in given.items():
        if name.startswith("KNITCORE_"):
            assert name.removeprefix("KNITCORE_").lower() in Settings.model_fields
            monkeypatch.setenv(name, _filled(value))
    settings = Settings().check()
    assert settings.store_url == "postgresql+psycopg://knitcore:secret@database/knitcore"
    assert not settings.is_loopback


def test_no_secret_has_a_default() -> None:
    for service in COMPOSE["services"].values():
        for name, value in service["environment"].items():
            if re.search("TOKEN|PASSWORD", name):
                assert ":?" in value, f"{name} must come from outside"


def test_the_cluster_is_the_one_that_the_service_asks() -> None:
    """The commands themselves are run by tests/app/compute/test_cluster.py."""
    services = COMPOSE["services"]
    address = services["app"]["environment"]["KNITCORE_SCHEDULER"]
    name, port = address.removeprefix("tcp://").split(":")
    assert services[name]["command"][1:4] == ["scheduler", "--port", port]
    worker = services["worker"]["command"]
    assert worker[2] == address
    assert worker[4] == services["app"]["environment"]["KNITCORE_WORKERS"]
    assert services[name]["networks"] == services["worker"]["networks"] == ["cluster"]
    assert COMPOSE["networks"]["cluster"]["internal"]


def test_services_wait_for_each_other_and_keep_their_data() -> None:
    services, volumes = COMPOSE["services"], COMPOSE["volumes"]
    for service in services.values():
        assert service["healthcheck"]["test"]
        for other in service.get("depends_on", {}):
            assert "healthcheck" in services[other]
        for volume in service.get("volumes", []):
            assert volume.split(":")[0] in volumes
        assert set(service["networks"]) <= set(COMPOSE["networks"])
    database = services["database"]["environment"]
    url = services["app"]["environment"]["KNITCORE_DATABASE_URL"]
    assert url.startswith(f"postgresql+psycopg://{database['POSTGRES_USER']}:")
    assert url.endswith(f"@database/{database['POSTGRES_DB']}")


def test_the_service_has_no_more_rights_than_it_needs() -> None:
    services = COMPOSE["services"]
    for name in ("app", "scheduler", "worker"):
        assert services[name]["read_only"]
        assert services[name]["cap_drop"] == ["ALL"]
    assert all(port.startswith("127.0.0.1:") for port in services["app"]["ports"])
    assert [name for name, service in services.items() if "ports" in service] == ["app"]


def test_the_image_runs_as_a_plain_user_from_debian_packages() -> None:
    lines = DOCKERFILE.splitlines()
    bases = [line for line in lines if line.startswith("FROM ")]
    assert "ARG BASE=debian:bookworm-slim" in lines
    assert all(line.startswith("FROM ${BASE}") for line in bases)
    user = next(i for i, line in enumerate(lines) if line.startswith("USER "))
    assert lines[user] != "USER root"
    assert user < next(i for i, line in enumerate(lines) if line.startswith("RUN make install"))
    for file in re.findall(r"^COPY (?:--chown=\S+ )?([^-\s]\S*) ", DOCKERFILE, re.MULTILINE):
        assert (ROOT / file).exists()
    folder = COMPOSE["services"]["app"]["volumes"][0].split(":")[1]
    assert f"mkdir -p {folder}" in DOCKERFILE
    for line in re.findall(r"ENV (.*)", DOCKERFILE):
        for name in re.findall(r"KNITCORE_(\w+)=", line):
            assert name.lower() in Settings.model_fields


def test_workers_find_own_materials_and_nothing_grows_without_end() -> None:
    services = COMPOSE["services"]
    app, worker = services["app"], services["worker"]
    assert app["environment"]["KNITCORE_DATA_DIR"] == worker["environment"]["KNITCORE_DATA_DIR"]
    assert app["volumes"] == worker["volumes"]
    for name in ("app", "scheduler", "worker"):
        assert services[name]["mem_limit"]
        assert services[name]["pids_limit"]
        assert services[name]["init"]


def test_secrets_stay_out_of_image_and_repository() -> None:
    """compose.yaml asks for an .env file beside it."""
    for name in (".dockerignore", ".gitignore"):
        assert ".env" in (ROOT / name).read_text().splitlines(), name
