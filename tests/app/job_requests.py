"""A small request of every kind of job: the example of its operation, with less to compute."""

from __future__ import annotations

from typing import Any

from app.jobs.kinds import KINDS

SMALLER: dict[str, dict[str, Any]] = {
    "stretch": {"steps": 2},
    "piece": {"steps": 1},
    "bias": {"mesh_mm": 20, "steps": 1},
    "biaxial": {"mesh_mm": 50, "steps": 1},
    "trellis": {"mesh_mm": 50, "steps": 1},
}


def job_requests() -> dict[str, dict[str, Any]]:
    """By kind."""
    return {
        kind: {**(operation.example or {}), **SMALLER.get(kind, {})}
        for kind, operation in KINDS.items()
    }
