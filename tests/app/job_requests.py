"""A small request of every kind of job: the example of its operation, with real files."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any

import numpy as np

from app.jobs.kinds import KINDS
from knitcore.fabric import Direction
from knitcore.materials import material
from knitcore.swatch import SheetModel
from tests.knitcore.measure.synthetic import hanging_yarn, save_photo, write_csv
from tests.knitcore.measure.test_compression import squeeze, write
from tests.knitcore.swatch.synthetic import camera_arrays


def job_requests(folder: Path) -> dict[str, dict[str, Any]]:
    """By kind; files are written to a folder first."""
    course, wale = (write_csv(folder / f"{d}.csv", d, noise=0.01) for d in Direction)
    photo = save_photo(folder / "photo.png", hanging_yarn(80, length_px=700))
    made = squeeze(1e-3, 2.5)
    squeezed = write(folder / "mine-1.csv", made.depth_mm, made.force_n)
    displacement, frame = camera_arrays(material("acrylic").law("garter"), SheetModel())
    field = folder / "field.npz"
    np.savez_compressed(field, displacement=displacement.astype(np.float32), frame=frame)

    measured = {"field": _upload(field), "frames": [2]}
    files = {
        "fit": {"test_course": _upload(course), "test_wale": _upload(wale)},
        "bending": {"images": [_upload(photo)]},
        "compression": {"file": _upload(squeezed)},
        "compare": measured,
        "calibrate": measured,
    }
    smaller = {
        "stretch": {"steps": 2},
        "piece": {"steps": 1},
        "bias": {"mesh_mm": 20, "steps": 1},
        "biaxial": {"mesh_mm": 50, "steps": 1},
        "trellis": {"mesh_mm": 50, "steps": 1},
    }
    return {
        kind: {**(operation.example or {}), **files.get(kind, {}), **smaller.get(kind, {})}
        for kind, operation in KINDS.items()
    }


def _upload(path: Path) -> dict[str, str]:
    return {"name": path.name, "content": base64.b64encode(path.read_bytes()).decode()}
