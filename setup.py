"""What pyproject.toml cannot say: the built page goes into the wheel."""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

PAGE = Path(__file__).resolve().parent / "frontend" / "dist"


class BuildWithPage(build_py):
    """Copies the page that ``make page`` built to ``app/page``."""

    def run(self) -> None:
        """Build."""
        super().run()
        if self.editable_mode:
            return
        if (PAGE / "index.html").is_file():
            shutil.copytree(PAGE, Path(self.build_lib) / "app" / "page", dirs_exist_ok=True)
        else:
            self.announce("there is no page in this wheel: run `make page` first", level=30)


setup(cmdclass={"build_py": BuildWithPage})
