"""Ground floor: arrays, checks, errors, compiled functions, batches, extensions."""
