"""M_u, gravity's force and J of random mechanisms with mimic joints, against the plain program.

    python -m validation.make.random_mechanisms [--count COUNT]

The program, quasistatic_ref/lab/program/, shares no code with the package's model, which reads the
mechanisms from URDFs.
"""

from collections import Counter

import numpy as np

from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.program.mechanism import kinematics, point_jacobian
from quasistatic_ref.lab.program.step import loads
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.mechanisms import random_q, random_tree
from quasistatic_ref.lab.vectors.own.system import OwnSystem, own_system
from validation.tools.scripts import asked

GRAVITY = (1.0, -2.0, -9.81)
FORCE, TORQUE = (1.0, 2.0, 3.0), (4.0, 5.0, 6.0)
CALLS = 10
QUANTITIES = ("R, t", "J", "gravity", "wrench", "M_u")
WORDS = """Errors are the largest difference over the largest entry of a quantity. Each mechanism is
evaluated ten times by one `System`, at three configurations in turn; the first call and the tenth
are at the same one.
"""


def random_mechanism(rng: np.random.Generator) -> Json:
    """A tree or two; about half of the joints that can follow another one do."""
    bodies = []
    for tree in range(int(rng.integers(1, 3))):
        base = str(rng.choice(["fixed", "floating", "planar"]))
        own = random_tree(rng, int(rng.integers(2, 11)), base, masses=True)["bodies"]
        own[0]["actuated"] = base != "fixed" and bool(rng.integers(2))
        able = []
        for body in depth_first(own, own[0]):
            if body["joint"] in ("revolute", "prismatic"):
                if not able or rng.random() < 0.5:
                    able.append(body["name"])
                else:
                    body["mimic"] = random_mimic(rng, str(rng.choice(able)))
            bodies.append(body)
        for body in own:
            body["name"] += f"/{tree}"
            body["parent"] = body["parent"] and f"{body['parent']}/{tree}"
            if "mimic" in body:
                body["mimic"]["of"] += f"/{tree}"
    return {"bodies": bodies}


def depth_first(bodies: Json, root: Json) -> list[Json]:
    """A body and those below it, as URDF's reader visits them: a leader has to come first."""
    below = [body for body in bodies if body["parent"] == root["name"]]
    return [root, *(one for body in below for one in depth_first(bodies, body))]


def random_mimic(rng: np.random.Generator, leader: str) -> Json:
    """How a joint follows another one."""
    multiplier = float(rng.choice([-1, 1]) * rng.choice([1.0, rng.uniform(0.1, 2)]))
    return {"of": leader, "multiplier": multiplier, "offset": float(rng.uniform(-1, 1))}


def roots(mechanism: Json) -> list[Json]:
    """The bodies that move by a base."""
    return [body for body in mechanism["bodies"] if body["joint"] in ("floating", "planar")]


def centre(mechanism: Json, root: Json, at: Json) -> np.ndarray:
    """Centre of mass, in the world, of a root and of what fixed joints weld to it."""
    welded = [root]
    for body in mechanism["bodies"]:
        if body["joint"] == "fixed" and body["parent"] in [one["name"] for one in welded]:
            welded.append(body)
    masses = [body["mass"] for body in welded]
    return np.average([mass_centre(body, at) for body in welded], axis=0, weights=masses)


def mass_centre(body: Json, at: Json) -> np.ndarray:
    """Centre of mass of a body in the world."""
    R, t, _ = at[body["name"]]
    return R @ body["com"] + t


def expected(mechanism: Json, q: list[float]) -> list[np.ndarray]:
    """Each of QUANTITIES by the plain program."""
    at, bodies = kinematics(mechanism, np.array(q)), mechanism["bodies"]
    places = [np.column_stack(at[body["name"]][:2]) for body in bodies]
    J = [at[body["name"]][2] for body in bodies]
    M, _ = loads({"mechanism": mechanism, "gravity": GRAVITY, "wrenches": []}, at)
    gravity, pushed = np.zeros(len(M)), np.zeros(len(M))
    for body in bodies:
        v, _ = point_jacobian(at[body["name"]], mass_centre(body, at))
        gravity += body["mass"] * v.T @ GRAVITY
    for root in roots(mechanism):
        v, w = point_jacobian(at[root["name"]], centre(mechanism, root, at))
        pushed += v.T @ FORCE + w.T @ TORQUE
    return [np.array(places), np.array(J), gravity, pushed, M]


def found(mine: OwnSystem, mechanism: Json, q: list[float]) -> list[np.ndarray]:
    """The same, as the package has it; of M the un-actuated block alone."""
    own_q, v = mine.model_q(q), mine.v
    at = mine.system.kinematics(own_q)
    links = [mine.links[body["name"]] for body in mechanism["bodies"]]
    places = np.concatenate([at.R, at.t[:, :, None]], axis=2)[links]
    gravity, pushed = mine.system.gravity_force(own_q, GRAVITY), np.zeros(mine.system.n_v)
    for root in roots(mechanism):
        tree = mine.system.links[mine.links[root["name"]]].partition("/")[0]
        pushed += mine.system.centre_of_mass_force(own_q, tree, FORCE, TORQUE)
    n_a = mine.system.n_a
    M = np.zeros((len(v), len(v)))
    M[n_a:, n_a:] = mine.system.M_u(own_q)
    return [places, at.J[links][:, :, v], gravity[v], pushed[v], M[np.ix_(v, v)]]


def error(a: np.ndarray, b: np.ndarray) -> float:
    """Largest difference of two arrays, over the largest entry of the second."""
    return float(np.abs(a - b).max(initial=0.0) / (np.abs(b).max(initial=0.0) or 1.0))


def compare(seed: int) -> tuple[Counter[str], np.ndarray, bool]:
    """What a mechanism has, its errors (calls, quantities), whether its bits stay the same."""
    rng = np.random.default_rng(seed)
    mechanism = random_mechanism(rng)
    mine = own_system(mechanism)
    at = [random_q(rng, mechanism) for _ in range(3)]
    truth = [expected(mechanism, q) for q in at]
    for one in truth:
        one[-1][: mine.system.n_a] = one[-1][:, : mine.system.n_a] = 0.0
    answers = [found(mine, mechanism, at[call % 3]) for call in range(CALLS)]
    errors = np.array([
        [error(a, b) for a, b in zip(answers[call], truth[call % 3], strict=True)]
        for call in range(CALLS)
    ])  # fmt: skip
    same = all(np.array_equal(a, b) for a, b in zip(answers[0], answers[-1], strict=True))
    return features(mechanism), errors, same


def features(mechanism: Json) -> Counter[str]:
    """How many mimic joints there are, and of which kinds."""
    count, by_name = Counter[str](), {body["name"]: body for body in mechanism["bodies"]}
    for body in mechanism["bodies"]:
        if "mimic" not in body:
            continue
        above, parent = [], body["parent"]
        while parent is not None:
            above.append(by_name[parent])
            parent = by_name[parent]["parent"]
        leader = by_name[body["mimic"]["of"]]
        count["mimic joints"] += 1
        count["negative"] += body["mimic"]["multiplier"] < 0
        count["passive"] += not leader["actuated"]
        count["below another mimic joint"] += any("mimic" in one for one in above)
        count["below its leader"] += leader in above
        count["of another kind than its leader"] += body["joint"] != leader["joint"]
    return count


def report(count: int) -> str:
    """The committed result."""
    made = [compare(seed) for seed in range(count)]
    kinds = sum((own for own, _, _ in made), Counter[str]())
    with_mimic = sum(own["mimic joints"] > 0 for own, _, _ in made)
    worst = np.max([errors for _, errors, _ in made], axis=0)
    rows = [
        (name, *(f"{value:.0e}" for value in (one[0], one[-1], one.max())))
        for name, one in zip(QUANTITIES, worst.T, strict=True)
    ]
    return "\n".join([
        f"{count} random mechanisms, {with_mimic} of them with mimic joints.",
        "",
        WORDS,
        *markdown_table(("quantity", "first call", "tenth call", "any call"), rows),
        "",
        f"Equal bits at the first and the tenth call: {sum(same for *_, same in made)} of {count}.",
        "",
        "; ".join(f"{name}: {number}" for name, number in kinds.items()) + ".",
    ])  # fmt: skip


def main() -> None:
    """Print the result."""
    print(report(asked(__doc__, count=1000).count))


if __name__ == "__main__":
    main()
