"""The library without its extras: predictions work, and what needs more says what to install."""

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

PROJECT = tomllib.loads(
    (Path(__file__).resolve().parents[3] / "pyproject.toml").read_text(encoding="utf-8")
)["project"]
MODULES = {"pillow": "PIL", "scikit-image": "skimage", "knitout-interpreter": "knitout_interpreter"}
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


def light(*arguments: str) -> subprocess.CompletedProcess[str]:
    """The command line where only the plain dependencies are installed."""
    extras = PROJECT["optional-dependencies"]
    lines = [line for extra in ("files", "cluster", "service") for line in extras[extra]]
    names = [Requirement(line).name for line in lines]
    absent = {MODULES.get(name, name.replace("-", "_")) for name in names} - {"knitcore"}
    code = WITHOUT.format(absent=absent, arguments=list(arguments))
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)


def test_a_prediction_needs_the_light_library_only_and_loads_no_solver() -> None:
    told = light("predict", "garter", "--size", "5x5", "--material", "acrylic", "--json")
    assert told.returncode == 0, told.stderr
    assert '"provenance":"measured"' in told.stdout
    loaded = set(told.stderr.split())
    assert not loaded & {
        "numba",
        "scipy",
        "numpy.f2py",
        "pydantic_settings",
        "app.operations.chart.curve",
    }


@pytest.mark.parametrize("command", ["fit a.csv b.csv", "measure bending a.png", "serve"])
def test_a_command_without_its_packages_names_the_extra(command: str) -> None:
    told = light(*command.split())
    assert told.returncode == 2
    assert "pip install 'knitcore[service]'" in told.stderr


def test_help_lists_all_commands() -> None:
    told = light("--help")
    assert told.returncode == 0, told.stderr
    assert "predict" in told.stdout
