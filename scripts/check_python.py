"""Check the Python that the set-up needs, and say what is missing."""

import sys

if sys.version_info < (3, 11):
    sys.exit(
        f"Python 3.11 or newer is needed, not {sys.version.split()[0]}: set PYTHON=python3.11."
    )
try:
    import ensurepip  # noqa: F401 - Debian packages it separately
except ImportError:
    sys.exit("The venv module is incomplete: install Debian's python3-venv.")
