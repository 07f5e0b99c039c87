"""Photos of a swatch that hangs with a weight: scale, stitch spacing, points of a stretch curve."""
