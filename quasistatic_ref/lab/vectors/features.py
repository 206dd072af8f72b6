"""Which features of the format the cases of a layer have, and how often."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from quasistatic_ref.lab.program.candidates import FACING
from quasistatic_ref.lab.program.rotation import rotation
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers.step import shape_pose
from quasistatic_ref.lab.vectors.tables import ORIGIN
from quasistatic_ref.lab.vectors.trees import nodes

FEW = 5
"""Cases of a feature that are few."""
FLAT = 1e-12
"""1 less the cosine of n to the normal of a face that it is, at most: rounding makes it 7e-16 in
the vectors, and the least tilt 4e-8 [-]."""


def features(case: Json, output: Json) -> set[str]:
    """The features of one case.

    Parameters
    ----------
    case, output : dict
        The input, and the expected output.
    """
    found = {*_of_bodies(case.get("mechanism", {}).get("bodies", [])), *_of_shapes(case)}
    found |= {f"cone {case['cone']}"} if "cone" in case else set()
    for path, value in nodes(case):
        key = path[-1] if path else ""
        if key in ("mu_v", "mu_omega") and value == 0:
            found.add(f"{key} 0")
        elif key == "rows":
            found.add(f"rows {value}")
    for contact in (*case.get("contacts", []), *output.get("contacts", [])):
        found |= {"phi below 0"} if contact.get("phi", 0) < 0 else set()
        sizes = np.sort(np.abs(contact["n"]))
        found |= {"two least entries of n equal"} if sizes[0] == sizes[1] else set()
    found |= {*_of_boxes(case, output)}
    K_q = np.array(case.get("K_q", []))
    if K_q.size and np.count_nonzero(K_q - np.diag(np.diag(K_q))):
        found.add("springs coupled")
    for key in ("wrenches", "normals", "second_order"):
        found |= {key} if case.get(key) else set()
    if "pose_alpha" in case and np.min(output["phi"]) < 0:
        found.add("phi below 0")
    if "indices" in output:
        for group, kept in zip(case["phi"], output["indices"], strict=True):
            found |= {"equal phi"} if len(set(group)) < len(group) else set()
            found |= {"k above the candidates"} if len(group) < case["k"] else set()
            found |= {"empty group"} if not kept else set()
    found |= {"no solution"} if "farkas" in output else set()
    return found | {f"kink {reason['kind']}" for reason in output.get("reasons", [])}


def _of_bodies(bodies: Sequence[Json]) -> Iterator[str]:
    shifted = {body["name"] for body in bodies if body.get("mimic", {}).get("offset")}
    for body in bodies:
        if body["parent"] in shifted:
            yield f"joint {body['joint']} of a mimic with an offset"
        where = "of the world" if body["parent"] is None else "of a body"
        yield f"joint {body['joint']} {where}"
        if body.get("actuated") and body["joint"] in ("floating", "planar"):
            yield f"{body['joint']} base actuated"
        if body["placement"] != ORIGIN:
            yield "placement"
        if any(body.get("com", ())):
            yield "centre of mass off the origin"
        inertia = np.array(body.get("inertia", np.eye(3)))
        if np.count_nonzero(inertia - np.diag(np.diag(inertia))):
            yield "inertia with products"
        if "mimic" in body:
            yield "mimic"
            yield from ("mimic with a factor",) * (body["mimic"]["multiplier"] not in (1, 0))
            yield from ("mimic with an offset",) * (body["mimic"]["offset"] != 0)


def _of_shapes(case: Json) -> Iterator[str]:
    pairs = [(case["alpha"], case["beta"])] if "pose_alpha" in case else []
    for pair in case.get("pairs", []):
        pairs.append(tuple(case["shapes"][pair[side]]["shape"] for side in ("alpha", "beta")))
    for alpha, beta in pairs:
        yield f"{alpha['kind']} on {beta['kind']}"


def _of_boxes(case: Json, output: Json) -> Iterator[str]:
    """How n of a step's contacts of two boxes lies to the normals of their faces."""
    pairs = {pair["name"]: pair for pair in case.get("pairs", [])}
    for contact in output.get("contacts", []):
        if contact.get("pair") not in pairs:
            continue
        sides = [case["shapes"][pairs[contact["pair"]][side]] for side in ("alpha", "beta")]
        if all(side["shape"]["kind"] == "box" for side in sides):
            turns = (rotation(np.array(shape_pose(case, side)["quaternion"])) for side in sides)
            cosines = (np.abs(np.array(contact["n"]) @ R).max() for R in turns)
            yield "n of two boxes " + " and ".join(sorted(map(_from_a_face, cosines)))


def _from_a_face(cosine: float) -> str:
    if cosine > 1 - FLAT:
        return "of a face"
    return "near a face" if cosine > FACING else "of an edge"


def feature_counts(cases: Iterable[tuple[Json, Json]]) -> Counter[str]:
    """How many of a layer's cases have each feature.

    Parameters
    ----------
    cases : iterable of (dict, dict)
        Inputs and expected outputs.
    """
    return Counter(name for case, output in cases for name in features(case, output))
