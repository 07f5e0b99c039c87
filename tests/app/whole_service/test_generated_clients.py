"""Clients that others generate from the schema compile."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from app.service.main import create_app

PAGE = Path(__file__).resolve().parents[3] / "frontend"
PROGRAMS = Path(sys.executable).parent
PYTHON_GENERATOR = "openapi-python-client==0.29.1"
AS_BYTES = ("image/png", "model/gltf-binary")
IMPORTS = """
import importlib, pkgutil
import generated
for module in pkgutil.walk_packages(generated.__path__, "generated."):
    importlib.import_module(module.name)
from generated.api.mechanics import predict
from generated.models import PredictRequest, PredictResult
print(PredictRequest.from_dict({"chart": "KP", "material": "acrylic"}).to_dict())
"""
USE = """
import type { paths } from "./schema";

type Answer<P extends keyof paths> = paths[P] extends {
  post: { responses: { 200: { content: { "application/json": infer A } } } };
} ? A : never;

export const modulus = (found: Answer<"/api/v1/predict">): number => found.modulus_course_n_per_mm;

type Result =
  paths["/api/v1/jobs/{job}/result"]["get"]["responses"][200]["content"]["application/json"];
export const strains = (found: Result): number[] => (found.kind === "curve" ? found.strain : []);
"""

pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]


def run(*command: str | Path, cwd: Path) -> str:
    path = {"PATH": f"{PROGRAMS}{os.pathsep}{os.environ['PATH']}"}
    done = subprocess.run(
        command, cwd=cwd, env=os.environ | path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"{command}: {done.stdout}{done.stderr}"
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def schema(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("schema") / "openapi.json"
    file.write_text(json.dumps(create_app().openapi()), encoding="utf-8")
    return file


def test_a_python_client(schema: Path) -> None:
    folder = schema.parent
    bytes_ = dict.fromkeys(AS_BYTES, "application/octet-stream")
    unformatted = {"content_type_overrides": bytes_, "post_hooks": []}
    (folder / "config.json").write_text(json.dumps(unformatted))
    generate = ["openapi-python-client", "generate", "--path", schema, "--meta", "none"]
    options = ["--config", folder / "config.json", "--output-path", folder / "generated"]
    tool = [PROGRAMS / "uv", "tool", "run", "--from", PYTHON_GENERATOR]
    printed = run(*tool, *generate, *options, cwd=folder)
    assert "WARNING" not in printed
    assert "ERROR" not in printed
    using = [PROGRAMS / "uv", "run", "--no-project", "--with", "attrs", "--with", "httpx"]
    printed = run(*using, "--with", "python-dateutil", "python", "-c", IMPORTS, cwd=folder)
    assert "acrylic" in printed


def test_a_typescript_client(schema: Path) -> None:
    folder = schema.parent
    programs = PAGE / "node_modules" / ".bin"
    run(programs / "openapi-typescript", schema, "--output", folder / "schema.d.ts", cwd=PAGE)
    (folder / "use.ts").write_text(USE)
    run(programs / "tsc", "--noEmit", "--strict", folder / "use.ts", cwd=PAGE)
