"""Shapes of least energy."""
