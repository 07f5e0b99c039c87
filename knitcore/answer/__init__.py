"""One question: what will this chart, knitted in this material, do?"""
