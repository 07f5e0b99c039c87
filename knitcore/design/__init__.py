"""From wishes to fabrics: all small repeats, their laws, and a search among them."""
