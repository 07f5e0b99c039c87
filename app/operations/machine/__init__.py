"""Knitting machines: their programs and their settings."""
