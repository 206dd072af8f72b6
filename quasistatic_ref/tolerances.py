"""Tolerances of the package, each with its reason; those of the tests are in tests/.

A threshold that matters to one file alone, such as that of a guess, may stand in that file.
"""

from typing import Final

ORTHONORMAL: Final = 1e-9
"""Largest entry of R'R - I for a contact frame R = [d1 d2 n], and of a rotation read from a file.

Frames computed in float64 reach 1e-15; ones that travelled as 10-digit text reach 1e-10."""

SYMMETRIC: Final = 1e-12
"""Largest |S - S'| relative to the largest entry of a stiffness or mass matrix.

Rounding in a mass matrix leaves 1e-16; anything above 1e-12 is another matrix. What is smaller
is removed: the lower triangle counts."""

DEFINITE: Final = 1e-14
"""Smallest pivot of a stiffness or mass matrix relative to its diagonal entry, which has the same
unit; decided without rounding (step/pivots.py).

Cholesky of a singular matrix leaves rounding of 1e-16 for a pivot; a matrix this near to one has
a condition number above 1e14, and its inverse no correct digit."""

ACCURACY: Final = 1e-12
"""Default accuracy of every backend, in natural units [-].

With it Clarabel, DAQP and PIQP solve every step of ``bunny_grasp``, and so does OSQP, which is then
called with 1e-10, the least accuracy that the table of backends gives it."""

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

COMPLIANCE: Final = 2e-9
"""Compliance of a group's contacts over the least mobility of what they touch [-].

A body that rests on its contacts loses so much of its weight, the lowest of 20 like it 100 times as
much (R43): less than 1e-6. A last bit of phi, 1e-17 m, changes the forces of a body that bears its
weight by 1e-5 of it at h = 10 ms, and by 1e-3 at 1 ms."""

HARDLY_MOVES: Final = 1e-3
"""Mobility of a side along a principal direction, relative to its largest [-], below which loads
along it count less and less as loads of the side: at the square of this not at all. A free body has
1 / m at least, and more than 1000 times as much only where it is 30 times as far from its centre as
its mass is."""

BORNE: Final = 1e-4
"""Share of the load [-] that forces of single contacts may leave without a finding."""

SURE: Final = 1e-3
"""Share of the load of a group [-] that noise in its gaps may change without a finding."""

RESIDUAL_LIMIT: Final = 1e-6
"""Largest residual, in natural units [-], at which a solver's "optimal" is believed.

Six orders above the default accuracy: an answer beyond it is not a less exact answer but
a wrong one."""

WORTHLESS: Final = 1.0
"""The largest error bound [-] that says anything: where no contact penetrates, x = 0 and lam = 0
have an error bound of 1."""

BOUNDED: Final = 1e-6
"""Largest bound of an answer's error, computed in float64 [-], that is kept as it is.

Of an exact answer float64 gives a bound of about 1e-7. A bound above 1e-6 is computed again in
balls, which give 1e-8."""

FAR: Final = 100.0
"""Distance, in natural units [-], beyond which a contact is as good as infinitely far.

The unconstrained step has a length of about one. Solvers lose digits where 1e6 and 1 stand
together; a row that is put at 100 stays inactive, and the judge, who has the true distance, would
notice if it did not."""

WITNESS: Final = 1e-10
"""Largest disagreement of a convex pair's closest points with its distance and normal, relative to
the pair's size [-]. Refined answers are at 1e-15; a wrong one disagrees by the size."""

PROVED_NORMAL: Final = 1e-6
"""Largest disagreement of a convex pair's closest points with its distance and normal, relative to
that distance [-]: the normal is right to about as much [rad]. Below 1e-14 of the pair's size it is
rounding."""

INERTIA_TRIANGLE: Final = 1e-6
"""How far the largest principal moment of inertia may exceed the sum of the other two, relative.

A flat plate has equality; six printed digits break it by up to 1e-6."""

LOADED: Final = 1e-9
"""Largest difference between what a URDF says and what was loaded, relative to its size.

Rotations travel through quaternions and chains of products, 1e-15 a link; what was dropped or
misread differs by far more."""

WELDED: Final = 1e-12
"""Largest relative velocity, per unit of any coordinate [-], of two links that count as one.

Chains of rotations leave 1e-15 a link; a joint between them moves one of them by 1."""

UNIT_QUATERNION: Final = 1e-9
"""Largest | |x| - 1 | of a quaternion, or of a pair (cos, sin), that is taken for a unit one.

A length 1 + e changes lever arms by 2 e of themselves, so that 1e-9 changes a gap under an arm of
0.1 m by 2e-10 m. 10^6 steps leave less; float32 leaves up to 6e-8, and is refused with a remedy."""

UNIT_ROUNDING: Final = 1e-15
"""Largest | |x| - 1 | that is left alone: normalising in float64 leaves up to two units of 2.2e-16
in the length as computed, so that what was normalised once is not touched again."""

LARGE: Final = 1e15
"""Largest number in a scenario, a URDF or a point cloud, in whatever unit.

Nothing that is simulated is larger; squares and fourth powers of it stay in float64's range."""

SHORT: Final = 1e-15
"""Smallest length of a shape [m], about a proton's; quotients of lengths stay in float64's range.
"""

ILL_POSED: Final = 1e6
"""Longest certified step: its length in the H norm over the largest of four lengths [-]. Three are
the lengths of the unconstrained steps that the targets, tau_a and tau_u would each cause alone; the
fourth is that of the longest push-out b_i / ||a_i|| of a single row, in the norm of H^-1.

Nearly contradictory contacts have exact optima of 1e13 m; steps of grasps stay below 1e2."""

UNMOVED: Final = 1e-6
"""Displacement of the softest coordinate [m, rad] that errors are at least measured by: where
nothing happens, an answer that is off by 1e-14 m or rad has 8 digits. Steps that move are longer
(certify/norm.py)."""

CONVEX_EXCESS: Final = 1e-3
"""Largest excess of a convex hull over its mesh, relative to size and to volume, at which the mesh
counts as convex [-]. Single precision and coarse modelling leave 1e-5; a real dent is larger."""

ON_SURFACE: Final = 1e-12
"""Distance relative to a polytope's size below which its edges and corners count as its faces [-].

A direction computed from two points that near has fewer than four correct digits."""

OUTSIDE_FACE: Final = 1e-14
"""How far outside of the nearest face of a polytope a point projects onto its plane, relative to
the sizes, from which an edge or a corner is the nearest [-]: some ten roundings of coordinates.
Where it is less, the face's normal is as right as the direction of a difference of coordinates."""

UPRIGHT: Final = 1e-9
"""Tilt of a cylinder or a cone [rad] below which its rim counts as level.

The direction of its lowest point is then rounding; on a rim of 1 m all points are level to 1 nm."""

SUPPORT_DEFECT: Final = 1e-9
"""Difference between coal's distance and the gap along its normal, relative to the shapes' size, at
which its answer is taken at once [-]. What is right to rounding is at 1e-12 and below."""

REPEATED: Final = 1e-9
"""Largest difference of distance [m], point [m] and normal [-] of candidates that are one contact.

Computed twice, one contact differs by 1e-16, or 3e-9 at worst between nearly parallel edges."""

RANKED: Final = 1e-9
"""Fraction of the size of a pair's smaller shape to whose nearest multiple distances are rounded
before contacts rank by them [-].

Distances of what lies still change by some 1e-17 m from step to step, by 1e-16 of places; a contact
that is left out for another of the same rank is at most that much nearer."""

SPANNED: Final = 1e-6
"""How far out of the convex hull of other contacts a closest pair may be, relative to the smaller
shape [-], for its rows to follow from theirs: on surfaces that are nearly parallel closest points
are not known better."""

FACING: Final = 0.25
"""Angle [rad] between a face and the face that it can lie on after a step: a step that turns by
more is worth a warning (LEAP)."""

TIED_FACES: Final = 1e-12
"""Difference of heights over two faces, or of the gaps along two normals, relative to sizes and
places, at which they count as equal [-]. Places are right to 1e-16, and a body that rests on
another stays where it is to about that."""

TOUCHING_FACES: Final = 1e-9
"""Depth relative to the same at which bodies that are as deep along two normals touch [-]: with one
between them. Deeper, the push-out along it would part them along neither."""

OVER_FACE: Final = 1e-9
"""How far outside of a face the foot of a corner may be, relative to the shape's extent [-], for
the corner to be over the face: a body that is flush with another turns by about that."""

SKEW: Final = 1e-6
"""Sine of the angle between two edges or rims [-] up to which they have no crossing: its place is
known to rounding over that, and corners next to it bound the common area as well."""

SAME_NORMAL: Final = 1e-6
"""Largest difference of the components of two normals that count as one [-]: the coplanar
triangles of a mesh, or the face of one body and the face of another that lies flat on it."""

FILLED: Final = 1e6
"""Least distance [m] of a contact that stands for nothing.

It repeats one that is at most half as far, and so bears nothing however long the step is."""

CLOSED_FORM: Final = 1e-12
"""Largest difference of a certified step from its closed form, relative to the largest term.

The optimum is exact and rounded once; formula and data are a few dozen operations in float64."""

COULOMB_RESIDUAL: Final = 1e-12
"""Largest difference of s from that of the next iterate, relative to the longest motion of a
contact [-], at which s is its own: each iterate is exact, and s a sum of rounded products."""

GAIN: Final = 0.01
"""Residual of s over that of the iterate before [-] up to which an extrapolated iterate is kept.
Kept at 0.5, extrapolation ended at local minima of the residual in 29 of 600 random planar steps of
one to four contacts; at 0.01 in none of 500."""

EXTRAPOLATED: Final = 1e-10
"""Least singular value, relative to the largest [-], of the changes of residuals that s is
extrapolated from: they are right to 1e-16 of s, and what is left of smaller ones is rounding."""

BEARS: Final = 1e-9
"""Least normal force of a contact that bears load, over the largest normal force of its step [-]:
solvers leave 1e-12 of the largest on contacts that do not touch."""

SLOW: Final = 0.1
"""Largest share of the friction that contacts can bear [-] which the spurious drag may take without
a warning: forces on moving bodies are then wrong by a tenth of that friction."""

SUNK: Final = 0.01
"""Depth at a step, relative to the smaller shape of a pair [-], that the step before did not
predict and that is worth a warning: pushed out at once, it throws bodies about. The scenarios in
models/ stay below 1e-5; points that a pair's k leaves out sink by the size of its features."""

LEAP: Final = 0.25
"""Motion per step, relative to the size of what is moved [-], or turn [rad], that is worth a
warning: to first order the motion is wrong by 1 - cos 0.25 = 3 % of the size. The spun sphere of
sphere_spin reaches 0.15."""

CRAWL: Final = 0.1
"""Speed [m/s, rad/s] up to which contacts that cannot rise may hold a body without a finding: what
is moved slowly enough for the model is slower."""

LOCKED: Final = 0.1
"""Share of the motion without a guide's own friction [-] below which a body is locked by it. A
block that begins to slide has 1 / (1 + mu_v^2) of it, one in a guide the guide's clearance."""

BEYOND: Final = 1e-9
"""How far a target may exceed a limit of its URDF [m, rad] without a warning: rounding of its
interpolation between waypoints is 1e-16."""

IN_METRES: Final = 20.0
"""Size of a mesh or cloud, and largest coordinate of a target that is a length [m], up to which
numbers are taken for metres.

What hands hold is longer than 20 mm, mostly, and shorter than 20 m."""

ALIKE: Final = 1e3
"""Largest ratio of the lengths of a step's rows, in natural units [-], at which a solver is called
that may not return. On rows of very different lengths quadprog 0.1.14 may loop without end, and
HiGHS 1.16 may end the process; the steps of the scenarios in models/ stay below 3."""

FITTED: Final = 0.02
"""Largest difference of a fitted exponent from the exponent of the law it is to show."""

DENSE_BELOW: Final = 600_000
"""Entries of J, 4 n_c n_v, of the largest group of bodies below which `fast` asks DAQP, whose
matrices are dense, where no backend is named."""

TOUCHING: Final = 1e-14
"""Slack of a row, relative to the numbers that it is a sum of, at which it counts as none where a
derivative is computed [-]: some fifty roundings of 2e-16."""

BEARING: Final = 1e-11
"""Multiplier of a row at which it counts as none where a derivative is computed: the displacement
that it causes over that of the step, in the H norm [-]. That is the rounding of places, 1e-16 m,
over a step of 1e-5 m."""

SHARE: Final = 1e-3
"""Of what all rows exert, what a row is tried to bear [-]: so much more than rounding that what
misses is known to nine digits, and so little that the other rows are those that bear."""

AHEAD: Final = 1e-6
"""Change of a force, relative to it, up to which rows are tried to bear it on [-]: a million times
the rounding that would hide that it leaves their cone."""

DEPENDENT: Final = 1e-8
"""Singular value of rows of length one up to which it counts as zero [-], where no derivative
depends on it: a row this near to the span of others is counted as spanned."""

INDEPENDENT: Final = 3e-4
"""Least singular value of rows of length one that are independent where a derivative is computed
[-]. Displacements are right to 1e-16 divided by it, and derivatives to 1e-16 divided by its square:
to 1e-9."""

SPLIT: Final = 1e-12
"""Largest singular value of rows, or of the equations of a closest pair, that is rounding [-]:
geometry splits the rows of bodies that lie flat on each other by 1e-15. Rows between this and
INDEPENDENT hold at once or do not, and normals between this and UNIQUE are not known."""

CONSISTENT: Final = 1e-11
"""Largest rate at which dependent rows leave each other, or straight surfaces in line with each
other, relative to the terms that make it, that is rounding [-]: random states are at 1e-13 and
below. A rate that is let pass leaves an error of about ten times its size."""

ON_RIM: Final = 1e-9
"""How near to the rim of a face or edge a closest point, relative to its shape, or a normal [-] is
on it. Closest points are right to 1e-15 but where the surfaces are nearly parallel."""

LEVEL: Final = 1e-5
"""Tilt of a cylinder or a cone [rad] below which its rim counts as level where a derivative is
computed. Its lowest point moves by 1 / tilt of a turn, right to 2e-16 / tilt of that; where it
cancels, errors were 1e-7 at a tilt of 3e-7, and fall with its square."""

UNIQUE: Final = 1e-6
"""Least singular value of the equations of a closest pair, lengths over the pair's size or its
distance from the world's origin, whichever is larger, at which the pair counts as unique [-].
Places are right to 2e-16 of that length, and the solution to 2e-10. Parallel faces leave 1e-16."""

NEARLY: Final = 1e-9
"""First-order distance to the next kink, in natural units [-], below which a derivative that
exists gives way to those of both sides. A step is about one, and a settled scene creeps to its
kinks by 1e-12 of it and less; differences of usable steps do not see a derivative that ends so
soon."""

FACET: Final = 1e-8
"""Product of a row of length one and the unit normal of a facet at which the row lies on it [-]:
a hundred times what HiGHS leaves."""

INSIDE: Final = 1e-6
"""A load or a motion that is at least this far inside of a cone, relative to its own size [-],
stays inside when the normal of the cone turns by TIED and float64 rounds."""

TIED: Final = 1e-10
"""Difference of two distances, relative to the pair's size, at which they count as equal [-]:
REPEATED for sizes of some decimetres."""

LIGHT: Final = 1e-6
"""Mass of a private rise over that of what it lies on [-]: sliding is slower by as much, (R40)."""

FULL_RANK: Final = 1e-9
"""Part of a row of MuJoCo's that counts, over the largest of its terms, and smallest eigenvalue of
K_q, in natural units [-].

Rounding leaves 1e-16 of the terms of a row that is zero or depends on others, and would make it a
constraint of its own; a lever that is shorter than this asks for 1e9 times the load."""

DEEP: Final = 1e-3
"""Penetration that an answer mentions [m]: MuJoCo's contacts at rest are about 0.1 mm deep."""

NEAR: Final = 1e-3
"""Distance that counts as near [m]: what cameras and calibration leave open."""

TOUCHES: Final = 1e-9
"""Slack of a row of a contact that touches, at most [m]: certified steps leave rounding, 1e-16, and
a spring of 1e5 N/m presses 1e-9 m with 0.1 mN."""

SLIDES: Final = 1e-4
"""Slip of a contact that an account says slides, at least [m/s]: 1 mm in ten seconds."""

SPINS: Final = 1e-3
"""Turn about its normal of a contact that an account says spins, at least [rad/s]: 0.6 deg in ten
seconds."""

ROUGH: Final = 5.0
"""Friction coefficient above which a number is none [-]: racing tyres have 1.7."""

SLIPPED: Final = 0.1
"""Slip of a grip that lost what it held, over the smaller shape of a pair [-]: a body that settles
between fingers slips by a hundredth of them."""

LAGS: Final = 0.1
"""Distance of a joint from its last target, over the way that its target went [-], that is none of
a spring's usual lag."""

STALLED: Final = 0.25
"""The same distance over the shape that presses [-], of what is to push and not to press."""
LIES_FLAT: Final = 1e-3
"""Gap of a corner over the size of the smaller of two shapes, up to which it counts as closed where
they are closed elsewhere [-]. Drake has one contact of two shapes, on which a box that stands rocks
by some 1e-4 of its size."""

CREEP: Final = 1e-4
"""Speed up to which a contact of another simulator holds [m/s]: 6 mm in a minute. Friction that is
regularised yields to any force, so that some speed has to count as none."""

FAST: Final = 0.1
"""Speed up to which a body creeps [m/s]: that of a fall of 10 ms. MuJoCo's friction yields by
f R / b, with default softness up to 10 mm/s under the weight of a body, and with a soft one to some
60 mm/s; what is faster moves by its inertia, of which a step from rest says nothing."""

STEADY: Final = 0.5
"""Change of a mean velocity from a tenth of a second to the next, over the velocity, up to which a
body creeps [-]: what falls or swings from rest is three times as fast."""

INSIDE_CONE: Final = 0.98
"""Share of a contact's limit up to which its friction could bear more [-]: a contact that slides is
at its limit but for the error of the other solver, some 0.1 %."""

PIERCES: Final = 0.25
"""Depth of two bodies in each other over the size of the smaller one, from its centre of mass to
its farthest point, above which they are not rigid, whatever presses them there [-]."""

PRESSES: Final = 2.0
"""Normal forces of another simulator over the exact ones, from which on penetration counts as their
cause [-]: forces that no load determines differ by some per cent at rest."""

FORCES_AGREE: Final = 0.01
"""Relative difference of normal forces, up to which they agree [-]; what is less than this part of
the weight of a model counts as no force."""
