"""What mistakes about frames, orders and lengths answer: wrong tangents, wxyz, transposes."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from quasistatic_ref.lab.vectors.check.predictions import (
    TIME_STEPS,
    Prediction,
    again,
    each,
    scaled,
)
from quasistatic_ref.lab.vectors.converters import places, tangent_map, wxyz, xyzw
from quasistatic_ref.lab.vectors.expected import Json


def other_delta_q(case: Json, output: Json) -> Iterable[Json]:
    """delta_q multiplied by h before it is used, or divided."""
    factors = [f for h in TIME_STEPS for f in (h, 1 / h)]
    return [again("integrate", {**case, **scaled(case, f, "delta_q")}) for f in factors]


def other_tangents(case: Json, output: Json) -> Iterable[Json]:
    """J along the world's axes, or as MuJoCo has it."""
    maps = (tangent_map(case["mechanism"], case["q"], t) for t in ("world", "mujoco"))
    return [{"J": (np.array(output["J"]) @ B).tolist()} for B in maps]


def other_tangents_of_step(case: Json, output: Json) -> Iterable[Json]:
    """A whole step in these tangent spaces."""
    for tangent in ("world", "mujoco"):
        B = tangent_map(case["mechanism"], case["q"], tangent)
        contacts = [{"J": (np.array(c["J"]) @ B).tolist()} for c in output["contacts"]]
        H, g = np.array(output["H"]), np.array(output["g"])
        delta_q, A_lam = np.array(output["delta_q"]), np.array(output["A_lam"])
        yield {
            "contacts": contacts,
            "H": (B.T @ H @ B).tolist(),
            "g": (B.T @ g).tolist(),
            "delta_q": (B.T @ delta_q).tolist(),
            "A_lam": (B.T @ A_lam).tolist(),
        }


def world_integrate(case: Json, output: Json) -> Iterable[Json]:
    """delta_q taken along the world's axes, or as MuJoCo has it."""
    for tangent in ("world", "mujoco"):
        B = tangent_map(case["mechanism"], case["q"], tangent)
        delta_q = (B @ np.array(case["delta_q"])).tolist()
        yield again("integrate", {**case, "delta_q": delta_q})


def _transposed(J: Json) -> Iterable[Json]:
    array = np.array(J)
    return [array.T.tolist(), array.T.reshape(array.shape).tolist()]


def transposed_J(case: Json, output: Json) -> Iterable[Json]:
    """The transposes, or the same numbers in the order of the transposes."""
    variants = [list(_transposed(J)) for J in output["J"]]
    return [{"J": [variant[k] for variant in variants]} for k in (0, 1)]


def transposed_J_of_step(case: Json, output: Json) -> Iterable[Json]:
    """The same in the contacts of a step."""
    variants = [list(_transposed(contact["J"])) for contact in output["contacts"]]
    return [{"contacts": [{"J": variant[k]} for variant in variants]} for k in (0, 1)]


def transposed_rows(case: Json, output: Json) -> Iterable[Json]:
    """Rows from a J that is read column by column."""

    def misread(contact: Json) -> Json:
        array = np.array(contact["J"])
        return {"J": array.reshape(array.shape[::-1]).T.tolist()}

    return [again("rows", {**case, "contacts": each(case["contacts"], misread)})]


def misread_poses(value: Any) -> Any:
    """Every pose with its quaternion taken as [w, x, y, z]."""
    if isinstance(value, dict):
        return {
            key: v[1:] + v[:1] if key == "quaternion" else misread_poses(v)
            for key, v in value.items()
        }
    return [misread_poses(v) for v in value] if isinstance(value, list) else value


def misread(name: str) -> Prediction:
    """The answer to quaternions taken as [w, x, y, z], of poses, of q, or of both."""

    def prediction(case: Json, output: Json) -> Iterable[Json]:
        misread = misread_poses(case)
        yield again(name, misread)
        if "q" in case:  # the mechanism right, or q right
            for other in (case, misread):
                q = {"q": xyzw(case["mechanism"], case["q"])}
                answer = again(name, {**other, **q})
                yield answer
                if name == "integrate":
                    yield {"q": wxyz(case["mechanism"], answer["q"])}

    return prediction


def answered_wxyz(field: str) -> Prediction:
    """A right q whose quaternions are written [w, x, y, z]."""
    return lambda case, output: [{field: wxyz(case["mechanism"], output[field])}]


def _unactuated_order(mechanism: Json) -> list[int]:
    """Entries of delta_q in the order [un-actuated; actuated]."""
    joints = {body["name"]: bool(body.get("actuated")) for body in mechanism["bodies"]}
    order: list[int] = []
    for actuated in (False, True):
        for at in places(mechanism):
            if joints[at.name] == actuated:
                order += range(at.v.start, at.v.stop)
    return order


def unactuated_first(case: Json, output: Json) -> Iterable[Json]:
    """Columns of J in that order."""
    return [{"J": np.array(output["J"])[:, :, _unactuated_order(case["mechanism"])].tolist()}]


def unactuated_step(case: Json, output: Json) -> Iterable[Json]:
    """J, H and g of a step in that order."""
    order = _unactuated_order(case["mechanism"])
    contacts = [{"J": np.array(c["J"])[:, order].tolist()} for c in output["contacts"]]
    H, g = np.array(output["H"]), np.array(output["g"])
    yield {"contacts": contacts, "H": H[np.ix_(order, order)].tolist(), "g": g[order].tolist()}


def straight(tangent: str) -> Prediction:
    """X + v in the place of the screw, v along the axes of the body or, with the turn, the world's.

    Parameters
    ----------
    tangent : str
        In which delta_q is taken: ``"mujoco"`` has its angular part in the body as ours.
    """

    def prediction(case: Json, output: Json) -> Iterable[Json]:
        B = tangent_map(case["mechanism"], case["q"], tangent)
        own = np.array(case["delta_q"])
        if tangent == "world":
            moved, turned = own, again("integrate", {**case, "delta_q": (B @ own).tolist()})
        else:
            moved, turned = B.T @ own, output
        q = list(turned["q"])
        for at in places(case["mechanism"]):
            if at.kind == "floating":
                start = np.array(case["q"][at.q.start : at.q.start + 3])
                to = start + moved[at.v.start : at.v.start + 3]
                q[at.q.start : at.q.start + 3] = to.tolist()
        return [{"q": q}]

    return prediction
