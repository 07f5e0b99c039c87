"""Home machines: plans by the row, pictures for AYAB and punch cards."""
