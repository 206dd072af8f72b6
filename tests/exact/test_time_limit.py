"""A limit of time ends an exact answer in one sentence, and nothing else."""

from threading import Thread

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.exact import time_limit
from quasistatic_ref.exact.qp import guess


def hard(n=30):
    """A program that is sought from a cold start: rows enter one by one."""
    rng = np.random.default_rng(0)
    M, G = rng.normal(size=(n, n)), rng.normal(size=(2 * n, n))
    return {"P": M @ M.T, "q": 9 * rng.normal(size=n), "G": G, "h": np.ones(2 * n)}


@pytest.fixture
def cold(monkeypatch):
    monkeypatch.setattr(guess, "BACKENDS", ())


def test_an_answer_that_takes_longer_ends_in_a_sentence(cold, monkeypatch):
    clock = iter(range(1000))
    monkeypatch.setattr(time_limit, "monotonic", lambda: float(next(clock)))
    with pytest.raises(qr.TimeIsUp, match=r"^not ended in 5 s$") as ended:
        qr.exact_qp(**hard(), seconds=5)
    assert ended.value.seconds == 5.0
    assert next(clock) == 7  # it was asked each second


def test_a_limit_that_is_long_enough_changes_nothing():
    program = {"P": np.eye(3), "q": [-1.0, 0.5, 2.0], "lb": [0.0, 0.0, 0.0]}
    with_limit, without = qr.exact_qp(**program, seconds=600.0), qr.exact_qp(**program)
    assert with_limit.x.tobytes() == without.x.tobytes()
    assert with_limit.active == without.active


def test_a_limit_ends_with_its_call_and_holds_in_its_thread(cold):
    answers = []
    other = Thread(target=lambda: answers.append(qr.exact_qp(**hard(12))))
    with time_limit.time_limit(1e-9):
        other.start()
        other.join()
        with pytest.raises(qr.TimeIsUp):
            qr.exact_qp(**hard(12))
    assert qr.exact_qp(**hard(12)).x.tobytes() == answers[0].x.tobytes()


@pytest.mark.parametrize("seconds", [0.0, -1.0, np.nan, "ten"])
def test_a_limit_that_is_no_time_is_refused(seconds):
    with pytest.raises(qr.InputError, match=r"^seconds: "):
        qr.exact_qp([[1.0]], [1.0], seconds=seconds)
