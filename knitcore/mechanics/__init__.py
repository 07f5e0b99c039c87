"""From laws and segments to moduli, composites and pressure."""
