"""The library without its extras: predictions work, and what needs more says what to install."""

import subprocess
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from tests.app.running import python

PROJECT = tomllib.loads(
    (Path(__file__).resolve().parents[3] / "pyproject.toml").read_text(encoding="utf-8")
)["project"]
MODULES = {"pillow": "PIL", "scikit-image": "skimage"}
WITHOUT = """
import sys
class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in {absent!r}:
            raise ModuleNotFoundError("absent", name=name)
sys.meta_path.insert(0, Absent())
from app.cli.main import main
try:
    main({arguments!r}, prog_name="knitcore")
finally:
    print(*sys.modules, file=sys.stderr)
"""


def light(arguments: str) -> subprocess.CompletedProcess[str]:
    """The command line where only the plain dependencies are installed."""
    extras = PROJECT["optional-dependencies"]
    lines = [line for extra in ("files", "cluster", "service") for line in extras[extra]]
    names = [Requirement(line).name for line in lines]
    absent = {MODULES.get(name, name.replace("-", "_")) for name in names} - {"knitcore"}
    code = WITHOUT.format(absent=absent, arguments=arguments.split())
    return python("-c", code, check=False)


@pytest.mark.parametrize(
    ("command", "shown", "spared"),
    [
        (
            "predict garter --size 5x5 --material acrylic --json",
            '"provenance":"measured"',
            {"numba", "scipy", "numpy.f2py", "pydantic_settings", "app.operations.chart.curve"},
        ),
        ("--help", "predict", {"numba", "scipy"}),
    ],
)
def test_predictions_and_help_need_the_light_library_only_and_load_no_solver(
    command: str, shown: str, spared: set[str]
) -> None:
    done = light(command)
    assert done.returncode == 0, done.stderr
    assert shown in done.stdout
    assert not spared & set(done.stderr.split())


@pytest.mark.parametrize("command", ["fit a.csv b.csv", "measure bending a.png", "serve"])
def test_a_command_without_its_packages_names_the_extra(command: str) -> None:
    done = light(command)
    assert done.returncode == 2
    assert "pip install 'knitcore[service]'" in done.stderr
