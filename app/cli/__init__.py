"""The command line ``knitcore``."""
