"""What StepData and Contacts accept, refuse and keep."""

import numpy as np
import pytest

from quasistatic_ref import Contacts, Extra, StepDataError
from quasistatic_ref.numbers.pivots import SYMMETRIC
from quasistatic_ref.tolerances import ORTHONORMAL
from tests.cases import cases, refusal
from tests.closeness import assert_same
from tests.helpers import changed, random_step
from tests.made import no_contacts

STEP = random_step(7, n_a=2, n_u=3, rows=(6, 4))
CONTACTS = STEP.contacts
NAN = float("nan")
INF = float("inf")

STEP_REFUSALS = {
    "h zero": ({"h": 0.0}, "h:"),
    "h NaN": ({"h": NAN}, "h:"),
    "h a word": ({"h": "0.01"}, "h:"),
    "h an integer beyond float": ({"h": 10**400}, "h:"),
    "cone unknown": ({"cone": "cube"}, "cone:"),
    "K_q of another size": ({"K_q": np.eye(3)}, "K_q:"),
    "K_q not symmetric": ({"K_q": [[2.0, 1.0], [0.0, 2.0]]}, "K_q: must be symmetric"),
    "K_q indefinite": ({"K_q": [[1.0, 2.0], [2.0, 1.0]]}, "K_q: must be positive definite"),
    "M_u of another size": ({"M_u": np.eye(4)}, "M_u: must have shape (3, 3)"),
    "M_u of a massless link": ({"M_u": np.diag([1.0, 1.0, 0.0])}, "M_u: must be positive"),
    "M_u infinite": ({"M_u": np.diag([INF, 1.0, 1.0])}, "M_u: must contain finite"),
    "tau_a words": ({"tau_a": ["a", "b"]}, "tau_a: must be numbers"),
    "tau_a with a truth value": ({"tau_a": [0.5, True]}, "tau_a: must be numbers"),
    "tau_a too long": ({"tau_a": np.zeros(3)}, "tau_a: must have shape (2,)"),
    "tau_u too long": ({"tau_u": np.zeros(4)}, "tau_u: must have shape (3,)"),
    "tau_u infinite": ({"tau_u": [0.0, -INF, 0.0]}, "tau_u: must contain finite"),
    "delta_q_bar_a too short": ({"delta_q_bar_a": [0.0]}, "delta_q_bar_a:"),
    "contacts of another width": ({"contacts": no_contacts(4)}, "contacts.J:"),
    "extra of another width": ({"extra": Extra(("a",), np.ones((1, 4)), [0.0])}, "extra.A:"),
}

CONTACT_REFUSALS = {
    "phi too long": ({"phi": [0.0, 0.0, 0.0]}, "contacts.phi:"),
    "phi NaN": ({"phi": [0.0, NAN]}, "contacts.phi: must contain finite"),
    "J of three rows": ({"J": np.zeros((2, 3, 5))}, "contacts.J:"),
    "mu_v negative": ({"mu_v": [0.5, -0.1]}, "contacts[c1].mu_v: must be >= 0"),
    "mu_omega negative": ({"mu_omega": [-1e-9, 0.1]}, "contacts[c0].mu_omega: must be >= 0"),
    "rows ragged": ({"rows": [4, [6]]}, "contacts.rows:"),
    "five rows": ({"rows": [6, 5]}, "contacts.rows: must be 4 or 6"),
    "n not a unit vector": ({"n": 2 * CONTACTS.n}, "contacts[c0]: d1, d2, n must be"),
    "left-handed": ({"d1": -CONTACTS.d1}, "contacts[c0]: d1, d2, n must be"),
    "n in the plane": ({"n": CONTACTS.n[:, :2]}, "contacts.n:"),
}


@cases("changes, says", STEP_REFUSALS)
def test_a_step_refuses(changes, says):
    with refusal(StepDataError, says):
        STEP.replace(**changes)


@cases("changes, says", CONTACT_REFUSALS)
def test_contacts_refuse(changes, says):
    with refusal(StepDataError, says):
        changed(CONTACTS, **changes)


def test_arrays_without_columns_are_refused():
    for build in (lambda: Contacts((), *[[]] * 8), lambda: Extra((), [], [])):
        with pytest.raises(StepDataError):
            build()


def test_a_frame_passes_just_inside_the_tolerance_and_not_outside():
    def tilted(angle):
        return np.cos(angle) * CONTACTS.n + np.sin(angle) * CONTACTS.d1

    assert changed(CONTACTS, n=tilted(0.5 * ORTHONORMAL)).n_c == 2
    with pytest.raises(StepDataError):
        changed(CONTACTS, n=tilted(2 * ORTHONORMAL))


def test_a_matrix_is_made_symmetric_from_its_lower_triangle():
    K_q = np.array([[2.0, 1.0 + SYMMETRIC], [1.0, 3.0]])
    kept = STEP.replace(K_q=K_q).K_q
    assert_same(kept, [[2.0, 1.0], [1.0, 3.0]])
    with pytest.raises(StepDataError):
        STEP.replace(K_q=[[2.0, 1.0 + 4 * SYMMETRIC], [1.0, 3.0]])


def test_minus_zero_becomes_zero():
    step = STEP.replace(
        tau_a=[-0.0, 1.0], tau_u=-np.zeros(3), contacts=changed(CONTACTS, phi=[-0.0, -0.0])
    )
    for array in (step.tau_a, step.tau_u, step.contacts.phi):
        assert not np.signbit(array).any()


def test_the_caller_s_own_array_is_copied_not_locked():
    tau_a = np.array([1.0, 2.0])
    step = STEP.replace(tau_a=tau_a)
    tau_a[0] = 5.0
    assert_same(step.tau_a, [1.0, 2.0])


def test_arrays_cannot_be_written():
    def arrays(data):
        return [value for value in vars(data).values() if isinstance(value, np.ndarray)]

    found = [*arrays(STEP), *arrays(CONTACTS), *arrays(STEP.extra), STEP.mask, STEP.offsets]
    assert len(found) >= 5 + 8 + 2 + 2
    assert not any(array.flags.writeable for array in found)
