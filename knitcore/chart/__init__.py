"""Charts of knit and purl stitches: segments, phases, repeats, patterns, fabrics."""
