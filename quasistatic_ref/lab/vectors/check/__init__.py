"""The checker: answers of others against what is expected.

It judges answers and makes none. What is expected comes from files, or from ``layers``.
``folder`` checks all answers, ``case`` one, and ``compare`` its numbers.
"""
