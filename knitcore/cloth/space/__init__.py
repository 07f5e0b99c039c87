"""Sheets of stitches in space: how a piece curls, folds, hangs and drapes."""
