"""Tolerances that several files of derivatives share."""

from typing import Final

DEPENDENT: Final = 1e-8
"""Singular value of rows of length one up to which it counts as zero [-], where no derivative
depends on it: a row this near to the span of others is counted as spanned."""

SPLIT: Final = 1e-12
"""Largest singular value of rows, or of the equations of a closest pair, that is rounding [-]:
geometry splits the rows of bodies that lie flat on each other by 1e-15. Rows between this and
INDEPENDENT hold at once or do not, and normals between this and UNIQUE are not known."""

CONSISTENT: Final = 1e-11
"""Largest rate at which dependent rows leave each other, or straight surfaces in line with each
other, relative to the terms that make it, that is rounding [-]: random states are at 1e-13 and
below. A rate that is let pass leaves an error of about ten times its size."""

UNIQUE: Final = 1e-6
"""Least singular value of the equations of a closest pair, lengths over the pair's size or its
distance from the world's origin, whichever is larger, at which the pair counts as unique [-].
Places are right to 2e-16 of that length, and the solution to 2e-10. Parallel faces leave 1e-16."""

NEARLY: Final = 1e-9
"""First-order distance to the next kink, in natural units [-], below which a derivative that
exists gives way to those of both sides. A step is about one, and a settled scene creeps to its
kinks by 1e-12 of it and less; differences of usable steps do not see a derivative that ends so
soon."""

TIED: Final = 1e-10
"""Difference of two distances, relative to the pair's size, at which they count as equal [-]:
REPEATED for sizes of some decimetres."""

LEVEL: Final = 1e-5
"""Tilt of a cylinder or a cone [rad] below which its rim counts as level where a derivative is
computed. Its lowest point moves by 1 / tilt of a turn, right to 2e-16 / tilt of that; where it
cancels, errors were 1e-7 at a tilt of 3e-7, and fall with its square."""
