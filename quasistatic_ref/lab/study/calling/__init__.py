"""Solvers, and the interfaces through which they are called.

It makes one call in this process. Processes, times and grades are in ``measuring``. A study's
file names its solvers; one that the package does not know is called by ``guests``.
"""
