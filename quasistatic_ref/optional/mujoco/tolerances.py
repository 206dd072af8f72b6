"""Tolerances of what is said of scenes of MuJoCo."""

from typing import Final

FULL_RANK: Final = 1e-9
"""Part of a row of MuJoCo's that counts, over the largest of its terms, and smallest eigenvalue of
K_q, in natural units [-].

Rounding leaves 1e-16 of the terms of a row that is zero or depends on others, and would make it a
constraint of its own; a lever that is shorter than this asks for 1e9 times the load."""

DEEP: Final = 1e-3
"""Penetration that an answer mentions [m]: MuJoCo's contacts at rest are about 0.1 mm deep."""

FAST: Final = 0.1
"""Speed up to which a body creeps [m/s]: that of a fall of 10 ms. MuJoCo's friction yields by
f R / b, with default softness up to 10 mm/s under the weight of a body, and with a soft one to some
60 mm/s; what is faster moves by its inertia, of which a step from rest says nothing."""

STEADY: Final = 0.5
"""Change of a mean velocity from a tenth of a second to the next, over the velocity, up to which a
body creeps [-]: what falls or swings from rest is three times as fast."""

INSIDE_CONE: Final = 0.98
"""Share of a contact's limit up to which its friction could bear more [-]: a contact that slides is
at its limit but for the error of MuJoCo's solver, some 0.1 %."""

PIERCES: Final = 0.25
"""Depth of two bodies in each other over the size of the smaller one, from its centre of mass to
its farthest point, above which they are not rigid, whatever presses them there [-]."""

PRESSES: Final = 2.0
"""Normal forces of MuJoCo's over the exact ones, from which on penetration counts as their
cause [-]: forces that no load determines differ by some per cent at rest."""

FORCES_AGREE: Final = 0.01
"""Relative difference of normal forces, up to which they agree [-]; what is less than this part of
the weight of a model counts as no force."""
