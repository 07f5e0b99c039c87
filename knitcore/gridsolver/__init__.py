"""A sparse Cholesky factorisation for quarter grids, by nested dissection."""
