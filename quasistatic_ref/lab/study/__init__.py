"""Comparing solvers on contact problems whose exact answers are known.

It measures other people's solvers, and sweeps of scenarios. The package's own answers are proved
by ``certify`` and need no study.
"""
