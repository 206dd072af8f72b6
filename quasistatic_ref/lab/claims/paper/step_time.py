"""Figure 4: where the time of a step goes."""

from quasistatic_ref.lab.bench.profile import DAQP, STEPS, profiles
from quasistatic_ref.lab.claims.claim import Claim, Evidence, within

MAJORITY, MINORITY = (0.5, 1.0), (0.0, 0.5)
"""Shares that make the paper's sentence true or false [-]."""
ALONE = ("clarabel", "qpsolvers:clarabel", "osqp", "qpsolvers:osqp")
"""Backends whose own time alone is a majority of a step without the interface to them."""


def evidence() -> Evidence:
    """The share of the solve in a step, by backend, and that of the solver's own time."""
    taken = {profile.backend: profile for profile in profiles(STEPS)}
    through = [name for name in taken if name != DAQP]
    comparisons = [
        *(within(f"{name}: solve [-]", taken[name].solve, *MAJORITY) for name in through),
        *(within(f"{name}: solver's own time [-]", taken[name].alone, *MAJORITY) for name in ALONE),
        within("daqp: solver's own time [-]", taken[DAQP].alone, *MINORITY),
    ]
    return Evidence.of(*comparisons)


CLAIM = Claim(
    name="step_time",
    sentence="The paper's sentence, that a majority of the time of a step is spent solving the "
    "quadratic program although almost 3,000 signed distances are evaluated, holds here for "
    "Clarabel and PIQP, two interior-point methods like the paper's, and for OSQP, through CVXPY "
    "and through qpsolvers, with all else in compiled code. For Clarabel and OSQP it holds of the "
    "time that the solver itself reports, too. DAQP, an active-set method that starts from the "
    "last answer and is called by its own interface, reports less than a half.",
    where="the paper, section III-B and Fig. 4, about its own interior-point method",
    sweep="bunny_grasp, medians of all 300 steps on the machine at hand, backends in turns of ten "
    "steps; accuracy 1e-12, nothing certified",
    reason="`solve` is the lap of the simulator's stopwatch: natural units, the interface, the "
    "solver, the answer in SI units. The solver's own time is compared with a step without the "
    "rest of that. A majority is more than a half. The paper's time, less than 90 us, is that of "
    "another method, language and machine (docs/speed.md).",
    measure=evidence,
    engine="daqp",
)
