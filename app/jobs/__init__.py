"""Long computations in the background: progress, cancel, fair turns, results kept by content."""
