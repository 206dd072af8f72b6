"""'Exact when objects are sticking': the relaxation's only error is a gap, which has a formula."""

import numpy as np

from quasistatic_ref.lab.cached_runs import grasp
from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison, within
from quasistatic_ref.lab.grasp import CASES
from quasistatic_ref.optional.doctor.tolerances import BEARS
from quasistatic_ref.tolerances import CLOSED_FORM

STICKS = 1e-18
"""Slip below which a contact sticks [m]: displacements of a step are 1e-4, rounded to 1e-20. What
has slipped comes to rest by a factor of about three a step, (R6), and passes through all sizes."""


def evidence() -> Evidence:
    """Every loaded contact of both grasps."""
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
    return Evidence.of(
        comparison(gap, after_step, layer, CLOSED_FORM, scale),
        comparison("gap of one that sticks [m]", held, 0.0, 2 * STICKS),
        within("friction used, of what the cone allows [-]", share, 0.0, 1 + CLOSED_FORM),
    )


CLAIM = Claim(
    name="exact_when_sticking",
    sentence="A contact that bears load ends the step with the gap max(mu_v |slip_1|, mu_v "
    "|slip_2|, mu_omega |spin|): nothing when it sticks, where Coulomb's law then holds exactly.",
    where="the paper, section II-A, after Anitescu; docs/derivations.md (R19)",
    sweep="every loaded contact of bunny_grasp with and without torsion, 600 steps",
    reason="CLOSED_FORM, relative to the largest product in the sum of the gap. Sticking is a slip "
    "below 1e-18 m; the gap is then zero to twice that, to first order: the exact optimum has no "
    "gap, but delta_q, J and n are rounded to floats.",
    measure=evidence,
)
