"""Pieces of cloth cut along any outline, at any angle to their rows, and loaded at their edges."""

from knitcore.piece.cloth import Cloth, cloth_under
from knitcore.piece.conditions import Condition, Framed, Held, Pulled, Sewn, Traction
from knitcore.piece.outline import CutPiece
from knitcore.piece.results import ElementFields, PieceTest, write_piece_test
from knitcore.piece.solve import solve

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
    "write_piece_test",
]
