"""The wheels in empty environments: the whole tool, and the library alone."""

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx2 as httpx
import pytest

from app.service import VERSION

ROOT = Path(__file__).resolve().parents[1]
UV = Path(sys.executable).with_name("uv")
PREDICT = ("predict", "garter", "--size", "5x5", "--material", "acrylic", "--json")

pytestmark = [pytest.mark.slow, pytest.mark.timeout(1800)]


def run(*command: str | Path, cwd: Path) -> str:
    """Return what a command prints; it finds nothing of this checkout."""
    bare = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(
        command, cwd=cwd, env=bare, capture_output=True, text=True, timeout=600, check=False
    )
    assert done.returncode == 0, f"{command}: {done.stdout}{done.stderr}"
    return done.stdout


@pytest.fixture(scope="module")
def wheels(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the wheel, made from its sdist."""
    page = ROOT / "frontend" / "dist" / "index.html"
    assert page.is_file(), "make page"
    folder = tmp_path_factory.mktemp("dist")
    run(UV, "build", "--quiet", "--out-dir", folder, ROOT, cwd=folder)
    return folder


@pytest.fixture
def installed(wheels: Path, tmp_path: Path) -> Callable[..., Path]:
    """Install the wheel into an empty environment; returns its folder of programs."""

    def install(extra: str = "") -> Path:
        run(sys.executable, "-m", "venv", tmp_path / "venv", cwd=tmp_path)
        programs = tmp_path / "venv" / "bin"
        [wheel] = wheels.glob(f"knitcore-{VERSION}-*.whl")
        python = programs / "python"
        (tmp_path / ".venv").symlink_to(python.parent.parent)  # the script installs into it
        (python.parent / "uv").symlink_to(UV)
        run(ROOT / "scripts" / "install", f"{wheel}{extra}", cwd=tmp_path)
        return programs

    return install


@pytest.fixture
def serving(tmp_path: Path) -> Iterator[Callable[[Path], str]]:
    """Start a service; returns its address."""
    started: list[subprocess.Popen[str]] = []

    def serve(knitcore: Path) -> str:
        bare = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        process = subprocess.Popen(
            [knitcore, "serve", "--port", "0", "--json"],
            cwd=tmp_path,
            env=bare | {"KNITCORE_DATA_DIR": str(tmp_path / "data"), "KNITCORE_WORKERS": "1"},
            stdout=subprocess.PIPE,
            text=True,
        )
        started.append(process)
        assert process.stdout is not None
        return str(json.loads(process.stdout.readline())["url"])

    yield serve
    for process in started:
        process.terminate()
        process.communicate(timeout=120)


def test_the_whole_tool_runs_without_checkout_and_node(
    installed: Callable[..., Path], serving: Callable[[Path], str], tmp_path: Path
) -> None:
    programs = installed("[service]")
    knitcore = programs / "knitcore"
    assert run(knitcore, "--version", cwd=tmp_path).split()[-1] == VERSION
    assert json.loads(run(knitcore, *PREDICT, cwd=tmp_path))["rows"]
    with httpx.Client(base_url=serving(knitcore), timeout=120) as browser:
        page = browser.get("/")
        assert page.status_code == 200
        files = re.findall(r'(?:src|href)="(/static/[^"]+)"', page.text)
        assert any(re.search(r"app-[\w-]+\.js$", name) for name in files), "the page is not bundled"
        for name in files:
            assert browser.get(name).status_code == 200, name
        assert browser.get("/api/v1/version").json()["version"] == VERSION
        example = browser.get("/openapi.json").json()["paths"]["/api/v1/predict"]["post"]
        body = example["requestBody"]["content"]["application/json"]["example"]
        assert browser.post("/api/v1/predict", json=body).status_code == 200


def test_the_library_alone_is_light(installed: Callable[..., Path], tmp_path: Path) -> None:
    programs = installed()
    script = (
        "import knitcore as k, importlib.util as u; chart = k.StitchChart.parse('KP/PK');"
        "print(k.predict(chart, k.material('acrylic')).course.modulus_n_per_mm > 0,"
        " u.find_spec('fastapi'), u.find_spec('plotly'))"
    )
    assert run(programs / "python", "-c", script, cwd=tmp_path).split() == ["True", "None", "None"]
    assert json.loads(run(programs / "knitcore", *PREDICT, cwd=tmp_path))["rows"]


def test_it_runs_without_being_installed(wheels: Path, tmp_path: Path) -> None:
    [wheel] = wheels.glob(f"knitcore-{VERSION}-*.whl")
    printed = run(UV, "tool", "run", "--from", wheel, "knitcore", *PREDICT, cwd=tmp_path)
    assert json.loads(printed)["rows"]
