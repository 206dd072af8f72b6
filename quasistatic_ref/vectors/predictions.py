"""What somebody who makes a classic mistake answers, from a case and its right answer.

A prediction is a part of an output, or several where a mistake comes in variants. Of a whole step
only the field that fails first is compared, so that what follows from it need not be predicted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.step.cones import cone
from quasistatic_ref.vectors.converters import tangent_map, wxyz, xyzw
from quasistatic_ref.vectors.expected import Json
from quasistatic_ref.vectors.joints import places
from quasistatic_ref.vectors.layers import layer

Array = NDArray[np.float64]
Prediction = Callable[[Json, Json], Iterable[Json]]

TIME_STEPS: Final = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
"""h [s] that are tried where a layer does not know it."""
MUJOCO_ORDER: Final = (0, 2, 1, 3, 4, 5)
"""Ours of +d1 -d1 +d2 -d2 +spin -spin."""


def again(name: str, case: Json) -> Json:
    """The right answer to a changed input; nothing where the layer refuses that input."""
    try:
        return layer(name).expected(case).output
    except (QuasistaticError, ValueError, KeyError, IndexError, ArithmeticError):
        return {}


def _scaled(output: Json, factor: float, *names: str) -> Json:
    return {name: times(output[name], factor) for name in names if name in output}


def times(value: Json, factor: float) -> Json:
    """All numbers of a value, multiplied by a factor [-]."""
    if isinstance(value, dict):
        return {name: times(v, factor) for name, v in value.items()}
    if isinstance(value, list):
        return [times(v, factor) for v in value]
    return factor * value


def _each(contacts: Json, change: Callable[[Json], Json]) -> Json:
    return [{**contact, **change(contact)} for contact in contacts]


def _rows_case(case: Json, output: Json) -> Json:
    """The rows of a step as a case of the layer ``rows``."""
    pairs = {pair["name"]: pair for pair in case["pairs"]}
    known = ("mu_v", "mu_omega", "rows")
    contacts = _each(output["contacts"], lambda c: {key: pairs[c["pair"]][key] for key in known})
    return {"cone": case["cone"], "contacts": contacts}


def _counts(case: Json) -> list[int]:
    """How many rows each contact has."""
    table = cone(case["cone"])
    return [
        len(table.row_names) if contact["rows"] == 6 else table.short
        for contact in case["contacts"]
    ]


def _kept_rows(case: Json, output: Json, keep: Callable[[int], list[int]]) -> Json:
    """A and b with the rows of each contact chosen, or in another order."""
    A, b, at = [], [], 0
    for count in _counts(case):
        A += [output["A"][at + i] for i in keep(count)]
        b += [output["b"][at + i] for i in keep(count)]
        at += count
    return {"A": A, "b": b}


def of_rows(change: Callable[[Json, Json], Iterable[Json]]) -> dict[str, Prediction]:
    """The same mistake in the layers ``rows`` and ``step``."""
    return {
        "rows": change,
        "step": lambda case, output: change(_rows_case(case, output), output),
    }


# Signs.


def opposite(*names: str) -> Prediction:
    """Some fields with the other sign."""
    return lambda case, output: [_scaled(output, -1.0, *names)]


def reversed_rows(case: Json, output: Json) -> Iterable[Json]:
    """Rows (-n~ + d~)' J."""
    A, at = [], 0
    for contact, count in zip(case["contacts"], _counts(case), strict=True):
        normal = np.array(contact["n"]) @ np.array(contact["J"])[:3]
        A += (np.array(output["A"][at : at + count]) - 2 * normal).tolist()
        at += count
    return [{"A": A}]


def reversed_wrench(case: Json, output: Json) -> Iterable[Json]:
    """The net wrench of forces along -n, and torques about it."""
    net = {name: np.array(w) for name, w in output["net"].items()}
    for contact, (_, _, f_n, tau_n) in zip(case["contacts"], output["wrench"], strict=True):
        n = np.array(contact["n"])
        for side, sign in (("beta", 1), ("alpha", -1)):
            name = contact[f"{side}_body"]
            if name in net:
                arm = np.array(contact[side]) - case["bodies"][name]["point"]
                along = np.concatenate([f_n * n, f_n * np.cross(arm, n) + tau_n * n])
                net[name] -= 2 * sign * along
    return [{"net": {name: w.tolist() for name, w in net.items()}}]


def reversed_spin(case: Json, output: Json) -> Iterable[Json]:
    """The spin about -n."""
    return [{"J": [[*J[:3], times(J[3], -1.0)] for J in output["J"]]}]


def contacts_changed(change: Callable[[Json], Json]) -> Prediction:
    """Fields of the contacts of a step; each prediction holds one of them."""

    def prediction(case: Json, output: Json) -> Iterable[Json]:
        return [{"contacts": [change(contact) for contact in output["contacts"]]}]

    return prediction


def unsigned(case: Json, output: Json) -> Iterable[Json]:
    """|phi|, with the normal of beta - alpha or without."""
    phi = np.abs(output["phi"]).tolist()
    inside = np.sign(np.array(output["phi"]))
    n = (np.where(inside == 0, 1.0, inside)[..., None] * np.array(output["n"])).tolist()
    return [{**output, "phi": phi}, {**output, "phi": phi, "n": n}]


def unsigned_selection(case: Json, output: Json) -> Iterable[Json]:
    """The nearest by |phi|."""
    return [again("selection", {**case, "phi": [np.abs(phi).tolist() for phi in case["phi"]]})]


# Bodies.


def swapped_points(case: Json, output: Json) -> Iterable[Json]:
    """Each body's point as the other's, with n or without."""
    swapped = {**output, "alpha": output["beta"], "beta": output["alpha"]}
    return [swapped, {**swapped, **_scaled(output, -1.0, "n")}]


def swapped_wrench(case: Json, output: Json) -> Iterable[Json]:
    """The wrench on the other body."""
    names = ("alpha", "beta", "alpha_body", "beta_body")
    others = ("beta", "alpha", "beta_body", "alpha_body")
    contacts = _each(
        case["contacts"], lambda c: {a: c[b] for a, b in zip(names, others, strict=True)}
    )
    return [again("wrench", {**case, "contacts": contacts})]


# Friction.


def with_mu_omega(mu_omega: Callable[[Json], float]) -> Callable[[Json], Json]:
    """A case with another mu_omega in each contact."""
    return lambda case: {
        **case,
        "contacts": _each(case["contacts"], lambda c: {"mu_omega": mu_omega(c)}),
    }


def mu_omega(change: Callable[[Json], Json]) -> dict[str, Prediction]:
    """What another mu_omega makes of rows and wrenches."""
    return {
        **of_rows(lambda case, output: [again("rows", change(case))]),
        "wrench": lambda case, output: [again("wrench", change(case))],
    }


def without_spin(case: Json, output: Json) -> Iterable[Json]:
    """Four rows for every contact of the pyramid."""
    return [_kept_rows(case, output, lambda count: list(range(4 if count == 6 else count)))]


def interleaved(case: Json, output: Json) -> Iterable[Json]:
    """Rows in MuJoCo's order."""
    return [_kept_rows(case, output, lambda count: [*MUJOCO_ORDER[:count]])]


def interleaved_lam(case: Json, output: Json) -> Iterable[Json]:
    """Lam read in MuJoCo's order."""

    def read(contact: Json) -> Json:
        lam = contact["lam"]
        return {"lam": [lam[MUJOCO_ORDER.index(i)] for i in range(len(lam))]}

    return [again("wrench", {**case, "contacts": _each(case["contacts"], read)})]


# h.


def by_h(*names: str) -> Prediction:
    """Multiplied by h, or divided by it."""

    def prediction(case: Json, output: Json) -> Iterable[Json]:
        known = (case["h"],) if "h" in case else TIME_STEPS
        return [_scaled(output, factor, *names) for h in known for factor in (h, 1 / h)]

    return prediction


def other_delta_q(case: Json, output: Json) -> Iterable[Json]:
    """delta_q multiplied by h before it is used, or divided."""
    factors = [f for h in TIME_STEPS for f in (h, 1 / h)]
    return [again("integrate", {**case, **_scaled(case, f, "delta_q")}) for f in factors]


# Frames and orders.


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

    return [again("rows", {**case, "contacts": _each(case["contacts"], misread)})]


def _misread_poses(value: Any) -> Any:
    """Every pose with its quaternion taken as [w, x, y, z]."""
    if isinstance(value, dict):
        return {
            key: v[1:] + v[:1] if key == "quaternion" else _misread_poses(v)
            for key, v in value.items()
        }
    return [_misread_poses(v) for v in value] if isinstance(value, list) else value


def misread(name: str) -> Prediction:
    """The answer to quaternions taken as [w, x, y, z], of poses, of q, or of both."""

    def prediction(case: Json, output: Json) -> Iterable[Json]:
        misread = _misread_poses(case)
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


def both(*predictions: Prediction) -> Prediction:
    """The variants of several predictions."""

    def prediction(case: Json, output: Json) -> Iterable[Json]:
        for one in predictions:
            yield from one(case, output)

    return prediction


def unactuated_first(case: Json, output: Json) -> Iterable[Json]:
    """Columns of J in the order [un-actuated; actuated]."""
    joints = {body["name"]: bool(body.get("actuated")) for body in case["mechanism"]["bodies"]}
    order: list[int] = []
    for actuated in (False, True):
        for at in places(case["mechanism"]):
            if joints[at.name] == actuated:
                order += range(at.v.start, at.v.stop)
    return [{"J": np.array(output["J"])[:, :, order].tolist()}]


def straight(case: Json, output: Json) -> Iterable[Json]:
    """X + R v in the place of the screw."""
    B = tangent_map(case["mechanism"], case["q"], "mujoco")
    moved = B.T @ np.array(case["delta_q"])
    q = list(output["q"])
    for at in places(case["mechanism"]):
        if at.kind == "floating":
            start = np.array(case["q"][at.q.start : at.q.start + 3])
            q[at.q.start : at.q.start + 3] = (start + moved[at.v.start : at.v.start + 3]).tolist()
    return [{"q": q}]
