"""The study file, read.

It checks fields and knows no measurement. What a study has measured is in ``store``.
"""
