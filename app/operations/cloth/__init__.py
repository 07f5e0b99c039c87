"""Cloth between clamps, cut, in space."""
