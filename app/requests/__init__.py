"""Parts of requests and results that several operations share."""
