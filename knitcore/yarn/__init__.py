"""The yarn level: stitches as elastic yarn in contact."""
