"""Questions to the yarn level, one file each."""
