"""The paper's grasp: what the bunny does, how its step is made, and where the time goes."""

import numpy as np

from quasistatic_ref.lab.bench.profile import DAQP, STEPS, profiles
from quasistatic_ref.lab.cached_runs import grasp, lift
from quasistatic_ref.lab.claims.claim import Claim, Comparison, comparison, within
from quasistatic_ref.lab.figures.clouds import is_held, margin, rows
from quasistatic_ref.lab.grasp import CASES, CLOSED, TOP, rotations
from quasistatic_ref.optional.doctor.frame.tolerances import BEARS
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.tolerances import CLOSED_FORM

# Figure 1: the bunny grasped and lifted, with and without torsional friction.

HELD, SWUNG, LIFTED = 1.0, 30.0, 0.030
"""Rotations that nobody would call a rotation, and that nobody would overlook [deg]; lift [m]."""
FIRM = 1.5
"""mu_omega over the one that the closed grip needs by (R14), from which on a bunny is held [-]."""


def grasp_evidence() -> list[Comparison]:
    """Rotation during the lift, height of the lift, and how many steps are exact; other clouds."""
    scenario, _ = grasp("with torsion")
    runs = {case: grasp(case)[1] for case in CASES}
    angles = rotations(scenario, runs)["angles"]
    motion, steps = lift("with torsion")
    raised = motion.t[steps][-1, 2] - motion.t[steps][0, 2]
    exact = [np.mean(run["certificate"] == "exact") for run in runs.values()]
    grasps = [one for one in rows() if one["change"] == "none"]
    firm = [one["rotation"] for one in grasps if one["mu_omega"] and margin(one) >= FIRM]
    weak = [is_held(one) for one in grasps if margin(one) < 1.0 and one["mu_omega"]]
    loose = [is_held(one) for one in grasps if not one["mu_omega"]]
    return [
        within("rotation with torsion [deg]", angles["with torsion"].max(), 0.0, HELD),
        within("rotation without torsion [deg]", angles["without torsion"].max(), SWUNG, np.inf),
        within("lift [m]", raised, LIFTED, np.inf),
        comparison("share of steps certified exactly [-]", exact, 1.0, 0.0),
        within("rotation of any cloud with a firm grip [deg]", max(firm), 0.0, HELD),
        within("share held of clouds with a weak grip [-]", float(np.mean(weak)), 0.0, 0.0),
        within("share held of clouds without torsion [-]", float(np.mean(loose)), 0.0, 0.01),
    ]  # fmt: skip


GRASP = Claim(
    name="grasp",
    sentence="Without torsional friction the grasped bunny turns about the points at which the "
    "fingers hold it, whichever way its cloud was sampled. With torsional friction the "
    "bunny does not turn if mu_omega of the fingers is at least 1.5 times what the closed "
    "grip needs.",
    where="the paper, Fig. 1 and section III-B; docs/derivations.md (R39) for other clouds",
    sweep="bunny_grasp, 300 steps, with and without mu_omega on the fingers; the largest rotation "
    f"from the closed grip, t = {CLOSED:g} s, to the end of the lift, t = {TOP:g} s. Then 480 "
    "other clouds of the same bunny, 200 to 100,000 points drawn in four ways (docs/reality.md): "
    "committed rows",
    reason="The paper gives no numbers, and the scene and its lift are ours. We count less than 1 "
    "degree as no rotation, and more than 30 degrees as rotation. Without torsion 1 in 100 "
    "of the other clouds may be held, by points that happen to be far apart.",
    measure=grasp_evidence,
)

# The size of the bunny's quadratic program: 13 x 80.


def structure_evidence() -> list[Comparison]:
    """Numbers that the paper gives, from the scenario and its run."""
    scenario, run = grasp("with torsion")
    sizes = {
        len(p.beta.shape.points) for p in scenario.pairs if isinstance(p.beta.shape, PointCloud)
    }
    torsional = run["rows"] == 6
    numbers = {
        "points of the cloud": (max(sizes), 992),
        "signed distances of a step ('almost 3,000')": (max(sizes) * len(scenario.pairs), 2976),
        "objects": (len(scenario.pairs), 3),
        "points of each object": (max(pair.k for pair in scenario.pairs), 5),
        "primal variables": (run["A"].shape[2], 13),
        "rows": (run["A"].shape[1], 80),
        "contacts with torsion": (int(torsional.sum()), 10),
        "contacts without": (int((~torsional).sum()), 5),
        "h [s]": (scenario.h, 0.01),
    }
    return [*(comparison(what, np.array(m), e, 0.0) for what, (m, e) in numbers.items())]


STRUCTURE = Claim(
    name="structure",
    sentence="The grasp's quadratic program has 13 variables and 80 rows in every step: 10 "
    "contacts of the gripper with torsion, 5 of the floor without.",
    where="the paper, section III-B, which does not say how 13 and 80 come about; by its words "
    "the floor's contacts would have torsion, too (docs/theory/errata.md)",
    sweep="bunny_grasp, 300 steps",
    reason="Whole numbers, and h as it is written.",
    measure=structure_evidence,
)

# Figure 4: where the time of a step goes.

MAJORITY, MINORITY = (0.5, 1.0), (0.0, 0.5)
"""Shares that make the paper's sentence true or false [-]."""
ALONE = ("clarabel", "qpsolvers:clarabel", "osqp", "qpsolvers:osqp")
"""Backends whose own time alone is a majority of a step without the interface to them."""


def step_time_evidence() -> list[Comparison]:
    """The share of the solve in a step, by backend, and that of the solver's own time."""
    taken = {profile.backend: profile for profile in profiles(STEPS)}
    through = [name for name in taken if name != DAQP]
    comparisons = [
        *(within(f"{name}: solve [-]", taken[name].solve, *MAJORITY) for name in through),
        *(within(f"{name}: solver's own time [-]", taken[name].alone, *MAJORITY) for name in ALONE),
        within("daqp: solver's own time [-]", taken[DAQP].alone, *MINORITY),
    ]
    return [*comparisons]


STEP_TIME = Claim(
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
    measure=step_time_evidence,
    engine="daqp",
)

# 'Exact when objects are sticking': the relaxation's only error is a gap, which has a formula.

STICKS = 1e-18
"""Slip below which a contact sticks [m]: displacements of a step are 1e-4, rounded to 1e-20. What
has slipped comes to rest by a factor of about three a step, (R6), and passes through all sizes."""


def sticking_evidence() -> list[Comparison]:
    """Gaps and friction of every loaded contact in the runs of both grasps, against (R19)."""
    gaps = []
    layers = []
    terms = []
    stuck = []
    use = []
    for case in CASES:
        _, run = grasp(case)
        motion = np.einsum("kcrv,kv->kcr", run["J"], run["delta_q"])
        reach = np.einsum("kcrv,kv->kcr", abs(run["J"]), abs(run["delta_q"])).max(axis=2)
        slip1 = run["mu_v"] * abs(np.sum(motion[..., :3] * run["d1"], axis=2))
        slip2 = run["mu_v"] * abs(np.sum(motion[..., :3] * run["d2"], axis=2))
        spin = np.where(run["rows"] == 6, run["mu_omega"] * abs(motion[..., 3]), 0.0)
        after = run["phi"] + np.sum(motion[..., :3] * run["n"], axis=2)
        force = run["wrench"][..., 2]
        loaded = force > BEARS * force.max(axis=1, keepdims=True)
        layer = np.maximum.reduce([slip1, slip2, spin])
        gaps.append(after[loaded])
        layers.append(layer[loaded])
        terms.append(np.maximum(abs(run["phi"]), reach)[loaded])
        stuck.append(after[loaded & (layer < STICKS)])
        f1, f2, _, tau = np.moveaxis(run["wrench"], 2, 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            spent = abs(f1) / run["mu_v"] + abs(f2) / run["mu_v"]
            spent = spent + np.where(tau == 0, 0.0, abs(tau) / run["mu_omega"])
        use.append(spent[loaded] / force[loaded])
    gap = "gap of a loaded contact after the step [m]"
    after_step, layer, scale, held, share = map(np.concatenate, (gaps, layers, terms, stuck, use))
    return [
        comparison(gap, after_step, layer, CLOSED_FORM, scale),
        comparison("gap of one that sticks [m]", held, 0.0, 2 * STICKS),
        within("friction used, of what the cone allows [-]", share, 0.0, 1 + CLOSED_FORM),
    ]


STICKING = Claim(
    name="exact_when_sticking",
    sentence="A contact that bears load ends the step with the gap max(mu_v |slip_1|, mu_v "
    "|slip_2|, mu_omega |spin|). If the contact sticks, this gap is zero, and Coulomb's law holds "
    "exactly.",
    where="the paper, section II-A, after Anitescu; docs/derivations.md (R19)",
    sweep="every loaded contact of bunny_grasp with and without torsion, 600 steps",
    reason="CLOSED_FORM, relative to the largest product in the sum of the gap. Sticking is a slip "
    "below 1e-18 m; the gap is then zero to twice that, to first order: the exact optimum has no "
    "gap, but delta_q, J and n are rounded to floats.",
    measure=sticking_evidence,
)
