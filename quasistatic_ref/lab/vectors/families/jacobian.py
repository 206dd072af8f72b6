"""Inputs of the layer `jacobian`: every kind of joint, both sides, chains and far contacts."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.by_hand import Case
from quasistatic_ref.lab.vectors.families.mechanisms import (
    few_digits,
    follower,
    free_body,
    gripper,
    link,
    random_pose,
    random_q,
    random_tree,
)

Pairs = list[tuple[str | None, str | None]]
"""alpha's body and beta's; None is the world."""


def jacobian_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    rng = np.random.default_rng(20)
    for kind in ("revolute", "prismatic", "continuous", "planar", "floating"):
        for turned in (False, True):
            yield _one_joint(rng, kind, turned)
    for base in ("fixed", "floating", "planar"):
        for number in range(7):
            tree = random_tree(rng, 2 + number, base)
            why = f"random tree of {2 + number} bodies on a {base} base, random contacts"
            name = f"jacobian/tree/{base}/{number}"
            yield name, why, with_contacts(rng, tree, 2 + number % 3)
    for number in range(4):
        tree = {"bodies": [*gripper()["bodies"], free_body()]}
        held: Pairs = [("left", "object"), ("right", "object"), (None, "object")]
        why = "a gripper on an actuated floating base holds a free body"
        yield f"jacobian/grasp/{number}", why, with_contacts(rng, tree, 5, held)
    for number, tree in enumerate(_chains(rng)):
        table = with_contacts(rng, tree, 2, [(None, "body7"), ("body7", "body3")])
        why = "a chain with fixed joints in it, from end to end"
        yield f"jacobian/chain/{number}", why, table
    yield from _corners(rng)


def _one_joint(rng: Rng, kind: str, turned: bool) -> Case:
    based = kind in ("planar", "floating")
    place = {"placement": random_pose(rng)} if turned and not based else {}
    axis = few_digits(rng.uniform(-1, 1, 3)) if turned else [0.0, 1.0, 0.0]
    tree = {"bodies": [link("body", None, kind, axis=axis, actuated=turned, **place)]}
    table = with_contacts(rng, tree, 2, [(None, "body"), ("body", None)])
    if not turned:
        straight = {"floating": [0.0] * 6 + [1.0], "planar": [0.0, 0.0, 1.0, 0.0]}
        table["q"] = straight.get(kind, [1.0, 0.0] if kind == "continuous" else [0.0])
    what = "turned frames, quaternions of any length" if turned else "frames along the axes"
    name = f"jacobian/{kind}/{'turned' if turned else 'straight'}"
    return name, f"one {kind} joint, {what}", table


def _chains(rng: Rng) -> Iterator[Json]:
    for kinds in (
        ("revolute", "fixed") * 4,
        ("fixed", "continuous", "fixed", "prismatic") * 2,
        ("prismatic",) * 8,
        ("revolute",) * 8,
    ):
        bodies = []
        for k, kind in enumerate(kinds):
            axis, place = few_digits(rng.uniform(-1, 1, 3)), random_pose(rng, 0.4)
            moves = {"axis": axis, "placement": place, "actuated": kind != "fixed" and k % 3 != 0}
            bodies.append(link(f"body{k}", f"body{k - 1}" if k else None, kind, **moves))
        yield {"bodies": bodies}


def _corners(rng: Rng) -> Iterator[Case]:
    free = {"bodies": [free_body()]}
    table = with_contacts(rng, free, 1, [(None, "object")])
    places = {"alpha": [1000.001, -500.0, 250.0], "beta": [1000.001, -500.0, 250.002]}
    q, far = [1000.0, -500.0, 250.0, 0.1, 0.2, 0.3, 0.9], [table["contacts"][0] | places]
    why = "a contact 1000 m from the origin, 1 mm from its body's: levers cancel"
    yield "jacobian/far", why, table | {"q": q, "contacts": far}
    same = with_contacts(rng, {"bodies": gripper()["bodies"]}, 1, [("left", "right")])
    yield "jacobian/fingers", "the two fingers of one gripper: the base does not enter", same
    origin = with_contacts(rng, free, 1, [(None, "object")])
    contact = origin["contacts"][0] | {"alpha": origin["q"][:3], "beta": origin["q"][:3]}
    yield "jacobian/origin", "a contact at the body's own origin", origin | {"contacts": [contact]}
    two = {"bodies": [free_body("one"), free_body("other")]}
    why = "alpha and beta far from each other: each is a point of its own body"
    yield "jacobian/apart", why, with_contacts(rng, two, 2, [("one", "other")])
    yield "jacobian/none", "no contacts: J is empty", origin | {"contacts": []}
    both = {"bodies": [free_body("free"), free_body("moved", actuated=True)]}
    why = "the actuated body comes first in delta_q, whatever the order in the file"
    yield "jacobian/order", why, with_contacts(rng, both, 2, [("moved", "free")])
    for number, z in enumerate((1.0, -1.0)):
        table = with_contacts(rng, free, 1, [(None, "object")])
        frame = {"n": [0.0, 0.0, z], "d1": [1.0, 0.0, 0.0], "d2": [0.0, z, 0.0]}
        why = "the normal along the vertical, up and down: the spin changes its sign"
        turned = [table["contacts"][0] | frame]
        yield f"jacobian/normal/{number}", why, table | {"contacts": turned}
    for joint in ("prismatic", "revolute"):
        tree = {"bodies": [link("stand", None, "fixed"), *follower(joint, "stand")]}
        why = f"a {joint} joint that follows another at -1/2 of it and 0.35 away, on both sides"
        yield f"jacobian/mimic/{joint}", why, with_contacts(rng, tree, 2, [("drive", "finger")])


def with_contacts(rng: Rng, tree: Json, count: int, pairs: Pairs | None = None) -> Json:
    """The input with so many contacts at random, between these bodies or any."""
    names = [body["name"] for body in tree["bodies"]]
    contacts = []
    for k in range(count):
        if pairs is None:
            alpha, beta = (None, *names)[int(rng.integers(len(names)))], names[-1]
        else:
            alpha, beta = pairs[k % len(pairs)]
        n, d1, d2 = _frame(rng)
        point = {side: few_digits(rng.uniform(-1, 1, 3)) for side in ("alpha", "beta")}
        bodies = {"alpha_body": alpha, "beta_body": beta}
        contacts.append({**bodies, "n": n, "d1": d1, "d2": d2, **point})
    return {"mechanism": tree, "q": random_q(rng, tree), "contacts": contacts}


def _frame(rng: Rng) -> tuple[list[float], list[float], list[float]]:
    """Unit vectors n, d1, d2 in float64: as a layer before gives them."""
    n = rng.uniform(-1, 1, 3)
    n /= np.sqrt(n @ n)
    d1 = np.cross(n, np.eye(3)[int(np.abs(n).argmin())])
    d1 /= np.sqrt(d1 @ d1)
    return n.tolist(), d1.tolist(), np.cross(n, d1).tolist()
