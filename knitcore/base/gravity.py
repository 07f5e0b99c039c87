"""Weight."""

STANDARD_GRAVITY_M_PER_S2 = 9.80665
"""Acceleration by which a mass has its weight: g · m/s² is mN. Source: CGPM 1901."""
