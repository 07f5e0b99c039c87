"""The client that these tests ask with: made from this service, in a folder of its own."""

import atexit
import shutil
import sys
import tempfile
from pathlib import Path

from scripts.client_code import write

_FOLDER = tempfile.mkdtemp(prefix="knitcore-client-")
atexit.register(shutil.rmtree, _FOLDER, ignore_errors=True)
write(Path(_FOLDER))
sys.path.insert(0, _FOLDER)
