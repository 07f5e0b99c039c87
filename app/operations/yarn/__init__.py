"""Yarns, and stitches at the yarn level."""
