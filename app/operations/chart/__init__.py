"""Charts and what is predicted of them."""
