"""Comparing solvers on contact problems whose exact answers are known."""
