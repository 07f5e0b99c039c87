"""Readers of charts and laws from files."""
