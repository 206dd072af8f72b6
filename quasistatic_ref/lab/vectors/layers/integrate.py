"""Layer `integrate`: q+ = q (+) delta_q of a mechanism."""

from quasistatic_ref.lab.vectors.trees import Json


def own(case_input: Json) -> Json:
    """The package's next configuration; quaternions and (cos, sin) have length one."""
    from quasistatic_ref.lab.vectors.own.system import own_system

    mine = own_system(case_input["mechanism"])
    q = mine.model_q(case_input["q"])
    after = mine.system.integrate(q, mine.model_v(case_input["delta_q"]))
    return {"q": (after[mine.q] + 0.0).tolist()}
