"""Solvers, and the interfaces through which they are called.

It makes one call in this process. Processes, times and grades are in ``measuring``. An
installed solver is added by a line of ``study_only`` (of ``solve/backends.py`` if steps are solved
with it), ``study/options/NAME.toml``, and a row of ``exit_codes.toml``.
"""
