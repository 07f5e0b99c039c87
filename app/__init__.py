"""The service and the command line around ``knitcore``."""
