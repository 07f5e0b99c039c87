"""Predict the size, stiffness and curves of a chart of a material.

Every caller uses :func:`knitcore.prediction.predict.predict`.
"""
