"""Every tolerance of the tests, with its reason."""

EXACT = 0.0
"""The two sides are the same floating-point operations, or exact ones: equal bits."""

ROUNDING = 1e-12
"""The same finite sum of at most some hundred terms of size one, added up in another order."""

OPTIMUM = 1e-6
"""Agreement of any backend with the truth in the one definition of error."""

ACTIVE_SET = 1e-9
"""Agreement of two solves by an active-set method at 1e-12: conditioning costs three digits."""

MULTIPLIERS = 1e-6
"""Forces and multipliers against their largest: they carry a conditioning more than delta_q."""

WRONG = 1e-2
"""A relative residual above this is another equation, not a rounding of the same one."""

NATURAL_LOW = 0.5
"""Least diagonal of H in natural units: units are powers of two, rounded by at most sqrt 2."""

NATURAL_HIGH = 2.0
"""Greatest diagonal of H in natural units, for the same reason."""

DIFFERENCE_STEP = 1e-5
"""Step of central differences [m or rad]: near the cube root of 2.2e-16, where truncation
(step^2 = 1e-10) and cancellation (2.2e-16 / step = 2e-11) are both small."""

DIFFERENCE = 1e-8
"""Jacobians against central differences with that step: truncation is at most step^2 / 6 times a
third derivative, below 100 for chains of a metre, so 2e-9; a wrong column is off by 0.1 or more."""

THRESHOLD = 1e-6
"""How near to its threshold of slip a grasp is tried: the answers are exact or enclosed to
1e-13, so what limits it is the rounding of the threshold itself, 1e-16."""


SIGNED_DISTANCE = 1e-12
"""Closed-form distances [m] and normals against another closed form or coal, at sizes of a metre:
some ten operations, each of 1e-16."""

CLOSED_FORM = 1e-12
"""Distances [m] and normals of shapes of 0.1 m by closed forms: rounding is 1e-16."""

OF_DIFFERENCE = 1e-15
"""Error of coordinates of decimetres [m], a few roundings of them: over the distance of two points
[m], that of the direction from one to the other [-]."""

CURVED_PAIR = 1e-12
"""Convex pairs, whatever way leads to their answer [m], [-]: Newton's method and the closed forms
end at rounding, 1e-15 of the sizes, which are below 1 m."""

COAL = 1e-6
"""Convex pairs by coal's iterative solvers, which stop at 1e-6 [m], [-]."""

WAY_OUT = 1e-8
"""Distance of witness points from the surfaces [m] where two polytopes are parallel but for 1e-6:
a gap that is right to 1e-13 leaves its square root of lateral freedom."""


SCENARIO = 1e-6
"""Steady states of whole scenarios against their closed forms: exact steps, but transients of a few
hundred of them and poses that are rounded at each."""

FIRST_ORDER = 1e-3
"""Steady motions whose closed form holds to first order in h, or at the start of a slow turn."""

JAX_STEP = 1e-6
"""By what JAX moves its arguments to check a gradient [of their units]: rounding of a step, 1e-16,
is then 1e-10 of the difference, and its error of the second order is as little."""

JAX_GRADIENT = 1e-7
"""Gradients against JAX's differences with that, absolute plus relative."""

DIFFERENCE_OF_STEPS = 1e-7
"""Derivatives of a step against Richardson's differences in float64, relative to the largest
entry: steps are right to 1e-16 of a metre, 1e-11 after division by the difference's 1e-5, times the
conditioning of the contacts; a mistake of the geometry is a tenth."""

QUASI_STATIC = 5.0
"""Times the quasi-dynamic number: how far a slow push may be from Lynch's motion, relative to it.
(R28) has the distance as Pi (rho^2 / chi^2 - 1) and more, of which the factor is below 5 here."""
