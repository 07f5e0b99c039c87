"""Comparisons with the study's raw data, which are no part of the product (KNITCORE_STUDY_DATA).

They are tests, but not of the suite, which needs nothing that a clone lacks.
"""

import os
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def study_data() -> Path:
    """Folder of the data, named by KNITCORE_STUDY_DATA."""
    folder = Path(os.environ.get("KNITCORE_STUDY_DATA", ""))
    if not (folder / "uniaxial").is_dir():
        pytest.exit("KNITCORE_STUDY_DATA does not name the folder of the study's data", 2)
    return folder
