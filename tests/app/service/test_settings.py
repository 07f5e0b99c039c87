from pathlib import Path

import pytest
from click.testing import CliRunner
from pydantic import ValidationError

from app.cli.main import main
from app.service.compute.cluster import ClusterWorker
from app.service.settings import Settings
from knitcore.base.errors import InputError
from tests.app.clients import served, state_of
from tests.app.command_line import refused

SERVING = Path(__file__).resolve().parents[3] / "docs" / "serving.md"


@pytest.mark.parametrize("name", list(Settings.model_fields))
def test_every_setting_is_documented(name: str) -> None:
    assert f"`KNITCORE_{name.upper()}`" in SERVING.read_text()


def test_settings_come_from_a_file_and_the_environment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "knitcore.toml"
    monkeypatch.setenv("KNITCORE_CONFIG", str(file))
    with pytest.raises(InputError, match="there is no file"):
        Settings()
    file.write_text('port = 9001\nworkers = 3\nlog_format = "json"\n')
    monkeypatch.setenv("KNITCORE_WORKERS", "1")
    monkeypatch.setenv("KNITCORE_ALLOWED_HOSTS", '["knit.example"]')
    assert (Settings().port, Settings().workers, Settings().log_format) == (9001, 1, "json")
    assert Settings().allowed_hosts == ("knit.example",)
    file.write_text("porrt = 9001\n")
    with pytest.raises(ValueError, match="porrt"):
        Settings()
    file.write_text("not toml at all")
    with pytest.raises(InputError, match="not a TOML"):
        Settings()


@pytest.mark.parametrize(
    ("host", "loopback"),
    [("127.0.0.1", True), ("::1", True), ("localhost", True), ("0.0.0.0", False), ("::", False)],
)
def test_loopback_is_known(host: str, loopback: bool) -> None:
    assert Settings(host=host).is_loopback is loopback


def test_logs_hold_no_token() -> None:
    assert "a-long-enough-token" not in repr(Settings(token="a-long-enough-token"))


def test_a_scheduler_takes_the_work_away_from_this_machine(tmp_path: Path) -> None:
    # it need not be there yet
    with served(scheduler="tcp://127.0.0.1:9", workers=3, data_dir=tmp_path) as client:
        workers = state_of(client).compute.workers
        assert [type(worker) for worker in workers] == [ClusterWorker] * 3
        assert client.get("/healthz").status_code == 200
        assert client.get("/readyz").status_code == 503


def test_a_scheduler_has_an_address() -> None:
    with pytest.raises(ValidationError, match="scheduler"):
        Settings(scheduler="somewhere")


def test_a_folder_that_cannot_be_made_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("KNITCORE_DATA_DIR", "/proc/x")
    assert "cannot be created" in refused("serve", "--port", "0")


@pytest.mark.parametrize(
    ("name", "value"),
    [("KNITCORE_DATA_DIR", ""), ("KNITCORE_TOKEN", ""), ("KNITCORE_PORT", ""),
     ("KNITCORE_DATABSE_URL", "postgresql+psycopg://here/name")],
)  # fmt: skip
def test_an_empty_or_misspelt_variable_is_refused_by_every_command(
    name: str, value: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """It would make a database in the present folder, or in another one than is meant."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv(name, value)
    (tmp_path / "file").touch()
    result = CliRunner().invoke(main, ["doctor"])
    assert result.exit_code == 1
    assert "FAIL  settings" in result.output
    for command in (["token", "list"], ["backup", "new"], ["restore", "file"], ["serve"]):
        assert name in refused(*command)
    assert [file.name for file in tmp_path.iterdir()] == ["file"]


def test_an_empty_data_folder_in_the_file_is_refused(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    file = tmp_path / "knitcore.toml"
    file.write_text('data_dir = ""\n')
    monkeypatch.delenv("KNITCORE_DATA_DIR")  # of the tests, which comes first
    monkeypatch.setenv("KNITCORE_CONFIG", str(file))
    with pytest.raises(ValidationError, match="is empty"):
        Settings()


def test_a_secret_that_is_no_text_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "knitcore_token").write_bytes(b"\xff\xfe" * 10)
    monkeypatch.setenv("KNITCORE_SECRETS_DIR", str(tmp_path))
    words = refused("token", "list")
    assert "UTF-8" in words
    assert "JSON" not in words


def test_secrets_come_from_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("KNITCORE_SECRETS_DIR", str(tmp_path / "none"))
    with pytest.raises(InputError, match="not a folder"):
        Settings()
    monkeypatch.setenv("KNITCORE_SECRETS_DIR", str(tmp_path))
    (tmp_path / "knitcore_token").write_text("of-a-file-that-is-long\n")
    (tmp_path / "knitcore_database_password").write_text("p@ss/word\n")
    (tmp_path / "another").write_text("is no setting")
    monkeypatch.setenv("KNITCORE_DATABASE_URL", "postgresql+psycopg://knit@host/name")
    settings = Settings().check()
    assert settings.token is not None
    assert settings.token.get_secret_value() == "of-a-file-that-is-long"
    assert settings.store_url == "postgresql+psycopg://knit:p%40ss%2Fword@host/name"
    assert "p@ss" not in repr(settings)
    monkeypatch.setenv("KNITCORE_TOKEN", "of-the-environment-it-is")
    given = Settings().token
    assert given is not None
    assert given.get_secret_value() == "of-the-environment-it-is"
