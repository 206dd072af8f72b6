"""The figure of correct digits: the committed results."""

from validation.make.digits_of_backends import (
    ACCURACIES,
    BACKENDS,
    records_read,
)


def test_the_committed_results_are_all_steps_of_every_backend_and_setting():
    records = records_read()
    assert len(records) == 2 * len(BACKENDS) * len(ACCURACIES)
    assert {(r.steps, r.unsolved) for r in records} == {(600, 0)}
    for r in records:
        assert 0 <= r.worst <= r.low <= r.median <= r.best <= 16


def test_natural_units_are_worth_digits_at_every_accuracy():
    """The story that the docs tell: the worst step gains at every accuracy."""
    by_setting = {(r.units, r.backend, r.accuracy): r for r in records_read()}
    raw, natural = dict.fromkeys(r.units for r in records_read())
    for backend in BACKENDS:
        for accuracy in ACCURACIES[1:]:
            before, after = (by_setting[u, backend, accuracy] for u in (raw, natural))
            assert after.worst >= before.worst
            assert after.median >= before.median
