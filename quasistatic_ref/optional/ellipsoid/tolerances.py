"""Tolerances of what is proved in the ellipsoid."""

from typing import Final

ENCLOSED: Final = 1e-13
"""Largest error, in the one definition, at which an answer counts as enclosed.

Rounding the answer to float64 alone costs 1e-16; a bound much above that is the sign of a problem
almost without interior."""

IMPULSES: Final = 1e-9
"""Largest duality gap of the multipliers of an answer in the ellipsoid, relative to the energies
1/2 ||H^-1 g||_H^2 and 1/2 ||delta_q||_H^2 of its step, added; and how far the multipliers may be
outside of their cones, relative to the largest of them, where no gap is claimed.

Multipliers are not unique. Rounding them to float64 alone leaves a gap of 1e-16; a force where
nothing touches leaves a gap of the size of its work."""
