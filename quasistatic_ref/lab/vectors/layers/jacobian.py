"""Layer `jacobian`: J of Eqs. (2)-(3) at given contact points of a mechanism."""

import numpy as np

from quasistatic_ref.lab.vectors.trees import Json


def own(case_input: Json) -> Json:
    """The package's J: rows 0-2 nu_beta - nu_alpha, row 3 n'(omega_beta - omega_alpha)."""
    from quasistatic_ref.lab.made_steps.link_jacobian import contact_jacobian
    from quasistatic_ref.lab.vectors.own.system import own_system

    contacts = case_input["contacts"]
    if not contacts:
        return {"J": []}
    mine = own_system(case_input["mechanism"])
    J = contact_jacobian(
        mine.system.kinematics(mine.model_q(case_input["q"])),
        np.array([mine.links[contact["alpha_body"]] for contact in contacts]),
        np.array([mine.links[contact["beta_body"]] for contact in contacts]),
        *(np.array([contact[key] for contact in contacts]) for key in ("alpha", "beta", "n")),
    )
    return {"J": (J[:, :, mine.v] + 0.0).tolist()}
