"""M_u, gravity's force and J of random mechanisms with mimic joints, against the plain program.

    python -m validation.make.random_mechanisms [--count COUNT]

The program, quasistatic_ref/lab/program, shares no code with the package's model.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.program.mechanism import kinematics, point_jacobian, slices
from quasistatic_ref.lab.program.step import loads
from quasistatic_ref.lab.vectors.challenge.random_mechanisms import random_q, random_tree
from quasistatic_ref.lab.vectors.own.system import OwnSystem, own_system
from validation.tools.scripts import asked

Json = dict[str, Any]
CALLS = 10
GRAVITY = np.array([1.0, -2.0, -9.81])
FORCE, TORQUE = np.array([1.0, 2.0, 3.0]), np.array([4.0, 5.0, 6.0])
"""A wrench at the centre of mass of each root [N, N m]."""
QUANTITIES = ("R, t", "J", "gravity", "wrench", "M_u")
WORDS = """Errors are the largest difference over the largest entry of a quantity. Each mechanism is
evaluated ten times by one `System`, at three configurations in turn; the first call and the tenth
are at the same one.
"""


def random_mechanism(rng: np.random.Generator) -> Json:
    """One tree of bodies or two; about half of the joints that can follow another one do."""
    bodies = []
    for name in ("arm", "hand")[: rng.integers(1, 3)]:
        size = int(rng.integers(1, 11))
        base = str(rng.choice(["fixed", "floating", "planar"]))
        tree = random_tree(rng, size, base if size > 1 else "floating", masses=True)["bodies"]
        for body in tree:
            body["name"] = f"{name} {body['name']}"
            body["parent"] = body["parent"] and f"{name} {body['parent']}"
        bodies += with_mimics(rng, tree)
    return {"bodies": bodies}


def with_mimics(rng: np.random.Generator, tree: list[Json]) -> list[Json]:
    """A tree with mimic joints; URDF's reader wants a leader before those that follow it."""
    leaders: list[Json] = []
    for body in depth_first(tree, tree[0]):
        if body["joint"] not in ("revolute", "prismatic", "continuous"):
            continue
        endless = body["joint"] == "continuous"
        able = [one["name"] for one in leaders if (one["joint"] == "continuous") == endless]
        if not able or rng.random() < 0.5:
            leaders.append(body)
            continue
        multiplier = float(rng.choice([-1, 1]) * rng.choice([1.0, rng.uniform(0.1, 2)]))
        follow = {"of": str(rng.choice(able)), "multiplier": multiplier}
        body |= {"actuated": False, "mimic": follow | {"offset": float(rng.uniform(-1, 1))}}
    return tree


def depth_first(tree: list[Json], at: Json) -> Iterator[Json]:
    """The bodies at and below one of them, as URDF's reader visits them."""
    yield at
    for body in tree:
        if body["parent"] == at["name"]:
            yield from depth_first(tree, body)


def by_angles(mechanism: Json, q: list[float]) -> tuple[Json, np.ndarray]:
    """The same with revolute in place of continuous joints, in which the program has no mimics."""
    at = slices(mechanism)[0]
    revolute = []
    own = {}
    for body in mechanism["bodies"]:
        endless = body["joint"] == "continuous"
        revolute.append(body | {"joint": "revolute"} if endless else body)
        if body["name"] in at:
            start = at[body["name"]][0].start
            values = q[at[body["name"]][0]]
            own[start] = [np.arctan2(values[1], values[0])] if endless else values
    return {"bodies": revolute}, np.concatenate([own[start] for start in sorted(own)])


def expected(of: Json, q: list[float]) -> list[np.ndarray]:
    """Each of QUANTITIES, by the plain program."""
    mechanism, angles = by_angles(of, q)
    bodies = mechanism["bodies"]
    at = kinematics(mechanism, angles)
    none = np.zeros(3)
    weights = [{"body": b["name"], "force": b["mass"] * GRAVITY, "torque": none} for b in bodies]
    M, weight = loads({"mechanism": mechanism, "gravity": none, "wrenches": weights}, at)
    pushed = np.zeros(len(weight))
    for root in free_roots(mechanism):
        v, w = point_jacobian(at[root["name"]], root_centre(bodies, root, at))
        pushed += v.T @ FORCE + w.T @ TORQUE
    poses = [np.column_stack(at[b["name"]][:2]) for b in bodies]
    J = [at[b["name"]][2] for b in bodies]
    n_a = slices(mechanism)[1]
    return [np.array(poses), np.array(J), weight, pushed, M[n_a:, n_a:]]


def free_roots(mechanism: Json) -> list[Json]:
    """The bodies that move in the world without a joint."""
    return [b for b in mechanism["bodies"] if b["joint"] in ("floating", "planar")]


def root_centre(bodies: list[Json], root: Json, at: Any) -> np.ndarray:
    """Centre of mass of a root and of the bodies that are welded to it."""
    welded = [root]
    for body in bodies:
        if body["joint"] == "fixed" and body["parent"] in [one["name"] for one in welded]:
            welded.append(body)
    centres = [at[b["name"]][0] @ b["com"] + at[b["name"]][1] for b in welded]
    return np.average(centres, axis=0, weights=[b["mass"] for b in welded])


def found(own: OwnSystem, mechanism: Json, q: np.ndarray) -> list[np.ndarray]:
    """The same as the package has it, in the mechanism's order of bodies and coordinates."""
    system = own.system
    at = system.kinematics(q)
    links = [own.links[body["name"]] for body in mechanism["bodies"]]
    poses = np.concatenate([at.R, at.t[:, :, None]], axis=2)[links]
    pushed = np.zeros(system.n_v)
    for root in free_roots(mechanism):
        body = system.links[own.links[root["name"]]].partition("/")[0]
        pushed += system.centre_of_mass_force(q, body, FORCE, TORQUE)
    free = own.v[system.n_a :] - system.n_a
    M_u = system.M_u(q)[np.ix_(free, free)]
    weight = system.gravity_force(q, GRAVITY)
    return [poses, at.J[links][:, :, own.v], weight[own.v], pushed[own.v], M_u]


def error(a: np.ndarray, b: np.ndarray) -> float:
    """Largest difference of two arrays, over the largest entry of the second."""
    return float(np.abs(a - b).max(initial=0.0) / (np.abs(b).max(initial=0.0) or 1.0))


def compare(seed: int) -> tuple[Counter[str], np.ndarray, bool]:
    """What a mechanism has, its errors (calls, quantities), whether its bits stay the same."""
    rng = np.random.default_rng(seed)
    mechanism = random_mechanism(rng)
    own = own_system(mechanism)
    q = [random_q(rng, mechanism) for _ in range(3)]
    truth = [expected(mechanism, one) for one in q]
    answers = [found(own, mechanism, own.model_q(q[call % 3])) for call in range(CALLS)]
    errors = np.array([
        [error(a, b) for a, b in zip(answers[call], truth[call % 3], strict=True)]
        for call in range(CALLS)
    ])  # fmt: skip
    same = all(np.array_equal(a, b) for a, b in zip(answers[0], answers[-1], strict=True))
    return features(mechanism), errors, same


def features(mechanism: Json) -> Counter[str]:
    """How many mimic joints there are, and of which kinds."""
    count = Counter[str]()
    of = {body["name"]: body for body in mechanism["bodies"]}
    for body in of.values():
        if "mimic" not in body:
            continue
        leader = of[body["mimic"]["of"]]
        above = []
        parent = body["parent"]
        while parent is not None:
            above.append(of[parent])
            parent = of[parent]["parent"]
        count["mimic joints"] += 1
        count["negative"] += body["mimic"]["multiplier"] < 0
        count["passive"] += not leader["actuated"]
        count["below another mimic joint"] += any("mimic" in one for one in above)
        count["below its leader"] += leader in above
        count["of another kind than its leader"] += body["joint"] != leader["joint"]
    return count


def report(count: int) -> str:
    """The committed result."""
    kinds = Counter[str]()
    errors = []
    same = 0
    with_mimic = 0
    for seed in range(count):
        own, off, equal = compare(seed)
        kinds += own
        errors.append(off)
        same += equal
        with_mimic += own["mimic joints"] > 0
    worst = np.array(errors)
    lines = [f"{count} random mechanisms, {with_mimic} of them with mimic joints.", "", WORDS]
    columns = worst[:, 0], worst[:, -1], worst.max(axis=1)
    rows = [
        (name, *(f"{column[:, k].max():.0e}" for column in columns))
        for k, name in enumerate(QUANTITIES)
    ]
    lines += markdown_table(("quantity", "first call", "tenth call", "any call"), rows)
    lines += ["", f"Equal bits at the first and the tenth call: {same} of {count}.", ""]
    lines += ["; ".join(f"{name}: {number}" for name, number in kinds.items()) + "."]
    return "\n".join(lines)


def main() -> None:
    """Print the result."""
    print(report(asked(__doc__, count=1000).count))


if __name__ == "__main__":
    main()
