"""Dockerfile and compose file, as far as they can be checked without a container engine."""

import os
import re
import shutil
import socket
import subprocess
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pathspec
import pytest
import yaml

from app.service.settings import Settings
from app.service.web.unread import TESTED_UVICORN
from app.viewer.private_port import TESTED_VISER

ROOT = Path(__file__).resolve().parent.parent
DOCKERFILE = (ROOT / "Dockerfile").read_text()
COMPOSE: dict[str, Any] = yaml.safe_load((ROOT / "compose.yaml").read_text())


def _filled(value: str) -> str:
    """A value of the compose file with the defaults of its variables."""
    return re.sub(r"\$\{(\w+):-(.*)\}", r"\2", value)


def test_the_environment_of_the_service_is_valid(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    app = COMPOSE["services"]["app"]
    for name, value in app["environment"].items():
        if name.startswith("KNITCORE_"):
            assert name.removeprefix("KNITCORE_").lower() in Settings.model_fields
            monkeypatch.setenv(name, _filled(value))
    for secret in app["secrets"]:
        assert secret["source"] in COMPOSE["secrets"]
        (tmp_path / secret["target"]).write_text("a-secret/of-its-own\n")
    monkeypatch.setenv("KNITCORE_SECRETS_DIR", str(tmp_path))
    settings = Settings().check()
    assert settings.store_url == (
        "postgresql+psycopg://knitcore:a-secret%2Fof-its-own@database/knitcore"
    )
    assert settings.token is not None
    assert settings.require_login
    assert not settings.is_loopback


@pytest.mark.parametrize(
    ("package", "tested"), [("uvicorn", TESTED_UVICORN), ("viser", TESTED_VISER)]
)
def test_packages_that_are_changed_here_have_the_version_tested(package: str, tested: str) -> None:
    assert version(package).startswith(f"{tested}.")
    major, minor = map(int, tested.split("."))
    allowed = f'"{package}>={tested},<{major}.{minor + 1}"'
    assert allowed in (ROOT / "pyproject.toml").read_text(encoding="utf-8")


def test_secrets_are_files_that_are_not_committed() -> None:
    ignored = (ROOT / ".gitignore").read_text().splitlines()
    assert {".env", "/secrets/"} <= set(ignored)
    for service in COMPOSE["services"].values():
        for name, value in service["environment"].items():
            if re.search("TOKEN|PASSWORD", name):
                assert (name, value) == ("POSTGRES_PASSWORD_FILE", "/run/secrets/database_password")
        assert not re.search(r":[^@/]+@", service["environment"].get("KNITCORE_DATABASE_URL", ""))
    assert all(secret["file"].startswith("secrets/") for secret in COMPOSE["secrets"].values())


def test_the_cluster_is_the_one_that_the_service_asks() -> None:
    """The commands themselves are run by tests/app/service/compute/test_cluster.py."""
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
    for name, service in services.items():
        assert service["healthcheck"]["test"]
        for other in service.get("depends_on", {}):
            assert "healthcheck" in services[other]
        for volume in service.get("volumes", []):
            assert volume.split(":")[0] in volumes
        assert set(service["networks"]) <= set(COMPOSE["networks"])
        assert service["mem_limit"]
        assert service["cpus"]
        assert all("size=" in place for place in service["tmpfs"])
        assert service["pids_limit"]
        assert service["logging"]["options"]["max-size"]
        assert name == "database" or service["init"]
    app, worker = services["app"], services["worker"]
    assert app["volumes"] == worker["volumes"]  # results that are kept
    assert app["environment"]["KNITCORE_DATA_DIR"] == worker["environment"]["KNITCORE_DATA_DIR"]
    database, url = services["database"]["environment"], app["environment"]["KNITCORE_DATABASE_URL"]
    assert url.startswith(f"postgresql+psycopg://{database['POSTGRES_USER']}@")
    assert url.endswith(f"@database/{database['POSTGRES_DB']}")


def test_the_service_has_no_rights_and_is_reached_through_its_proxy_only() -> None:
    services, networks = COMPOSE["services"], COMPOSE["networks"]
    for name in services:
        assert services[name]["read_only"]
        assert services[name]["cap_drop"] == ["ALL"]
    open_ = [name for name, of in services.items() if "ports" in of or "outside" in of["networks"]]
    assert open_ == ["proxy"]
    assert networks["front"]["internal"]
    (front,) = networks["front"]["ipam"]["config"]
    environment = services["app"]["environment"]
    assert environment["KNITCORE_TRUSTED_PROXIES"] == f'["{front["subnet"]}"]'
    proxy = (ROOT / "deploy" / "nginx.conf").read_text()
    assert f"server app:{environment['KNITCORE_PORT']};" in proxy
    listens = re.search(r"listen (\d+);", proxy)
    assert listens is not None
    assert services["proxy"]["ports"] == [f"127.0.0.1:8737:{listens[1]}"]


def _instructions() -> list[tuple[str, str]]:
    """Instructions of the Dockerfile with their arguments, continued lines joined."""
    text = re.sub(r"^#.*\n", "", DOCKERFILE, flags=re.MULTILINE)
    lines = re.sub(r"\s*\\\n\s*", " ", text).splitlines()
    pairs = [line.partition(" ") for line in lines if line.strip()]
    return [(name, rest) for name, _, rest in pairs]


def _all(name: str) -> list[str]:
    return [rest for instruction, rest in _instructions() if instruction == name]


def test_base_images_have_a_tag_and_perhaps_a_digest() -> None:
    """`scripts/image pin` adds the digests where an image registry can be reached."""
    pinned = r"[a-z0-9./-]+:(?!latest)[\w.-]+(@sha256:[0-9a-f]{64})?"
    (base,) = _all("ARG")
    assert re.fullmatch(f"BASE={pinned}", base)
    assert all(image.split()[0] == "${BASE}" for image in _all("FROM"))
    assert re.fullmatch(pinned, COMPOSE["services"]["database"]["image"])


def test_the_image_is_small_and_made_of_known_packages() -> None:
    for step in _all("RUN"):
        if "apt-get install" in step:
            assert step.startswith("apt-get update && apt-get install -y --no-install-recommends ")
            assert "rm -rf /var/lib/apt/lists/*" in step
        for install in re.findall(r"pip install [^&]*", step):
            assert "--require-hashes" in install or "--no-deps" in install
        assert not re.search(r"sudo|curl|wget|--trusted-host|chmod 777", step)
    assert not _all("ADD")
    last = [rest for name, rest in _instructions()][-1]
    last_stage = DOCKERFILE.rpartition("FROM ")[2]
    assert re.findall(r"^COPY (.*)$", last_stage, re.MULTILINE) == [
        "--from=program /opt/knitcore /opt/knitcore"  # no sources, tests or caches
    ]
    assert last == '["knitcore", "serve"]'


def test_the_image_has_what_the_product_needs_and_no_more() -> None:
    (step,) = re.findall(r"(sed .*) >product.txt", DOCKERFILE)
    product = subprocess.check_output(["sh", "-c", step], cwd=ROOT, text=True)
    names = set(re.findall(r"^([\w-]+)==", product, re.MULTILINE))
    assert {"fastapi", "numpy", "distributed"} <= names
    assert not {"uv", "pytest", "mypy"} & names


def test_the_image_runs_as_a_plain_user() -> None:
    names = [name for name, _ in _instructions()]
    assert _all("USER") == ["knit"]
    assert "RUN" not in names[names.index("USER") :]
    assert names.count("HEALTHCHECK") == names.count("CMD") == 1
    for check in (*_all("HEALTHCHECK"), str(COMPOSE["services"]["app"]["healthcheck"]["test"])):
        assert "KNITCORE_PORT" in check
    folder = COMPOSE["services"]["app"]["volumes"][0].split(":")[1]
    assert any(f"mkdir -p {folder} && chown knit:knit {folder}" in step for step in _all("RUN"))
    for setting in re.findall(r"KNITCORE_(\w+)=", " ".join(_all("ENV"))):
        assert setting.lower() in Settings.model_fields
    assert not re.search("TOKEN|PASSWORD|SECRET", " ".join(_all("ENV") + _all("ARG")))


def test_nothing_but_the_program_is_sent_to_the_engine() -> None:
    rules = (ROOT / ".dockerignore").read_text()
    ignored = pathspec.GitIgnoreSpec.from_lines(rules.splitlines())
    kept = "app/service/main.py app/service/store/migrations/env.py knitcore/__init__.py"
    kept += " frontend/build.mjs deploy/nginx.conf pyproject.toml setup.py README.md LICENSE"
    for file in f"{kept} requirements.lock".split():
        assert (ROOT / file).exists(), file
        assert not ignored.match_file(file), file
    secret = ".env .env.production app/.env frontend/.env.local knitcore.sqlite3 app/x.sqlite3-wal"
    other = "tests/conftest.py docs/serving.md .git/config .venv/bin/python var/data backup.gz"
    made = "frontend/node_modules/x.js frontend/dist/x.js app/__pycache__/main.pyc"
    for file in f"{secret} {other} {made}".split():
        assert ignored.match_file(file), file
    for source in _all("COPY"):
        for file in source.split()[:-1]:
            if not file.startswith("--") and "--from" not in source and file != ".":
                assert not ignored.match_file(file), file


def test_a_worker_is_healthy_while_it_is_connected_to_the_scheduler() -> None:
    _, grep, option, pattern, *tables = COMPOSE["services"]["worker"]["healthcheck"]["test"]
    address = COMPOSE["services"]["app"]["environment"]["KNITCORE_SCHEDULER"]
    assert pattern == f":{int(address.rpartition(':')[2]):04X} 01 "
    with socket.create_server(("127.0.0.1", 0)) as scheduler:
        port = scheduler.getsockname()[1]
        check = [grep, option, f":{port:04X} 01 ", tables[0]]
        assert subprocess.run(check, check=False).returncode == 1
        with socket.create_connection(("127.0.0.1", port)), scheduler.accept()[0]:
            assert subprocess.run(check, check=False).returncode == 0


def test_the_script_checks_the_files_where_no_engine_answers(tmp_path: Path) -> None:
    python = tmp_path / "python"
    python.write_text('#!/bin/sh\necho "$@"\n')
    python.chmod(0o755)
    environment = os.environ | {"ENGINE": "false", "PYTHON": str(python)}
    check = subprocess.run(
        [ROOT / "scripts/image"], env=environment, capture_output=True, text=True, check=True
    )
    assert "No container engine answers" in check.stdout
    assert "tests/test_deployment.py" in check.stdout


def test_images_are_pinned_by_digest_and_not_published_without(tmp_path: Path) -> None:
    """The engine knows one digest, and cannot build."""
    digest = "sha256:" + "0a" * 32
    engine = tmp_path / "engine"
    engine.write_text(
        f"#!/bin/sh\ncase $1 in image) echo registry/name@{digest};; build) exit 9;; esac\n"
    )
    (tmp_path / "scripts").mkdir()
    for name in ("scripts/image", "Dockerfile", "compose.yaml"):
        shutil.copy(ROOT / name, tmp_path / name)
    engine.chmod(0o755)

    def image(*words: str) -> subprocess.CompletedProcess[str]:
        command = [tmp_path / "scripts/image", *words]
        environment = os.environ | {"ENGINE": str(engine)}
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)

    (base,) = _all("ARG")
    base = base.removeprefix("BASE=").partition("@")[0]
    refused = image("publish", "somewhere/knitcore")
    if f"ARG BASE={base}\n" in DOCKERFILE:  # where no registry can be reached
        assert refused.returncode == 1
        assert f"Dockerfile: {base}" in refused.stdout
    for _ in range(2):  # a second time replaces the digests
        assert image("pin").returncode == 0
        assert f"ARG BASE={base}@{digest}\n" in (tmp_path / "Dockerfile").read_text()
        assert (tmp_path / "compose.yaml").read_text().count(digest) == 1
    assert image("publish", "somewhere/knitcore").returncode == 9
