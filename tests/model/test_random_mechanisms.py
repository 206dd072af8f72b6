"""Random mechanisms with mimic joints, against the plain program, which shares no code with System.

One System answers ten times: pinocchio's ``crba`` is another at each call where joints mimic.
"""

import numpy as np

from quasistatic_ref.lab.program.mechanism import kinematics, point_jacobian, slices
from quasistatic_ref.lab.program.step import loads
from quasistatic_ref.lab.vectors.challenge.random_mechanisms import random_q, random_tree
from quasistatic_ref.lab.vectors.own.system import own_system
from tests.closeness import assert_within
from tests.tolerances import ROUNDING

MECHANISMS, CALLS = 12, 10
GRAVITY = np.array([1.0, -2.0, -9.81])
FORCE = np.array([1.0, 2.0, 3.0])
TORQUE = np.array([4.0, 5.0, 6.0])


def depth_first(bodies, at):
    """The bodies at and below one of them, as URDF's reader visits them."""
    yield at
    for body in bodies:
        if body["parent"] == at["name"]:
            yield from depth_first(bodies, body)


def random_mechanism(rng):
    """A tree in which half of the joints follow another one; a leader is read before them."""
    bodies = random_tree(rng, 10, str(rng.choice(["floating", "planar"])), masses=True)["bodies"]
    leaders = []
    for body in depth_first(bodies, bodies[0]):
        if body["joint"] not in ("revolute", "prismatic"):
            continue
        if not leaders or rng.random() < 0.5:
            leaders.append(body["name"])
            continue
        follow = {"of": str(rng.choice(leaders)), "multiplier": rng.uniform(-2, 2)}
        body |= {"actuated": False, "mimic": follow | {"offset": rng.uniform(-1, 1)}}
    return {"bodies": bodies}


def root_centre(bodies, at):
    """Centre of mass of the root and of the bodies that are welded to it."""
    welded = [bodies[0]]
    for body in bodies[1:]:
        if body["joint"] == "fixed" and body["parent"] in [one["name"] for one in welded]:
            welded.append(body)
    centres = [at[body["name"]][0] @ body["com"] + at[body["name"]][1] for body in welded]
    return np.average(centres, axis=0, weights=[body["mass"] for body in welded])


def program_numbers(mechanism, q):
    """Poses, J, the forces of gravity and of a wrench on the root, and M_u, by the program."""
    bodies = mechanism["bodies"]
    at = kinematics(mechanism, np.array(q))
    poses = [np.column_stack(at[body["name"]][:2]) for body in bodies]
    J = [at[body["name"]][2] for body in bodies]
    M, weight = loads({"mechanism": mechanism, "gravity": GRAVITY}, at)
    v, w = point_jacobian(at[bodies[0]["name"]], root_centre(bodies, at))
    n_a = slices(mechanism)[1]
    return poses, J, weight[n_a:], v.T @ FORCE + w.T @ TORQUE, M[n_a:, n_a:]


def package_numbers(own, mechanism, q):
    """The same by the package, in the mechanism's order of bodies and coordinates."""
    system = own.system
    at = system.kinematics(q)
    links = [own.links[body["name"]] for body in mechanism["bodies"]]
    poses = np.concatenate([at.R, at.t[:, :, None]], axis=2)[links]
    body = system.links[links[0]].partition("/")[0]
    pushed = system.load(q, body, FORCE, TORQUE)[own.v]
    free = own.v[system.n_a :]
    M_u = system.M_u(q)[np.ix_(free - system.n_a, free - system.n_a)]
    return poses, at.J[links][:, :, own.v], system.gravity_force(q, GRAVITY)[free], pushed, M_u


def test_random_mechanisms_move_and_weigh_as_their_links_do():
    followers = 0
    for seed in range(MECHANISMS):
        rng = np.random.default_rng(seed)
        mechanism = random_mechanism(rng)
        followers += sum("mimic" in body for body in mechanism["bodies"])
        own = own_system(mechanism)
        q = [random_q(rng, mechanism) for _ in range(3)]
        answers = [
            package_numbers(own, mechanism, own.model_q(q[call % 3])) for call in range(CALLS)
        ]
        for place, answer in zip(q, answers, strict=False):
            for a, b in zip(answer, program_numbers(mechanism, place), strict=True):
                size = np.abs(b).max(initial=0.0)
                assert_within(a, b, ROUNDING * size)
        for call, answer in enumerate(answers):
            assert all(map(np.array_equal, answer, answers[call % 3]))
    assert followers > 2 * MECHANISMS
