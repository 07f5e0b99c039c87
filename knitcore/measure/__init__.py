"""From measurements to constants: stretch tests, hanging yarn, squeezed yarn."""
