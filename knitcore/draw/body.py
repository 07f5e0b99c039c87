"""Bodies that cloth rests on in a picture: a limb, a hand, a table, a disc."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array

Floats = NDArray[np.float32]
SEEN_FROM = 1.2
"""Angle by which a table leans towards the eye, rad; a right angle would be upright."""


def upright(points: Floats) -> Floats:
    """Turn points (..., 3) with z up so that a table's top leans towards the eye."""
    sine, cosine = np.float32(np.sin(SEEN_FROM)), np.float32(np.cos(SEEN_FROM))
    x, y, z = np.moveaxis(points, -1, 0)
    return np.stack([x, cosine * y + sine * z, cosine * z - sine * y], axis=-1)


@dataclass(frozen=True, eq=False)
class Body:
    """A body on which cloth rests: a limb, a table, a disc.

    Attributes
    ----------
    vertices_mm, normals : (n, 3), the normals pointing to the cloth.
    faces : (m, 3) triangles, counterclockwise from outside: other programs hide the inside.
    """

    vertices_mm: Floats
    normals: Floats
    faces: NDArray[np.uint32]

    @classmethod
    def around(cls, rings_mm: Array) -> Body:
        """The surface through rings (rings, sides, 3), closed around its axis."""
        rings, sides, _ = rings_mm.shape
        vertex = np.arange(rings * sides, dtype=np.uint32).reshape(rings, sides)
        low, high = vertex[:-1], vertex[1:]
        next_low, next_high = np.roll(low, -1, axis=1), np.roll(high, -1, axis=1)
        faces = np.stack([low, next_low, next_high, low, next_high, high], axis=-1).reshape(-1, 3)
        points = rings_mm.reshape(-1, 3)
        if np.linalg.det((points - points.mean(axis=0))[faces]).sum() < 0.0:
            faces = faces[:, ::-1]
        outwards = rings_mm - rings_mm.mean(axis=1, keepdims=True)
        outwards /= np.maximum(np.linalg.norm(outwards, axis=-1, keepdims=True), 1e-9)
        return cls(points.astype(np.float32), outwards.reshape(-1, 3).astype(np.float32), faces)

    @classmethod
    def joined(cls, bodies: Sequence[Body]) -> Body:
        """Join several bodies to one."""
        before = np.cumsum([0, *(len(body.vertices_mm) for body in bodies[:-1])])
        return cls(
            np.concatenate([body.vertices_mm for body in bodies]),
            np.concatenate([body.normals for body in bodies]),
            np.concatenate(
                [body.faces + np.uint32(n) for body, n in zip(bodies, before, strict=True)]
            ),
        )

    @classmethod
    def slab(cls, outline_mm: Array, depth_mm: float) -> Body:
        """A table or disc with the outline (n, 2) below the plane z = 0; its normals point up."""
        top = np.column_stack([outline_mm, np.zeros(len(outline_mm))])
        middle = np.broadcast_to(top.mean(axis=0), top.shape)
        down = np.array([0.0, 0.0, depth_mm])
        body = cls.around(np.stack([middle, top, top - down, middle - down]))
        up = np.zeros_like(body.normals)
        up[:, 2] = 1.0
        return replace(body, normals=up)

    @classmethod
    def disc(cls, diameter_mm: float, depth_mm: float) -> Body:
        """A round :meth:`slab` about the origin."""
        turn = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)
        rim = 0.5 * diameter_mm * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        return cls.slab(rim, depth_mm)

    def sunk_mm(self, depth_mm: float) -> Floats:
        """Vertices set back from the cloth, because half the cloth lies below its middle plane."""
        return np.asarray(self.vertices_mm - np.float32(depth_mm) * self.normals)

    def upright(self) -> Body:
        """Turn it with :func:`upright`."""
        vertices, normals = upright(self.vertices_mm), upright(self.normals)
        return replace(self, vertices_mm=vertices, normals=normals)

    @property
    def size_bytes(self) -> int:
        """Memory of the arrays, bytes."""
        return self.vertices_mm.nbytes + self.normals.nbytes + self.faces.nbytes
