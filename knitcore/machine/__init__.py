"""Knitting machines: their profiles, and programs and plans for them."""
