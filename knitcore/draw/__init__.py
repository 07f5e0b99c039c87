"""Shapes for pictures: loops of yarn on the (deformed) lattice of stitches."""
