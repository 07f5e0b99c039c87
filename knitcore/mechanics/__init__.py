"""Moduli of segments, stitches and composites, and pressure, from laws."""
