"""Long computations in the background: progress, cancelling, fair turns, stored results."""
