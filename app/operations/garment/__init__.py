"""Garments, and the pressure of tubes on limbs."""
