"""One question: what will this chart of this material do?

:func:`knitcore.answer.choose.choose` answers it for every caller.
"""
