"""Yarn of any stitches: the path of every loop, its crossings, and its relaxation."""
