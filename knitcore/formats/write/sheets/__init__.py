"""Sheets of paper that are read at the needles or at the machine."""
