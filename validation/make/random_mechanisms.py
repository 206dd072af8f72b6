"""M_u, gravity's force and J of random mechanisms with mimic joints, against a reference.

    python -m validation.make.random_mechanisms [--count COUNT]

The reference, tests/oracles/mechanisms.py, shares no code with the package.
"""

from __future__ import annotations

from collections import Counter

import numpy as np

from quasistatic_ref.model.system import Body, System
from tests.oracles.mechanisms import (
    GRAVITY,
    Mechanism,
    State,
    about,
    cross_matrix,
    dynamics,
    jacobians,
    of_quaternion,
    poses,
    random_mechanisms,
    root_centre,
    turned,
    urdf,
)
from validation.tools.scripts import asked

CALLS = 10
QUANTITIES = ("R, t", "J", "gravity", "wrench", "M_u")
WORDS = """Errors are the largest difference over the largest entry of a quantity. Each mechanism is
evaluated ten times by one `System`, at three configurations in turn; the first call and the tenth
are at the same one.
"""


def random_state(rng: np.random.Generator, mechanism: Mechanism, body: Body) -> State:
    """The pose that the body has in its scene if it is fixed, else a random one."""
    p, t = rng.normal(size=4), rng.uniform(-1, 1, 3)
    p /= np.linalg.norm(p)
    R = of_quaternion(p)
    if mechanism.base == "fixed":
        R, t = turned(np.array(body.rpy)), np.array(body.xyz)
    if mechanism.base == "planar":
        R, t[2] = about(np.eye(3)[2], rng.uniform(-3, 3)), body.xyz[2]
    return State(p, R, t, rng.uniform(-2, 2, len(mechanism.links)).tolist())


def configuration(system: System, mechanisms: list[Mechanism], states: list[State]) -> np.ndarray:
    """The q of these states."""
    q = np.full(system.n_q, np.nan)
    for joint in system.joints:
        name, short = joint.name.split("/")
        k = [mechanism.name for mechanism in mechanisms].index(name)
        R, t = states[k].R, states[k].t
        if joint.kind == "floating":
            q[joint.q] = [*t, *states[k].quaternion]
        elif joint.kind == "planar":
            q[joint.q] = [t[0], t[1], R[0, 0], R[1, 0]]
        else:
            position = states[k].positions[int(short[1:])]
            endless = joint.kind == "continuous"
            q[joint.q] = [np.cos(position), np.sin(position)] if endless else position
    return q


def expected(system: System, mechanisms: list[Mechanism], states: list[State]) -> list[np.ndarray]:
    """The reference of each of QUANTITIES, in the system's order of links and coordinates."""
    n = system.n_v
    at, all_J = [np.hstack([np.eye(3), np.zeros((3, 1))])], [np.zeros((1, 6, n))]
    M, force, pushed = np.zeros((n, n)), np.zeros(n), np.zeros(n)
    for mechanism, state in zip(mechanisms, states, strict=True):
        own = [
            k for k, c in enumerate(system.coordinates) if c.name.startswith(f"{mechanism.name}/")
        ]
        names = [system.coordinates[k].name.partition("/")[2] for k in own]
        J, placed = jacobians(mechanism, state, names), poses(mechanism, state, None)
        M[np.ix_(own, own)], force[own] = dynamics(mechanism, placed, J)
        if mechanism.base != "fixed":
            arm = placed[0][0] @ root_centre(mechanism)
            J_c = J[0, :3] - cross_matrix(arm) @ J[0, 3:]
            pushed[own] = J_c.T @ [1, 2, 3] + J[0, 3:].T @ [4, 5, 6]
        order = [
            int(link.partition("/")[2][1:])
            for link in system.links
            if link.startswith(f"{mechanism.name}/")
        ]
        at += [np.column_stack(placed[i]) for i in order]
        whole = np.zeros((len(order), 6, n))
        whole[:, :, own] = J[order]
        all_J.append(whole)
    return [np.array(at), np.concatenate(all_J), force, pushed, M[system.n_a :, system.n_a :]]


def found(system: System, mechanisms: list[Mechanism], q: np.ndarray) -> list[np.ndarray]:
    """The same, as the package has it."""
    kinematics = system.kinematics(q)
    at = np.concatenate([kinematics.R, kinematics.t[:, :, None]], axis=2)
    pushed = np.zeros(system.n_v)
    for mechanism in mechanisms:
        if mechanism.base != "fixed":
            pushed += system.centre_of_mass_force(q, mechanism.name, [1, 2, 3], [4, 5, 6])
    return [at, kinematics.J, system.gravity_force(q, GRAVITY), pushed, system.M_u(q)]


def error(a: np.ndarray, b: np.ndarray) -> float:
    """Largest difference of two arrays, over the largest entry of the second."""
    return float(np.abs(a - b).max(initial=0.0) / (np.abs(b).max(initial=0.0) or 1.0))


def compare(seed: int) -> tuple[Counter[str], np.ndarray, bool]:
    """What a mechanism has, its errors (calls, quantities), whether its bits stay the same."""
    rng = np.random.default_rng(seed)
    mechanisms = random_mechanisms(rng)
    bodies = []
    for m in mechanisms:
        own = [link.joint for link in m.links[1:] if link.actuated and link.kind != "fixed"]
        if m.base != "fixed" and m.base_actuated:
            own.append("base")
        pose = {"xyz": tuple(rng.uniform(-1, 1, 3)), "rpy": tuple(rng.uniform(-3, 3, 3))}
        if m.base == "planar":
            pose["rpy"] = (0.0, 0.0, pose["rpy"][2])
        bodies.append(Body(m.name, urdf(m), m.base, tuple(own), **pose))
    system = System(bodies)
    states = [
        [random_state(rng, *both) for both in zip(mechanisms, bodies, strict=True)]
        for _ in range(3)
    ]
    at = [configuration(system, mechanisms, one) for one in states]
    truth = [expected(system, mechanisms, one) for one in states]
    answers = [found(system, mechanisms, at[call % 3]) for call in range(CALLS)]
    errors = np.array([
        [error(a, b) for a, b in zip(answers[call], truth[call % 3], strict=True)]
        for call in range(CALLS)
    ])  # fmt: skip
    same = all(np.array_equal(a, b) for a, b in zip(answers[0], answers[-1], strict=True))
    return features(mechanisms), errors, same


def features(mechanisms: list[Mechanism]) -> Counter[str]:
    """How many mimic joints there are, and of which kinds."""
    count = Counter[str]()
    for mechanism in mechanisms:
        links = mechanism.links
        for link in links:
            if link.leader is None:
                continue
            above, parent = [], link.parent
            while parent > 0:
                above.append(parent)
                parent = links[parent].parent
            count["mimic joints"] += 1
            count["negative"] += link.multiplier < 0
            count["passive"] += not links[link.leader].actuated
            count["below another mimic joint"] += any(links[k].leader is not None for k in above)
            count["below its leader"] += link.leader in above
            count["of another kind than its leader"] += link.kind != links[link.leader].kind
    return count


def report(count: int) -> str:
    """The committed result."""
    kinds, errors, same, with_mimic = Counter[str](), [], 0, 0
    for seed in range(count):
        own, off, equal = compare(seed)
        kinds += own
        errors.append(off)
        same += equal
        with_mimic += own["mimic joints"] > 0
    worst = np.array(errors)
    lines = [
        f"{count} random mechanisms, {with_mimic} of them with mimic joints.",
        "",
    ]
    lines += [WORDS, "| quantity | first call | tenth call | any call |", "|---|---|---|---|"]
    for k, name in enumerate(QUANTITIES):
        one = worst[:, :, k]
        lines.append(
            f"| {name} | {one[:, 0].max():.0e} | {one[:, -1].max():.0e} | {one.max():.0e} |"
        )
    lines += ["", f"Equal bits at the first and the tenth call: {same} of {count}.", ""]
    lines += ["; ".join(f"{name}: {number}" for name, number in kinds.items()) + "."]
    return "\n".join(lines)


def main() -> None:
    """Print the result."""
    print(report(asked(__doc__, count=1000).count))


if __name__ == "__main__":
    main()
