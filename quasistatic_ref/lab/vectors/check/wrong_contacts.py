"""What mistakes about a contact answer: its normal, its bodies, its rows and its friction."""

from collections.abc import Callable, Iterable, Sequence
from typing import Final

import numpy as np

from quasistatic_ref.lab.vectors.check.predictions import Prediction, again, each, scaled, times
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers.rows import by_contact, row_count

MUJOCO_ORDER: Final = (0, 2, 1, 3, 4, 5)
"""Ours of +d1 -d1 +d2 -d2 +spin -spin."""


def _rows_case(case: Json, output: Json) -> Json:
    """The rows of a step as a case of the layer ``rows``."""
    pairs = {pair["name"]: pair for pair in case["pairs"]}
    known = ("mu_v", "mu_omega", "rows")
    contacts = each(output["contacts"], lambda c: {key: pairs[c["pair"]][key] for key in known})
    return {"cone": case["cone"], "contacts": contacts}


def _kept_rows(case: Json, output: Json, keep: Callable[[int], Iterable[int]]) -> Json:
    """A and b with the rows of each contact chosen, or in another order."""
    kept: Json = {"A": [], "b": []}
    for name, rows in kept.items():
        for part in by_contact(output[name], case["cone"], case["contacts"]):
            rows += [part[i] for i in keep(len(part))]
    return kept


def of_rows(change: Callable[[Json, Json], Iterable[Json]]) -> dict[str, Prediction]:
    """The same mistake in the layers ``rows`` and ``step``."""
    return {
        "rows": change,
        "step": lambda case, output: change(_rows_case(case, output), output),
    }


def reversed_rows(case: Json, output: Json) -> Iterable[Json]:
    """Rows (-n~ + d~)' J."""
    A: Json = []
    parts = by_contact(output["A"], case["cone"], case["contacts"])
    for contact, part in zip(case["contacts"], parts, strict=True):
        normal = np.array(contact["n"]) @ np.array(contact["J"])[:3]
        A += (np.array(part) - 2 * normal).tolist()
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


def reversed_torque(case: Json, output: Json) -> Iterable[Json]:
    """The torque about -n, in the wrenches and in what they come to."""
    turned = [again("wrench", with_mu_omega(lambda c: -c["mu_omega"])(case))]
    return [*turned, {"wrench": [[*w[:3], -w[3]] for w in output["wrench"]]}]


def spins_exchanged(case: Json, output: Json) -> Iterable[Json]:
    """-spin before +spin, where they come last: in the pyramid and in facets."""
    return [_kept_rows(case, output, lambda count: exchanged_spins(case, count))]


def exchanged_spins(case: Json, count: int) -> list[int]:
    """Rows of a contact, those after its sides the other way round."""
    sides = row_count(case["cone"], 4)
    return [*range(min(sides, count)), *reversed(range(sides, count))]


def mujoco_order(case: Json, count: int) -> list[int]:
    """Rows of a contact in MuJoCo's order."""
    return list(MUJOCO_ORDER[:count])


def one_point(case: Json, output: Json) -> Iterable[Json]:
    """J of one point for both bodies: midway, alpha or beta."""
    for share in (0.5, 0.0, 1.0):
        contacts = []
        for c in case["contacts"]:
            alpha, beta = np.array(c["alpha"]), np.array(c["beta"])
            point = (alpha + share * (beta - alpha)).tolist()
            contacts.append({**c, "alpha": point, "beta": point})
        yield again("jacobian", {**case, "contacts": contacts})


def other_offset(case: Json, output: Json) -> Iterable[Json]:
    """A half-space whose offset is not divided by its normal's length, or has the other sign."""
    for change in OFFSETS:
        sides = {side: change(case[side]) for side in ("alpha", "beta")}
        if sides != {side: case[side] for side in sides}:
            yield again("distance", {**case, **sides})


def _undivided(shape: Json) -> Json:
    if shape["kind"] != "halfspace":
        return shape
    return {**shape, "offset": shape["offset"] * float(np.linalg.norm(shape["normal"]))}


def _opposite_offset(shape: Json) -> Json:
    return {**shape, "offset": -shape["offset"]} if shape["kind"] == "halfspace" else shape


OFFSETS: Final = (_undivided, _opposite_offset)
"""Wrong half-spaces of a shape."""


def unsigned(case: Json, output: Json) -> Iterable[Json]:
    """|phi|, with the normal of beta - alpha or without."""
    phi = np.abs(output["phi"]).tolist()
    inside = np.sign(np.array(output["phi"]))
    n = (np.where(inside == 0, 1.0, inside)[..., None] * np.array(output["n"])).tolist()
    return [{**output, "phi": phi}, {**output, "phi": phi, "n": n}]


def unsigned_selection(case: Json, output: Json) -> Iterable[Json]:
    """The nearest by |phi|."""
    return [again("selection", {**case, "phi": [np.abs(phi).tolist() for phi in case["phi"]]})]


def swapped_points(case: Json, output: Json) -> Iterable[Json]:
    """Each body's point as the other's, with n or without."""
    swapped = {**output, "alpha": output["beta"], "beta": output["alpha"]}
    return [swapped, {**swapped, **scaled(output, -1.0, "n")}]


def swapped_wrench(case: Json, output: Json) -> Iterable[Json]:
    """The wrench on the other body."""
    names = ("alpha", "beta", "alpha_body", "beta_body")
    others = ("beta", "alpha", "beta_body", "alpha_body")
    contacts = each(
        case["contacts"], lambda c: {a: c[b] for a, b in zip(names, others, strict=True)}
    )
    return [again("wrench", {**case, "contacts": contacts})]


def with_mu_omega(mu_omega: Callable[[Json], float]) -> Callable[[Json], Json]:
    """A case with another mu_omega in each contact."""
    return lambda case: {
        **case,
        "contacts": each(case["contacts"], lambda c: {"mu_omega": mu_omega(c)}),
    }


def mu_omega(change: Callable[[Json], Json]) -> dict[str, Prediction]:
    """What another mu_omega makes of rows and wrenches."""
    return {
        **of_rows(lambda case, output: [again("rows", change(case))]),
        "wrench": lambda case, output: [again("wrench", change(case))],
    }


def without_spin(case: Json, output: Json) -> Iterable[Json]:
    """Four rows for every contact of the pyramid."""
    return [_kept_rows(case, output, lambda count: range(4 if count == 6 else count))]


def interleaved(case: Json, output: Json) -> Iterable[Json]:
    """Rows in MuJoCo's order."""
    return [_kept_rows(case, output, lambda count: MUJOCO_ORDER[:count])]


def lam_in_order(order: Callable[[Json, int], Sequence[int]]) -> Prediction:
    """Lam read in another order of a contact's rows."""

    def prediction(case: Json, output: Json) -> Iterable[Json]:
        def read(contact: Json) -> Json:
            lam = contact["lam"]
            places = order(case, len(lam))
            return {"lam": [lam[places.index(i)] for i in range(len(lam))]}

        return [again("wrench", {**case, "contacts": each(case["contacts"], read)})]

    return prediction
