"""The table of classic mistakes: a name, what is right, and what would be answered."""

from typing import Final

from quasistatic_ref.lab.vectors.check import wrong_contacts, wrong_frames, wrong_steps
from quasistatic_ref.lab.vectors.check.forces_and_orders import FORCES_AND_ORDERS
from quasistatic_ref.lab.vectors.check.hypothesis import Hypothesis
from quasistatic_ref.lab.vectors.check.predictions import (
    again,
    both,
    by_h,
    contacts_changed,
    of_q_next,
    opposite,
    times,
)
from quasistatic_ref.lab.vectors.check.wrong_contacts import mu_omega, of_rows, with_mu_omega
from quasistatic_ref.lab.vectors.check.wrong_derivatives import DERIVATIVES
from quasistatic_ref.lab.vectors.check.wrong_steps import PLACED

HYPOTHESES: Final = (
    Hypothesis(
        "sign of the contact term",
        "H delta_q - g - sum A' lam = 0 with lam >= 0, and the wrench acts on beta's body: "
        "Eq. (9) as printed has the other sign",
        {
            "qp": opposite("lam", "A_lam"),
            "rows": opposite("A"),
            "wrench": opposite("wrench", "net"),
            "step": opposite("A", "lam", "A_lam", "wrench"),
        },
    ),
    Hypothesis(
        "lam and force mixed up by h",
        "lam is an impulse [N s]; the wrench is its combination divided by h [N]",
        {
            "qp": by_h("lam", "A_lam"),
            "wrench": by_h("wrench", "net", powers=(1,)),
            "step": both(by_h("lam", "A_lam"), by_h("wrench", powers=(1,))),
        },
    ),
    Hypothesis(
        "lam divided by h twice",
        "lam is an impulse [N s]: the wrench is its combination divided by h once [N]",
        {
            "wrench": by_h("wrench", "net", powers=(-1,)),
            "step": by_h("wrench", powers=(-1,)),
        },
    ),
    Hypothesis(
        "v in the place of delta_q",
        "delta_q is a displacement in one step [m, rad], not a velocity: multiply by h once",
        {
            "qp": by_h("delta_q"),
            "integrate": wrong_frames.other_delta_q,
            "step": both(by_h("delta_q"), of_q_next(wrong_frames.other_delta_q)),
        },
    ),
    Hypothesis(
        "mu_omega taken as dimensionless",
        "mu_omega is a length [m]: a spin row is n'J + mu_omega times the spin, and the torque "
        "mu_omega times the force",
        mu_omega(with_mu_omega(lambda c: 1.0)),
    ),
    Hypothesis(
        "mu_omega multiplied by mu_v",
        "mu_omega stands by itself in Eq. (7)",
        mu_omega(with_mu_omega(lambda c: float(c["mu_omega"] * c["mu_v"]))),
    ),
    Hypothesis(
        "normals reversed",
        "n points from alpha's body to beta's, also in penetration",
        {
            "distance": opposite("n"),
            "rows": wrong_contacts.reversed_rows,
            "wrench": wrong_contacts.reversed_wrench,
            "step": contacts_changed(lambda c: {"n": times(c["n"], -1.0)}),
        },
    ),
    Hypothesis(
        "unsigned phi",
        "phi is negative in penetration, and n keeps its direction there",
        {
            "distance": wrong_contacts.unsigned,
            "selection": wrong_contacts.unsigned_selection,
            "rows": lambda case, output: [{"b": [-abs(v) for v in output["b"]]}],
            "step": contacts_changed(lambda c: {"phi": abs(c["phi"])}),
        },
    ),
    Hypothesis(
        "sign of b",
        "a row reads phi + A delta_q >= 0: b is -phi",
        {"rows": opposite("b"), "step": opposite("b")},
    ),
    Hypothesis(
        "torsion rows missing",
        "a contact whose rows are 6 has two more, n'J +- mu_omega times its spin",
        {
            **of_rows(wrong_contacts.without_spin),
            "jacobian": lambda case, output: [{"J": [J[:3] for J in output["J"]]}],
            "wrench": lambda case, output: [
                again("wrench", with_mu_omega(lambda c: 0.0)(case)),
                {"wrench": [[*w[:3], 0.0] for w in output["wrench"]]},
            ],
        },
    ),
    Hypothesis(
        "world and body frames swapped",
        "a floating base's delta_q is a twist in the body's own frame; or declare "
        '"tangent": "world" (linear and angular) or "mujoco" (linear) in the answers',
        {
            "jacobian": wrong_frames.other_tangents,
            "integrate": wrong_frames.world_integrate,
            "step": both(
                wrong_frames.other_tangents_of_step, of_q_next(wrong_frames.world_integrate)
            ),
        },
    ),
    Hypothesis(
        "J transposed",
        "J of a contact has 4 rows and n_v columns, written row by row",
        {
            "jacobian": wrong_frames.transposed_J,
            "rows": wrong_frames.transposed_rows,
            "step": wrong_frames.transposed_J_of_step,
        },
    ),
    Hypothesis(
        "quaternions written as wxyz",
        'quaternions are [x, y, z, w]; or declare "quaternion": "wxyz" in the answers',
        {
            "integrate": wrong_frames.answered_wxyz("q"),
            "step": wrong_frames.answered_wxyz("q_next"),
        },
    ),
    Hypothesis(
        "quaternions read as wxyz",
        "the inputs' quaternions are [x, y, z, w], whatever the answers declare of their own",
        {
            "distance": wrong_frames.misread("distance"),
            "jacobian": wrong_frames.misread("jacobian"),
            "integrate": wrong_frames.misread("integrate"),
            "step": wrong_steps.misread,
        },
        first=PLACED,
    ),
    Hypothesis(
        "rows interleaved",
        "a contact's rows are +d1, +d2, -d1, -d2, +spin, -spin; MuJoCo's are +d1, -d1, +d2, -d2",
        {
            **of_rows(wrong_contacts.interleaved),
            "wrench": wrong_contacts.lam_in_order(wrong_contacts.mujoco_order),
        },
    ),
    Hypothesis(
        "alpha and beta swapped",
        "J is the motion of beta relative to alpha, and the wrench acts on beta's body",
        {
            "distance": wrong_contacts.swapped_points,
            "jacobian": opposite("J"),
            "wrench": wrong_contacts.swapped_wrench,
            "step": both(
                contacts_changed(lambda c: {"alpha": c["beta"], "beta": c["alpha"]}),
                contacts_changed(lambda c: {"J": times(c["J"], -1.0)}),
            ),
        },
    ),
    Hypothesis(
        "un-actuated coordinates first",
        "delta_q holds the actuated joints first, then the others",
        {"jacobian": wrong_frames.unactuated_first, "step": wrong_frames.unactuated_step},
    ),
    Hypothesis(
        "a straight line in the place of the screw",
        "T exp6(delta_q): the translation is V(w) v, not v",
        {
            "integrate": wrong_frames.straight("mujoco"),
            "step": of_q_next(wrong_frames.straight("mujoco")),
        },
    ),
    Hypothesis(
        "world tangent without the screw",
        "a floating base's delta_q is a twist in the body's own frame, and (+) follows its screw",
        {
            "integrate": wrong_frames.straight("world"),
            "step": of_q_next(wrong_frames.straight("world")),
        },
    ),
    *FORCES_AND_ORDERS,
    *DERIVATIVES,
)
"""Tried in this order; of equally good explanations all are named."""
