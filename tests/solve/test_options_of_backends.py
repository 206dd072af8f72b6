"""What docs/conventions.md says of single options of backends, against the committed table."""

from quasistatic_ref.solve.backends import BACKENDS
from tests.quoted import stale
from validation.make.options_of_backends import NATURAL, RAW, RESULTS, combinations, records_read

PAGE = RESULTS.parents[2] / "docs" / "conventions.md"
STEPS = 300
"""Of each run of bunny_grasp."""


def quoted():
    """Phrases of the page, each with what fills its braces."""
    at = {(r.backend, r.units, r.options): r for r in records_read()}

    def worst(backend, *options):
        return [at[backend, NATURAL, o].worst for o in options]

    def median(backend, *options):
        return [at[backend, NATURAL, o].median for o in options]

    def unsolved(backend, *options, units=NATURAL):
        found = (at[backend, units, o] for o in options)
        return [r.unsolved_with + r.unsolved_without for r in found]

    def rhos(accuracy):
        return unsolved("osqp", f"fixed rho at {accuracy}", f"adaptive rho at {accuracy}")

    gaps = ("gap 1e-12", "gap 1e-14")
    highs = at["highs", NATURAL, "tolerances 1e-10"]
    assert len(set(worst("piqp", *gaps))) == 1
    assert unsolved("highs", "defaults") == unsolved("highs", "no regularisation")
    assert unsolved("highs", "defaults", units=RAW) == [0]
    assert unsolved("clarabel", *(f"static regularisation {x}" for x in ("1e-10", "1e-12"))) == [
        0,
        0,
    ]
    return [
        ("Clarabel has {:.1f} digits at the worst step, with one of 1e-14 it has {:.1f}",
         lambda: worst("clarabel", *gaps)),
        ("PIQP has {:.1f} there with either, and in the median {:.1f} and {:.1f}",
         lambda: [worst("piqp", *gaps)[0], *median("piqp", *gaps)]),
        ("stops before the end at {} of the 600 steps",
         lambda: unsolved("clarabel", "static regularisation 1e-08")),
        ("has {:.1f} digits at its worst step, and {:.1f} without",
         lambda: worst("piqp", "less regularisation", "its own regularisation")),
        ("OSQP at 1e-10 leaves {} of the 600 steps unsolved with a fixed rho and {} with",
         lambda: rhos("1e-10")),
        ("At 1e-11 these are {} and {},", lambda: rhos("1e-11")),
        ("at 1e-12 they are {} and {}.", lambda: rhos("1e-12")),
        ("solves {} of the 300 steps with torsion and {} of the 300 without",
         lambda: [STEPS - highs.unsolved_with, STEPS - highs.unsolved_without]),
        ("more than {:.1f} digits in the median; `qp_regularization_value = 0`, which is 1e-7 by "
         "default, gives it {:.1f}",
         lambda: [max(median("highs", "defaults", "tolerances 1e-10")),
                  *median("highs", "no regularisation")]),
        ("is right to {:.1f} digits at the worst", lambda: [at["highs", RAW, "defaults"].worst]),
        ("at 1e-12 it leaves {} of the 600 unsolved", lambda: unsolved("proxqp", "at 1e-12")),
    ]  # fmt: skip


def test_the_page_quotes_the_committed_table():
    wrong = stale(
        PAGE.read_text("utf-8"), [phrase.format(*values()) for phrase, values in quoted()]
    )
    assert not wrong, "ought to read:\n" + "\n".join(wrong)


def test_the_committed_table_has_every_set_of_options_that_is_asked():
    names = [(backend, units, special) for backend, units, special, _ in combinations()]
    assert [(r.backend, r.units, r.options) for r in records_read()] == names
    assert {name for name, *_ in names} <= set(BACKENDS)
