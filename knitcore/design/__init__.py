"""From wishes to fabrics: all repeats, their laws, and the ones that do what is wanted."""
