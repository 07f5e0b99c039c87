"""A knitting house's additions to Knitcore, as an example of extensions."""
