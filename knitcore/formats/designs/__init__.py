"""Files of designs."""
