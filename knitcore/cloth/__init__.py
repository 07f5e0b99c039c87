"""Finite pieces of cloth: flat between clamps, cut along an outline, in space."""
