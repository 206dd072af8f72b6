"""Inputs of the layers in exact numbers, after a look at whether their mechanism can be."""

from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.lab.program.mechanism import ENTRIES, slices
from quasistatic_ref.lab.vectors.exact.precision import number
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.trees import mapped

SIDES = ("alpha_body", "beta_body")
COUNTS = ("rows",)
"""Fields that say how many there are of something."""


def exact_case(case: Json) -> Json:
    """A case with every number but counts exact.

    Raises
    ------
    InputError
        If it has a mechanism that cannot be, a q or delta_q of another one, or names no body of it.
    """
    if "mechanism" in case:
        bodies = case["mechanism"]["bodies"]
        _check(bodies)
        places = slices(case["mechanism"])[0].values()
        for part, field in enumerate(("q", "delta_q")):
            length = max((at[part].stop for at in places), default=0)
            if len(case.get(field, range(length))) != length:
                raise InputError(
                    f"must contain {length} numbers", field=field, value=len(case[field])
                )
        named = [contact[side] for contact in case.get("contacts", []) for side in SIDES]
        known = [None, *(body["name"] for body in bodies)]
        for name in named:
            if name not in known:
                problem = f"is not a body{suggestion(str(name), known[1:])}"
                raise InputError(problem, field="body", value=name)
    numbers: Json = exact(case)
    return numbers


def exact(value: Any) -> Any:
    """The same nesting of exact numbers, counts and words."""
    return mapped(value, _exact, COUNTS)


def _exact(value: Any) -> Any:
    counts = isinstance(value, bool) or not isinstance(value, int | float)
    return value if counts else number(value)


def _check(bodies: Json) -> None:
    """InputError at the first body that cannot be."""
    names = [body["name"] for body in bodies]
    scalar = [
        body["name"]
        for body in bodies
        if body["joint"] in ("revolute", "prismatic") and "mimic" not in body
    ]
    for k, body in enumerate(bodies):
        if body["joint"] not in ENTRIES:
            problem = f"is not a kind of joint{suggestion(str(body['joint']), ENTRIES)}"
            raise InputError(problem, field=f"bodies[{k}].joint", value=body["joint"])
        if body["parent"] is not None and body["parent"] not in names[:k]:
            problem = f"must be a body before it{suggestion(str(body['parent']), names[:k])}"
            raise InputError(problem, field=f"bodies[{k}].parent", value=body["parent"])
        if "mimic" in body:
            of = body["mimic"]["of"]
            if of not in scalar or body["joint"] not in ("revolute", "prismatic"):
                problem = f"must follow a revolute or prismatic joint{suggestion(str(of), scalar)}"
                raise InputError(problem, field=f"bodies[{k}].mimic", value=of)
