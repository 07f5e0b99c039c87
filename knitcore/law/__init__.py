"""The constitutive law of a fabric, its stiffening, and pulls along one direction."""
