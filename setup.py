"""What pyproject.toml cannot say: the folder ``app`` is the package ``knitcore_app``, and the built
page goes into the wheel.
"""

import shutil
from pathlib import Path

from setuptools import find_packages, setup
from setuptools.command.build_py import build_py

PAGE = Path(__file__).resolve().parent / "frontend" / "dist"
SERVICE = "knitcore_app"


class BuildWithPage(build_py):
    """Copies the page that ``make page`` built into the service's package."""

    def run(self) -> None:
        """Build."""
        super().run()
        if self.editable_mode:
            return
        if (PAGE / "index.html").is_file():
            shutil.copytree(PAGE, Path(self.build_lib) / SERVICE / "page", dirs_exist_ok=True)
        else:
            self.announce("there is no page in this wheel: run `make page` first", level=30)


setup(
    cmdclass={"build_py": BuildWithPage},
    package_dir={SERVICE: "app"},
    packages=[
        *find_packages(include=["knitcore", "knitcore.*"]),
        *(SERVICE + name[len("app") :] for name in find_packages(include=["app", "app.*"])),
    ],
)
