"""Exact numbers and matrices: what is none, and what is zero without a radius."""

import numpy as np
import pytest
from flint import arb

from quasistatic_ref import Extra
from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.exact.program import exact_matrix, fraction, inverse, whole_numbers
from tests.helpers import changed, random_step
from tests.oracles.rational_kkt import exact
from tests.oracles.solution_truth import program


def test_a_ball_with_a_radius_is_no_exact_number():
    with pytest.raises(ValueError, match="exact"):
        whole_numbers([arb(1) / 3])
    with pytest.raises(ValueError, match="exact"):
        fraction(arb(0, 1e-300))


def test_the_inverse_is_zero_between_what_nothing_couples():
    """0 - 1 - 2 is a chain, whose ends are coupled by its middle; 3 and 4 stand alone."""
    H = np.diag([3.0, 5.0, 7.0, 11.0, 13.0])
    H[0, 1] = H[1, 0] = H[1, 2] = H[2, 1] = 1.0
    H_inverse = inverse(exact_matrix(H))
    zero = [[v.is_zero() for v in row] for row in H_inverse.tolist()]
    alone = np.arange(5) > 2
    assert (np.array(zero) == ((alone[:, None] | alone) & ~np.eye(5, dtype=bool))).all()
    assert all(v.contains(i == j) for i, row in enumerate((exact_matrix(H) * H_inverse).tolist())
               for j, v in enumerate(row))  # fmt: skip


SCALES = [-1074, -1070, -1022, -500, 0, 130, 500, 900]


def numbers_of_one_scale(rng, shape):
    """Small integers times a power of two from that of the least subnormal number to a huge one."""
    return rng.integers(-5, 6, shape) * 2.0 ** rng.choice(SCALES)


CONES = ("pyramid", "product", "facets-6", "frictionless")


@pytest.mark.filterwarnings("ignore:(overflow|invalid)")
def test_the_bound_of_a_float_slack_holds_for_numbers_of_any_size():
    """An entry of a row may lose all its digits where J is subnormal: x may be huge there."""
    rng = np.random.default_rng(20261129)
    decided = 0
    for k in range(400):
        step = random_step(rng, n_a=1, n_u=1)
        n_c = step.contacts.n_c
        contacts = changed(
            step.contacts,
            J=numbers_of_one_scale(rng, step.contacts.J.shape),
            phi=numbers_of_one_scale(rng, n_c),
            mu_v=np.abs(numbers_of_one_scale(rng, n_c)),
            mu_omega=np.abs(numbers_of_one_scale(rng, n_c)),
        )
        own = Extra(("a", "b"), numbers_of_one_scale(rng, (2, 2)), numbers_of_one_scale(rng, 2))
        step = step.replace(contacts=contacts, extra=own, cone=CONES[k % len(CONES)])
        form = StepProgram(step)
        x = numbers_of_one_scale(rng, form.n)
        slack, error = form.float_slacks(x, np.abs(x))
        finite = np.isfinite(slack) & np.isfinite(error)
        _, _, A, b = program(step)
        off = np.abs(exact(slack[finite]) - (A @ exact(x) - b)[finite])
        assert (off <= exact(error[finite])).all()
        decided += int((finite & (np.abs(slack) > error)).sum())
    assert decided > 2000
