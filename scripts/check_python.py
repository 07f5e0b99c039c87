"""Say plainly what is missing before the set-up fails somewhere deep inside."""

import sys

if sys.version_info < (3, 11):
    sys.exit(
        f"Python 3.11 or newer is needed, not {sys.version.split()[0]}: set PYTHON=python3.11."
    )
try:
    import ensurepip  # noqa: F401 - Debian packs it apart
except ImportError:
    sys.exit("The venv module is incomplete: install Debian's python3-venv.")
