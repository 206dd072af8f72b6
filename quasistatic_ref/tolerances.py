"""Every tolerance of the package, with its reason; those of the tests are in tests/."""

from typing import Final

ORTHONORMAL: Final = 1e-9
"""Largest entry of R'R - I for a contact frame R = [d1 d2 n], and of a rotation read from a file.

Frames computed in float64 reach 1e-15; ones that travelled as 10-digit text reach 1e-10."""

SYMMETRIC: Final = 1e-12
"""Largest |S - S'| relative to the largest entry of a stiffness or mass matrix.

Rounding in a mass matrix leaves 1e-16; anything above 1e-12 is another matrix. What is smaller
is removed: the lower triangle counts."""

ACCURACY: Final = 1e-12
"""Default accuracy asked of every backend, in natural units [-].

The tightest at which Clarabel, OSQP and PIQP still solve every step of ``bunny_grasp``."""

RESIDUAL_LIMIT: Final = 1e-6
"""Largest residual, in natural units [-], at which a solver's "optimal" is believed.

Six orders above the accuracy asked for: an answer beyond it is not a less exact answer but
a wrong one."""

ILL_POSED: Final = 1e6
"""Longest certified step, in the H norm and relative to what the step asks for by itself: the
larger of the unconstrained step and the longest push-out of a single row.

Nearly contradictory contacts have exact optima of 1e13 m; steps of grasps stay below 1e2."""
