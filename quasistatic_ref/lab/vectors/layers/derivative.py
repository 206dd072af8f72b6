"""Layer `derivative`: of q+ by q, q_bar_a, forces and parameters, or why there is none.

Its 337 cases are files. They were made once, as differences of steps without any rounding from the
mechanism to q+, each proved to 15 digits by a second difference.
"""

from quasistatic_ref.lab.vectors.trees import Json

FIELDS = {
    "q": "dq_dq",
    "q_bar_a": "dq_dq_bar_a",
    "tau": "dq_dtau",
    "mu_v": "dq_dmu_v",
    "mu_omega": "dq_dmu_omega",
    "K_q": "dq_dK_q",
    "h": "dq_dh",
    "m": "dq_dm",
}
"""Name of each derivative in the output, a matrix of n_v rows; of h a list."""
SHARE = 1e-9
"""Of the largest entry, or of what the free step would show: the tolerance in the files."""


def own(case_input: Json) -> Json:
    """The package's derivatives of q+, or why there are none."""
    from quasistatic_ref.lab.vectors.own.derivative import own_derivative

    return own_derivative(case_input)
