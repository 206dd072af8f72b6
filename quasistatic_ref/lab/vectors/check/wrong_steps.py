"""What mistakes about a whole step answer: H and g of other forces, and other contacts."""

from collections.abc import Iterable
from typing import Final

import numpy as np

from quasistatic_ref.lab.vectors.check.predictions import each
from quasistatic_ref.lab.vectors.check.wrong_contacts import OFFSETS
from quasistatic_ref.lab.vectors.check.wrong_contacts import one_point as one_point_of_J
from quasistatic_ref.lab.vectors.check.wrong_frames import misread_poses
from quasistatic_ref.lab.vectors.converters import xyzw
from quasistatic_ref.lab.vectors.exact.masses import gravity_force
from quasistatic_ref.lab.vectors.exact.mechanism import mechanism, poses
from quasistatic_ref.lab.vectors.exact.precision import rounded
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers.step import contacts_of, objective
from quasistatic_ref.step.data import Array

PLACED: Final = ("contacts.index", "contacts.phi", "contacts.n", "contacts.alpha", "contacts.beta")
"""Fields of a step that say where its contacts are."""


def _objective(case: Json, **changes: Json) -> tuple[Array, Array]:
    """H and g of a case that is changed."""
    changed = {**case, **changes}
    H, g, _ = objective(mechanism(changed["mechanism"]), changed)
    return np.array(H), np.array(g)


def _rotations(case: Json) -> dict[str, Array]:
    """R of every body, from its frame to the world."""
    tree = mechanism(case["mechanism"])
    R = rounded(lambda: poses(tree, case["q"]).R)[0]
    return {body.name: np.array(one) for body, one in zip(tree.bodies, R, strict=True)}


def _parts_of_g(case: Json, output: Json) -> tuple[Array, Array]:
    """The forces' part of g and the springs'."""
    g = np.array(output["g"])
    forces = _objective(case, K_q=np.zeros_like(case["K_q"]).tolist())[1]
    return forces, g - forces


def gravity_sign(case: Json, output: Json) -> Iterable[Json]:
    """Gravity the other way."""
    return [{"g": _objective(case, gravity=[-x for x in case["gravity"]])[1].tolist()}]


def gravity_everywhere(case: Json, output: Json) -> Iterable[Json]:
    """Gravity on all coordinates."""
    tree = mechanism(case["mechanism"])
    weight = rounded(lambda: gravity_force(tree, poses(tree, case["q"]), case["gravity"]))[0]
    g = np.array(output["g"])
    g[: tree.n_a] += case["h"] * np.array(weight)[: tree.n_a]
    return [{"g": g.tolist()}]


def without_h(case: Json, output: Json) -> Iterable[Json]:
    """G / h, or that of the forces or of the springs alone."""
    forces, springs = _parts_of_g(case, output)
    h = case["h"]
    for g in ((forces + springs) / h, forces / h + springs, forces + springs / h):
        yield {"g": g.tolist()}


def other_mass(case: Json, output: Json) -> Iterable[Json]:
    """M_u / h^2, or M_u."""
    n_a = len(case["K_q"])
    for factor in (1 / case["h"], case["h"]):
        H = np.array(output["H"])
        H[n_a:, n_a:] *= factor
        yield {"H": H.tolist()}


def opposite_target(case: Json, output: Json) -> Iterable[Json]:
    """The springs' part of g with the other sign."""
    forces, springs = _parts_of_g(case, output)
    return [{"g": (forces - springs).tolist()}]


def unturned_inertia(case: Json, output: Json) -> Iterable[Json]:
    """Inertias along the world's axes: R'I R in the place of I."""
    R = _rotations(case)
    bodies = [
        {**body, "inertia": (R[body["name"]].T @ body["inertia"] @ R[body["name"]]).tolist()}
        if "inertia" in body
        else body
        for body in case["mechanism"]["bodies"]
    ]
    return [{"H": _objective(case, mechanism={"bodies": bodies})[0].tolist()}]


def wrench_at_origin(case: Json, output: Json) -> Iterable[Json]:
    """External forces at the bodies' origins: about the centre of mass they turn by -c x F."""
    R, com = _rotations(case), {b["name"]: b.get("com") for b in case["mechanism"]["bodies"]}
    moved = [
        {
            **w,
            "torque": (
                np.array(w["torque"]) - np.cross(R[w["body"]] @ com[w["body"]], w["force"])
            ).tolist(),
        }
        for w in case.get("wrenches", [])
    ]
    return [{"g": _objective(case, wrenches=moved)[1].tolist()}]


def one_point(case: Json, output: Json) -> Iterable[Json]:
    """J of one point of both bodies."""
    pairs = {pair["name"]: pair for pair in case["pairs"]}

    def bodies(contact: Json) -> Json:
        pair = pairs[contact["pair"]]
        return {f"{s}_body": case["shapes"][pair[s]]["body"] for s in ("alpha", "beta")}

    given = {**case, "contacts": each(output["contacts"], bodies)}
    for answer in one_point_of_J(given, output):
        yield {"contacts": [{"J": J} for J in answer["J"]]}


def _contacts(case: Json) -> Json:
    """The contacts of a changed case, without J."""
    return {"contacts": contacts_of(mechanism(case["mechanism"]), case)[0]}


def other_offset(case: Json, output: Json) -> Iterable[Json]:
    """Contacts with half-spaces elsewhere."""
    for change in OFFSETS:
        shapes = {
            name: {**entry, "shape": change(entry["shape"])}
            for name, entry in case["shapes"].items()
        }
        if shapes != case["shapes"]:
            yield _contacts({**case, "shapes": shapes})


def misread(case: Json, output: Json) -> Iterable[Json]:
    """Contacts where quaternions of poses, of q or of both are taken as [w, x, y, z]."""
    poses_misread = misread_poses(case)
    for other in (case, poses_misread):
        yield _contacts({**other, "q": xyzw(case["mechanism"], case["q"])})
    yield _contacts(poses_misread)
