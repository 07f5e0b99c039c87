"""Linear algebra with one order of sums: dense kernels and sparse Cholesky factors."""
