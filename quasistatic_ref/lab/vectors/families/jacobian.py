"""Inputs of the layer `jacobian`: every kind of joint, both sides, chains and far contacts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.by_hand import Case
from quasistatic_ref.lab.vectors.families.mechanisms import (
    few_digits,
    free_body,
    gripper,
    link,
    random_pose,
    random_q,
    random_tree,
)


def jacobian_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    rng = np.random.default_rng(20)
    for kind in ("revolute", "prismatic", "continuous", "planar", "floating"):
        for turned in (False, True):
            yield _one_joint(rng, kind, turned)
    for base in ("fixed", "floating", "planar"):
        for number in range(7):
            tree = random_tree(rng, 2 + number, base)
            yield (
                f"jacobian/tree/{base}/{number}",
                f"random tree of {2 + number} bodies on a {base} base, random contacts",
                _with_contacts(rng, tree, 2 + number % 3),
            )
    for number in range(4):
        tree = {"bodies": [*gripper()["bodies"], free_body()]}
        yield (
            f"jacobian/grasp/{number}",
            "a gripper on an actuated floating base holds a free body",
            _with_contacts(
                rng, tree, 5, [("left", "object"), ("right", "object"), (None, "object")]
            ),
        )
    for number, tree in enumerate(_chains(rng)):
        yield (
            f"jacobian/chain/{number}",
            "a chain with fixed joints in it, from end to end",
            _with_contacts(rng, tree, 2, [(None, "body7"), ("body7", "body3")]),
        )
    yield from _corners(rng)


def _one_joint(rng: Rng, kind: str, turned: bool) -> Case:
    based = kind in ("planar", "floating")
    place = {"placement": random_pose(rng)} if turned and not based else {}
    axis = few_digits(rng.uniform(-1, 1, 3)) if turned else [0.0, 1.0, 0.0]
    tree = {"bodies": [link("body", None, kind, axis=axis, actuated=turned, **place)]}
    table = _with_contacts(rng, tree, 2, [(None, "body"), ("body", None)])
    if not turned:
        straight = {"floating": [0.0] * 6 + [1.0], "planar": [0.0, 0.0, 1.0, 0.0]}
        table["q"] = straight.get(kind, [1.0, 0.0] if kind == "continuous" else [0.0])
    what = "turned frames, quaternions of any length" if turned else "frames along the axes"
    return (
        f"jacobian/{kind}/{'turned' if turned else 'straight'}",
        f"one {kind} joint, {what}",
        table,
    )


def _chains(rng: Rng) -> Iterator[Json]:
    for kinds in (
        ("revolute", "fixed") * 4,
        ("fixed", "continuous", "fixed", "prismatic") * 2,
        ("prismatic",) * 8,
        ("revolute",) * 8,
    ):
        yield {
            "bodies": [
                link(
                    f"body{k}",
                    f"body{k - 1}" if k else None,
                    kind,
                    axis=few_digits(rng.uniform(-1, 1, 3)),
                    placement=random_pose(rng, 0.4),
                    actuated=kind != "fixed" and k % 3 != 0,
                )
                for k, kind in enumerate(kinds)
            ]
        }


def _corners(rng: Rng) -> Iterator[Case]:
    free = {"bodies": [free_body()]}
    table = _with_contacts(rng, free, 1, [(None, "object")])
    yield (
        "jacobian/far",
        "a contact 1000 m from the origin, 1 mm from its body's: levers cancel",
        table
        | {
            "q": [1000.0, -500.0, 250.0, 0.1, 0.2, 0.3, 0.9],
            "contacts": [
                table["contacts"][0]
                | {"alpha": [1000.001, -500.0, 250.0], "beta": [1000.001, -500.0, 250.002]}
            ],
        },
    )
    same = _with_contacts(rng, {"bodies": gripper()["bodies"]}, 1, [("left", "right")])
    yield "jacobian/fingers", "the two fingers of one gripper: the base does not enter", same
    origin = _with_contacts(rng, free, 1, [(None, "object")])
    contact = origin["contacts"][0] | {"alpha": origin["q"][:3], "beta": origin["q"][:3]}
    yield "jacobian/origin", "a contact at the body's own origin", origin | {"contacts": [contact]}
    yield (
        "jacobian/apart",
        "alpha and beta far from each other: each is a point of its own body",
        _with_contacts(
            rng, {"bodies": [free_body("one"), free_body("other")]}, 2, [("one", "other")]
        ),
    )
    yield "jacobian/none", "no contacts: J is empty", origin | {"contacts": []}
    both = {"bodies": [free_body("moved", actuated=True), free_body("free")]}
    yield (
        "jacobian/order",
        "the actuated body comes first in delta_q, whatever the order in the file",
        _with_contacts(rng, {"bodies": both["bodies"][::-1]}, 2, [("moved", "free")]),
    )
    for number, z in enumerate((1.0, -1.0)):
        table = _with_contacts(rng, free, 1, [(None, "object")])
        frame = {"n": [0.0, 0.0, z], "d1": [1.0, 0.0, 0.0], "d2": [0.0, z, 0.0]}
        yield (
            f"jacobian/normal/{number}",
            "the normal along the vertical, up and down: the spin changes its sign",
            table | {"contacts": [table["contacts"][0] | frame]},
        )


def _with_contacts(
    rng: Rng, tree: Json, count: int, pairs: list[tuple[str | None, str | None]] | None = None
) -> Json:
    names = [body["name"] for body in tree["bodies"]]
    contacts = []
    for k in range(count):
        if pairs is None:
            alpha, beta = (None, *names)[int(rng.integers(len(names)))], names[-1]
        else:
            alpha, beta = pairs[k % len(pairs)]
        n, d1, d2 = _frame(rng)
        point = {side: few_digits(rng.uniform(-1, 1, 3)) for side in ("alpha", "beta")}
        contacts.append(
            {"alpha_body": alpha, "beta_body": beta, "n": n, "d1": d1, "d2": d2} | point
        )
    return {"mechanism": tree, "q": random_q(rng, tree), "contacts": contacts}


def _frame(rng: Rng) -> tuple[list[float], list[float], list[float]]:
    """Unit vectors n, d1, d2 in float64: as a layer before gives them."""
    n = rng.uniform(-1, 1, 3)
    n /= np.sqrt(n @ n)
    d1 = np.cross(n, np.eye(3)[int(np.abs(n).argmin())])
    d1 /= np.sqrt(d1 @ d1)
    return n.tolist(), d1.tolist(), np.cross(n, d1).tolist()
