"""The yarn level: a stitch as a curve that bends and touches itself."""
