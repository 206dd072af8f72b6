"""Forces of single contacts that leave a part of the load, or that rounding decides."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.optional.between import Said
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.step.arrays import without_warnings
from quasistatic_ref.step.friction import frame_jacobian
from quasistatic_ref.step.standard_form import linear_term
from quasistatic_ref.tolerances import BORNE, SURE

ROUNDING = 2.0**-40
"""Of sums in float64, over the sum of the sizes of all terms [-]."""


def unborne(run: Run) -> Iterator[Said]:
    """What forces leave in a step of a record of forces, of another run where contacts press most.

    What a last bit of the places of contacts may change in forces is that of the same step: beside
    a load that is rounding, any change is large.
    """
    recorded = run.arrays.get("imbalance")
    k = int(run["wrench"][:, :, 2].sum(axis=1).argmax())
    bit = float(np.spacing(np.abs(run["beta"][k]).max(initial=0.0)))
    left = 0.0 if recorded is None else float(recorded.max())
    surely = left <= BORNE and without_warnings(_surely_borne, run, k, bit)
    found = None if surely else run.compliant(k)
    if found is not None:
        left = max(left, found.imbalance)
    if left > BORNE:
        yield Said(
            "read wrench in the place of forces, or raise mu_v or mu_omega",
            f"forces of single contacts leave {left:.1e} of the load",
            {"left": left},
        )
    if found is None:
        return
    noise = found.sensitivity * bit
    if noise > SURE:
        yield Said(
            "read sums of forces only, or take a larger h or a softer K_q",
            f"the last bit of a gap, {bit:.1e} m, may change forces of single contacts by "
            f"{noise:.1e} of the load of their group",
            {"noise": noise},
        )


def _surely_borne(run: Run, k: int, bit: float) -> bool:
    """Whether floats show that the forces of step k, which are known, leave and change too little.

    The step with compliance ends at H^-1 (g + h J'f), which need not be found exactly.
    """
    known = run.in_c(k) if run.searched else None
    if known is None:
        return False
    force, compliance, groups = known
    step = run.step_data(k)
    contacts = step.contacts
    x = run["delta_q"][k]
    g = linear_term(step)
    J = np.stack(frame_jacobian(contacts, contacts.J), axis=1)[:, [1, 2, 0, 3]]
    exerted = step.h * np.einsum("cr,crv->v", force, J)
    terms = np.abs(step.H) @ np.abs(x) + np.abs(g)
    terms += step.h * np.einsum("cr,crv->v", np.abs(force), np.abs(J))
    norm = energy_norm(step.H)  # whose entries between groups are 0
    off = norm.inverse @ (norm.unit * (step.H @ x - g - exerted))
    load = norm.inverse @ (norm.unit * exerted)
    rounding = ROUNDING * (np.abs(norm.inverse) @ (norm.unit * terms))
    for group in groups:
        f_n = force[group.contacts, 2]
        v = group.coordinates
        if not force[group.contacts].any():
            continue
        c = compliance[group.contacts[0]]
        leaves = np.linalg.norm(off[v]) + np.linalg.norm(rounding[v])
        noise = np.sqrt(len(f_n)) / (c * f_n.sum()) * bit
        if not (leaves <= BORNE / 2 * np.linalg.norm(load[v]) and noise <= SURE / 2):
            return False
    return True
