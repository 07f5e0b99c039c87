"""Project files of designs, and the parts of a design."""
