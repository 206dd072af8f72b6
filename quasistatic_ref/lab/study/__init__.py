"""Comparing solvers on contact problems whose exact answers are known.

It measures other solvers. The answers of the package are proved by ``certify``, and need no study.
"""
