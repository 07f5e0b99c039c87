"""Errors of the service as problem details (RFC 9457): their kinds, what clients read of them."""
