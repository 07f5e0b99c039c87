"""Tests stand as the code stands: ``app/a/b.py`` has its tests in ``tests/app/a/test_b.py``."""

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
OF_NO_MODULE = {"app": "whole_service"}
"""Packages, and the folder with those of their tests that concern more than a module."""


@pytest.mark.parametrize("package", OF_NO_MODULE)
def test_a_file_of_tests_has_the_place_and_name_of_its_module(package: str) -> None:
    tests = ROOT / "tests" / package
    for file in tests.rglob("test_*.py"):
        place = file.relative_to(tests)
        module = ROOT / package / place.with_name(place.name.removeprefix("test_"))
        assert place.parts[0] == OF_NO_MODULE[package] or module.is_file(), file
