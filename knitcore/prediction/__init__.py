"""What will this chart of this material do?

:func:`knitcore.prediction.predict.predict` answers for every caller.
"""
