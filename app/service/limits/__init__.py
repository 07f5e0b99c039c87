"""Limits on each user's share of the service, and the order of users."""
