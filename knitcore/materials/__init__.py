"""Materials: a yarn on one machine setting or needle, with one law per pure fabric."""
