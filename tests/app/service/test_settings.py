from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner
from fastapi.testclient import TestClient
from pydantic import ValidationError

from app.cli.main import main
from app.service.compute.cluster import ClusterWorker
from app.service.main import create_app
from app.service.settings import Settings

SERVING = Path(__file__).resolve().parents[3] / "docs" / "serving.md"


@pytest.mark.parametrize("name", list(Settings.model_fields))
def test_every_setting_is_documented(name: str) -> None:
    assert f"`KNITCORE_{name.upper()}`" in SERVING.read_text()


def test_settings_come_from_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("KNITCORE_PORT", "9001")
    monkeypatch.setenv("KNITCORE_ALLOWED_HOSTS", '["knit.example"]')
    settings = Settings()
    assert settings.port == 9001
    assert settings.allowed_hosts == ("knit.example",)


@pytest.mark.parametrize(
    ("host", "loopback"),
    [("127.0.0.1", True), ("::1", True), ("localhost", True), ("0.0.0.0", False), ("::", False)],
)
def test_loopback_is_known(host: str, loopback: bool) -> None:
    assert Settings(host=host).is_loopback is loopback


def test_logs_hold_no_token() -> None:
    assert "a-long-enough-token" not in repr(Settings(token="a-long-enough-token"))


def test_a_scheduler_takes_the_work_away_from_this_machine(tmp_path: Path) -> None:
    app = create_app(Settings(scheduler="tcp://127.0.0.1:9", workers=3, data_dir=tmp_path))
    with TestClient(app, base_url="http://127.0.0.1") as client:  # it need not be there yet
        workers = app.state.compute.workers
        assert [type(worker) for worker in workers] == [ClusterWorker] * 3
        assert client.get("/healthz").status_code == 200
        assert client.get("/readyz").status_code == 503


def test_a_scheduler_has_an_address() -> None:
    with pytest.raises(ValidationError, match="scheduler"):
        Settings(scheduler="somewhere")


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [("ALLOWED_HOSTS", "knit.example", "as JSON"), ("DATA_DIR", "/proc/x", "cannot be created")],
)
def test_a_wrong_setting_is_reported_in_one_line(
    monkeypatch: pytest.MonkeyPatch, name: str, value: str, says: str
) -> None:
    monkeypatch.setenv(f"KNITCORE_{name}", value)
    result = CliRunner().invoke(main, ["serve", "--port", "0"])
    assert result.exit_code == 2
    assert says in result.stderr
