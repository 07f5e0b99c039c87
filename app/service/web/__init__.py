"""The HTTP layer: access, rate limits, errors, the page and the schema."""
