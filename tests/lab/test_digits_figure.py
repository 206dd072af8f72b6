"""The figure of correct digits: the committed results, and steps that a backend left unsolved."""

from tests.quoted import stale
from validation.make.digits_of_backends import (
    ACCURACIES,
    BACKENDS,
    NATURAL,
    RAW,
    ROOT,
    records_read,
)


def test_the_committed_results_are_all_steps_of_every_backend_and_setting():
    records = records_read()
    assert len(records) == 2 * len(BACKENDS) * len(ACCURACIES)
    assert {r.steps for r in records} == {600}
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


def quoted():
    """The phrases of docs/exactness.md about these digits, each with what fills its braces."""
    at = {(r.units, r.backend, r.accuracy): r for r in records_read()}

    def worst(units, accuracy):
        return [at[units, backend, accuracy].worst for backend in BACKENDS]

    def ends(values):
        return min(values), max(values)

    settings = [(b, a) for b in BACKENDS for a in ACCURACIES]
    gains = {one: at[NATURAL, *one].worst - at[RAW, *one].worst for one in settings}
    daqp, osqp = at[RAW, "daqp", "1e-6"], at[RAW, "osqp", "default"]
    lone = gains.pop(("osqp", "1e-3"))
    return [
        "own defaults leave {:.1f} to {:.1f} digits at".format(*ends(worst(RAW, "default"))),
        "An accuracy of 1e-3 leaves {:.1f} to {:.1f}:".format(*ends(worst(RAW, "1e-3"))),
        "Natural units are worth {:.1f} to {:.1f} digits** at".format(*ends(gains.values())),
        f"(OSQP at 1e-3 gains {lone:.1f}), and cost none at any",
        f"DAQP at 1e-6 in raw units has {daqp.median:.1f} digits at the median and "
        f"{daqp.worst:.1f} at the worst step",
        f"its best step has {osqp.best:.1f} digits; its median has {osqp.median:.1f}, its worst "
        f"step {osqp.worst:.1f}.",
        "worst steps have {:.1f} digits (Clarabel), {:.1f} (OSQP, whose accuracy is never set "
        "below 1e-10), {:.1f} (PIQP) and {:.1f} (DAQP).".format(*worst(NATURAL, "1e-12")),
    ]  # fmt: skip


def test_the_page_on_exact_answers_quotes_the_committed_results():
    wrong = stale((ROOT / "docs" / "exactness.md").read_text("utf-8"), quoted())
    assert not wrong, "ought to read:\n" + "\n".join(wrong)
    assert {r.unsolved for r in records_read()} == {0}
