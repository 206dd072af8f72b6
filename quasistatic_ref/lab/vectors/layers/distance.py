"""Layer `distance`: shapes and poses -> phi, alpha, beta, n.

Its 457 cases are files. They were made once, in exact numbers; a case's tolerances are what its
own rounding comes to.
"""

from quasistatic_ref.lab.vectors.trees import Json


def own(case_input: Json) -> Json:
    """The package's closest points."""
    from quasistatic_ref.lab.vectors.own.shapes import own_closest_points

    return own_closest_points(case_input)
