"""Files, and what is installed."""
