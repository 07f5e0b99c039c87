"""Inverse design: from target properties to repeats and charts."""
