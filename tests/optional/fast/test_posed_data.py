"""Steps that a simulator posed: equal to checked ones, checked when changed; what they refuse."""

from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import StepDataError
from quasistatic_ref.optional.fast.posed import BlockStep, constants, posed
from quasistatic_ref.optional.large.sparse_contacts import SparseContacts
from tests.helpers import changed_blocks, random_stiffness

NAN = np.nan


@pytest.mark.extra("fast")
def test_a_posed_step_is_equal_to_the_checked_one_and_to_the_one_of_a_file(things):
    posed = things["posed StepData"]
    checked = posed.replace(contacts=replace(posed.contacts))
    assert checked == posed
    assert things["Trajectory"].step_data(0) == posed
    for name in ("H", "counts", "mask", "offsets"):
        np.testing.assert_array_equal(getattr(checked, name), getattr(posed, name))


@pytest.mark.extra("fast")
@pytest.mark.parametrize(
    ("name", "like"), [("posed StepData", replace), ("BlockStep", changed_blocks)]
)
def test_whatever_is_made_of_a_posed_step_is_checked(things, name, like):
    step = things[name]
    with pytest.raises(StepDataError, match=r"^tau_u: must contain finite"):
        step.replace(tau_u=np.full(step.n_u, NAN))
    with pytest.raises(StepDataError, match=r"^M_u: must be positive definite"):
        step.replace(M_u=-step.M_u)
    with pytest.raises(StepDataError, match="d1, d2, n must be"):
        step.replace(contacts=like(step.contacts, n=2 * step.contacts.n))


REFUSED = {
    "blocks of other contacts": {"blocks": lambda b: replace(b, column=b.column[1:], J=b.J[1:])},
    "NaN in a block": {"blocks": lambda b: replace(b, J=np.full_like(b.J, NAN))},
    "columns that are no numbers": {"blocks": lambda b: replace(b, column=b.column + 0.5)},
    "n of length two": {"n": lambda n: 2 * n},
}


@pytest.mark.extra("fast")
@pytest.mark.parametrize("changes", REFUSED.values(), ids=REFUSED)
def test_sparse_contacts_refuse(things, changes):
    sparse = things["SparseContacts"]
    assert isinstance(sparse, SparseContacts)
    with pytest.raises(StepDataError):
        changed_blocks(sparse, **{key: f(getattr(sparse, key)) for key, f in changes.items()})


def test_blocks_of_M_u_have_the_entries_and_couplings_of_the_whole():
    """Three bodies and an arm of two joints: K_q, and three blocks of which one couples less."""
    rng = np.random.default_rng(3)
    blocks = np.array([random_stiffness(rng, 6, 2.0) for _ in range(3)])
    blocks[1] = np.diag(np.arange(1.0, 7.0))
    K_q = np.array([[2.0, 1.0], [1.0, 3.0]])
    step = posed(BlockStep, {"h": 0.1, "K_q": K_q, "blocks": blocks, "tau_a": np.zeros(2)}, {})
    u = np.array([1, 4, 9, 13, 17])
    np.testing.assert_array_equal(step.inertia(u), step.M_u[np.ix_(u, u)])
    below_the_diagonal = np.argwhere(np.tril(step.H, -1))
    assert sorted(zip(*map(np.ndarray.tolist, step.coupled()), strict=True)) == sorted(
        map(tuple, below_the_diagonal.tolist())
    )
    for delta_q in (rng.normal(size=20), rng.normal(size=(4, 5, 20))):
        expected = delta_q[..., 2:] @ step.M_u  # which is symmetric
        np.testing.assert_allclose(step.momentum(delta_q), expected, rtol=1e-12)
    h = 0.25
    of_bodies = constants(h, np.eye(0), 0, blocks, np.zeros(0, dtype=np.int64))
    np.testing.assert_array_equal(of_bodies.H, blocks / h)  # Eq. (13)


def test_the_mass_matrix_of_another_configuration_is_checked():
    """1 and 1, and between them the float64 next to 1: the determinant is less than 0."""
    M_u = np.array([[1.0, np.nextafter(1.0, 2.0)], [np.nextafter(1.0, 2.0), 1.0]])
    constant = constants(1.0, np.eye(0), 0, np.eye(2), np.zeros(0, dtype=np.int64))
    with pytest.raises(StepDataError, match="M_u: must be positive definite"):
        constant.at(M_u)
