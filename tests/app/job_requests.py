"""The smallest real request of every kind of job."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any

import numpy as np

from knitcore.fabric import Direction
from knitcore.materials import material
from knitcore.swatch import SheetModel
from tests.knitcore.measure.synthetic import hanging_yarn, save_photo, write_csv
from tests.knitcore.measure.test_compression import squeeze, write
from tests.knitcore.swatch.synthetic import camera_arrays

PIECE = {
    "outline": [[0, 0], [40, 0], [50, 30], [0, 30]],
    "grain_deg": 30,
    "edges": {"left": [4], "right": [2]},
    "conditions": [{"kind": "held", "edge": "left"}, {"kind": "pulled", "edge": "right", "x_n": 1}],
}


def job_requests(folder: Path) -> dict[str, dict[str, Any]]:
    """By kind; files are written to a folder first."""
    course, wale = (write_csv(folder / f"{d}.csv", d, noise=0.01) for d in Direction)
    photo = save_photo(folder / "photo.png", hanging_yarn(80, length_px=700))
    made = squeeze(1e-3, 2.5)
    squeezed = write(folder / "mine-1.csv", made.depth_mm, made.force_n)
    displacement, frame = camera_arrays(material("acrylic").law("garter"), SheetModel())
    field = folder / "field.npz"
    np.savez_compressed(field, displacement=displacement.astype(np.float32), frame=frame)

    chart = {"chart": "K\nP", "material": "acrylic"}
    measured = {"field": _upload(field), "direction": "wale", "material": "acrylic"}
    wish = {"quantity": "modulus_course_n_per_mm", "value": 0.223}
    target = [[0.2] * 4] * 4
    return {
        "stretch": chart | {"direction": "wale", "strain": 0.2, "steps": 2},
        "curve": chart | {"direction": "wale"},
        "piece": chart | {"piece": PIECE, "steps": 1, "mesh_mm": 10},
        "bias": chart | {"strain": 0.1, "steps": 1, "mesh_mm": 20},
        "biaxial": chart | {"strain_x": 0.1, "strain_y": 0.1, "steps": 1, "mesh_mm": 50},
        "trellis": chart | {"angle_deg": 10, "steps": 1, "mesh_mm": 50},
        "relax": chart,
        "bend": chart,
        "curl": chart,
        "sweep": chart | {"direction": "wale", "max_strain": 0.1, "points": 2},
        "characterise": {"material": "acrylic", "fabrics": ["garter"], "tensions": [1.0]},
        "atlas": {"material": "acrylic"},
        "find": {"materials": ["acrylic"], "targets": [wish]},
        "fill": {
            "material": "acrylic",
            "modulus_course_n_per_mm": target,
            "modulus_wale_n_per_mm": target,
        },
        "shape": {"material": "acrylic", "strain": 0.2, "across": 6, "width": [0.9] * 8},
        "fit": {"test_course": _upload(course), "test_wale": _upload(wale)},
        "bending": {
            "images": [_upload(photo)],
            "linear_density_g_per_m": 0.5,
            "length_mm": 120,
        },
        "compression": {"file": _upload(squeezed), "diameter_mm": 2.0},
        "compare": measured | {"fabric": "garter", "frames": [2]},
        "calibrate": measured | {"fabric": "garter", "frames": [2]},
    }


def _upload(path: Path) -> dict[str, str]:
    return {"name": path.name, "content": base64.b64encode(path.read_bytes()).decode()}
