"""The table of mistakes about the order of numbers, and about the forces of a step."""

from typing import Final

from quasistatic_ref.lab.vectors.check import wrong_contacts, wrong_orders, wrong_steps
from quasistatic_ref.lab.vectors.check.hypothesis import Hypothesis
from quasistatic_ref.lab.vectors.check.predictions import both, contacts_changed, of_q_next, times
from quasistatic_ref.lab.vectors.check.wrong_contacts import of_rows
from quasistatic_ref.lab.vectors.check.wrong_steps import PLACED

FORCES_AND_ORDERS: Final = (
    Hypothesis(
        "angular part first",
        "a floating base's delta_q is (v, w): the linear part comes first",
        {
            "jacobian": wrong_orders.angular_first,
            "integrate": wrong_orders.angular_delta_q,
            "step": both(wrong_orders.angular_step, of_q_next(wrong_orders.angular_delta_q)),
        },
    ),
    Hypothesis(
        "torque first",
        "a net wrench is force and then torque, six numbers",
        {"wrench": wrong_orders.torque_first},
    ),
    Hypothesis(
        "n first in a wrench",
        "the wrench of a contact is (f_d1, f_d2, f_n, tau_n)",
        {"wrench": wrong_orders.normal_first, "step": wrong_orders.normal_first},
    ),
    Hypothesis(
        "one-based indices",
        "indices count from 0",
        {"selection": wrong_orders.one_based, "step": wrong_orders.one_based_contacts},
    ),
    Hypothesis(
        "contact order",
        "the contacts of a pair stand in the order of their index, not of phi",
        {"step": wrong_orders.by_phi},
    ),
    Hypothesis(
        "A transposed",
        "A has a row for each row of a contact and a column for each entry of delta_q",
        {"rows": wrong_orders.transposed_A, "step": wrong_orders.transposed_A},
    ),
    Hypothesis(
        "spin sign",
        "row 3 of J is n . (w_beta - w_alpha), and the torque about n acts on beta's body",
        {
            "jacobian": wrong_contacts.reversed_spin,
            "wrench": wrong_contacts.reversed_torque,
            "step": contacts_changed(lambda c: {"J": [*c["J"][:3], times(c["J"][3], -1.0)]}),
        },
    ),
    Hypothesis(
        "spin rows exchanged",
        "+spin comes before -spin",
        {
            **of_rows(wrong_contacts.spins_exchanged),
            "wrench": wrong_contacts.lam_in_order(wrong_contacts.exchanged_spins),
        },
    ),
    Hypothesis(
        "one point in the place of alpha and beta",
        "J takes the material point at beta of beta's body and that at alpha of alpha's",
        {"jacobian": wrong_contacts.one_point, "step": wrong_steps.one_point},
        first=("contacts.J",),
    ),
    Hypothesis(
        "half-space offset",
        "a half-space is normal.x <= offset: where the normal is divided by its length, so is the "
        "offset",
        {"distance": wrong_contacts.other_offset, "step": wrong_steps.other_offset},
        first=PLACED,
    ),
    Hypothesis(
        "gravity's sign",
        "gravity is an acceleration: its force is + m Jc' gravity",
        {"step": wrong_steps.gravity_sign},
        first=("g",),
    ),
    Hypothesis(
        "gravity on actuated joints",
        "gravity acts on the un-actuated coordinates alone",
        {"step": wrong_steps.gravity_everywhere},
        first=("g",),
    ),
    Hypothesis(
        "h missing in g",
        "g = h (K_q delta_q_bar_a + tau_a, tau_u)",
        {"step": wrong_steps.without_h},
        first=("g",),
    ),
    Hypothesis(
        "M/h^2 in the place of M/h",
        "H = blockdiag(h K_q, M_u / h)",
        {"step": wrong_steps.other_mass},
        first=("H",),
    ),
    Hypothesis(
        "q_bar's sign",
        "delta_q_bar_a = q_bar_a (-) q_a, from where it is to its target",
        {"step": wrong_steps.opposite_target},
        first=("g",),
    ),
    Hypothesis(
        "inertia not turned into the world",
        "a body's inertia is along its own axes: R I R' in the world",
        {"step": wrong_steps.unturned_inertia},
        first=("H",),
    ),
    Hypothesis(
        "wrench at the body's origin",
        "an external force acts at the centre of mass",
        {"step": wrong_steps.wrench_at_origin},
        first=("g",),
    ),
)
