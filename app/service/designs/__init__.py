"""Designs that are kept: edited by several people, versioned, shared and recoverable."""
