"""Results of the yarn level: packaged relaxed repeats, their build, and tables of yarns."""
