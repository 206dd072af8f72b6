"""No backend holds up a step at strange scales: a sample of validation/make/hostile_steps.py."""

from validation.make.hostile_steps import names
from validation.tools.fuzz import outcomes

HELD_UP = {"quadprog": 115, "cvxpy proxqp": 12, "highs": 308}
"""Inputs that held a backend up: quadprog for ever, by both its interfaces, and ProxQP through
CVXPY for longer than 10 s, in 20,000 iterations of up to 1,500 inner ones; HiGHS, by both of its
interfaces, ended the process."""
SAMPLE = 1
"""Steps that every path is given."""
READERS = "validation.make.hostile_steps"


def test_every_path_ends_exact_or_refused_also_where_it_was_held_up():
    held_up = [(name, i, 1) for part, i in HELD_UP.items() for name in names() if part in name]
    assert len(held_up) == 5  # but for ProxQP by two interfaces
    jobs = [(name, 0, SAMPLE) for name in names()] + held_up
    found = list(outcomes(jobs, READERS))
    assert [one for one in found if one[2] not in ("accepted", "refused")] == []
    assert len(found) == SAMPLE * len(names()) + len(held_up)
    ends = {}
    for _, i, outcome, *_ in found:
        ends.setdefault(i, set()).add(outcome)
    assert all(len(kinds) == 1 for kinds in ends.values())  # all paths end alike
    assert {"accepted"} in ends.values()
