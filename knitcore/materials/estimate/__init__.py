"""Laws of a yarn that the library does not hold."""
