"""Branch ``published``: the paper's own description of a stitch, eight Bezier curves in a row."""
