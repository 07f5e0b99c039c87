"""Read and write files that hold charts."""
