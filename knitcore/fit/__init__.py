"""Constants of laws from measured tests and displacement fields."""
