"""Files that hold charts."""
