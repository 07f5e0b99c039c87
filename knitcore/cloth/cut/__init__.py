"""Pieces of cloth cut along any outline, at any angle to their rows, and loaded at their edges."""

from knitcore.cloth.cut.conditions import Condition, Framed, Held, Pulled, Sewn, Traction
from knitcore.cloth.cut.cut_cloth import Cloth, cloth_under
from knitcore.cloth.cut.cut_piece import solve
from knitcore.cloth.cut.cut_results import ElementFields, PieceTest
from knitcore.cloth.cut.outline import CutPiece

__all__ = [
    "Cloth",
    "Condition",
    "CutPiece",
    "ElementFields",
    "Framed",
    "Held",
    "PieceTest",
    "Pulled",
    "Sewn",
    "Traction",
    "cloth_under",
    "solve",
]
