"""Ways to make a simulator that works wrong.

The simulator is the NumPy runner, which shares no code with the package; the bugs are in its
inputs, its functions or its outputs, written without a look at how mistakes are recognised.
"""

import copy
import functools

import numpy as np

from tests.lab.vectors.material import runner, runner_answers


def each_contact(case, **changes):
    """A case with numbers of every contact, or of every pair of a step, changed."""
    case = copy.deepcopy(case)
    for contact in case["contacts"] if "contacts" in case else case["pairs"]:
        for name, change in changes.items():
            contact[name] = change(contact)
    return case


@functools.cache
def right_answers_of_runner(layer):
    return runner_answers(layer)


def outputs_changed(change):
    """A fault in what the runner writes."""

    def answers(layer, monkeypatch):
        return {
            name: change(copy.deepcopy(v)) for name, v in right_answers_of_runner(layer).items()
        }

    return answers


def inputs_changed(change):
    """A fault in how the runner reads a case."""
    return lambda layer, monkeypatch: runner_answers(layer, change)


def patched(module, name, replacement):
    """A fault in one function of the runner; `replacement` receives the one that is right."""

    def answers(layer, monkeypatch):
        right = getattr(runner(module), name)
        for place in ("numpy_runner", "runner_mechanism", "runner_distance", "runner_qp"):
            if hasattr(runner(place), name):
                monkeypatch.setattr(runner(place), name, replacement(right))
        return runner_answers(layer)

    return answers


def negative(*names):
    """A fault of sign in these fields of the outputs."""

    def change(output):
        return {
            name: (-np.array(v)).tolist() if name in names and not isinstance(v, dict) else v
            for name, v in output.items()
        }

    return outputs_changed(change)


def multiplied(factor, *names):
    """A fault of scale in these fields of the outputs."""

    def change(output):
        return {
            name: (factor * np.array(v)).tolist() if name in names else v
            for name, v in output.items()
        }

    return outputs_changed(change)


def world_twists(right):
    """Kinematics whose floating bases move along the world's axes."""

    def kinematics(mechanism, q):
        found = right(mechanism, q)
        at, _, _ = runner("runner_mechanism").slices(mechanism)
        for body in mechanism["bodies"]:
            if body["joint"] == "floating":
                columns, R = at[body["name"]][1], found[body["name"]][0]
                for _, _, J in found.values():
                    J[:, columns] = J[:, columns] @ np.kron(np.eye(2), R.T)
        return found

    return kinematics


def world_moves(right):
    """(+) that takes a floating base's delta_q along the world's axes."""

    def moved(body, q, d):
        if body["joint"] == "floating":
            R = runner("runner_mechanism").rotation(q[3:])
            d = np.concatenate([R.T @ d[:3], R.T @ d[3:]])
        return right(body, q, d)

    return moved


def straight_moves(right):
    """(+) that moves a floating base by R v instead of along a screw."""

    def moved(body, q, d):
        found = right(body, q, d)
        if body["joint"] == "floating":
            found[:3] = q[:3] + runner("runner_mechanism").rotation(q[3:]) @ d[:3]
        return found

    return moved


def interleaved(right):
    """Rows in the order +d1 -d1 +d2 -d2 +spin -spin."""

    def cone_table(cone, rows):
        table = right(cone, rows)
        return table[[0, 2, 1, 3, 4, 5][: len(table)]] if cone == "pyramid" else table

    return cone_table


def wrong_order(right):
    """A rotation that takes its quaternion for [w, x, y, z]."""
    return lambda quaternion: right([*quaternion[1:], quaternion[0]])


def torsion_forgotten(output):
    """Wrenches without a torque about n."""
    return {"wrench": [[*w[:3], 0.0] for w in output["wrench"]], "net": output["net"]}


def unsigned_contacts(output):
    """Contacts with |phi|."""
    contacts = [{**c, "phi": abs(c["phi"])} for c in output["contacts"]]
    return {**output, "contacts": contacts}


def mu_omega_times_mu_v(case):
    return each_contact(case, mu_omega=lambda k: k["mu_omega"] * k["mu_v"])


def normals_reversed(case):
    return each_contact(case, n=lambda k: [-x for x in k["n"]])


def jacobians_read_by_columns(case):
    def by_columns(contact):
        rows, columns = np.shape(contact["J"])
        return np.reshape(contact["J"], (columns, rows)).T.tolist()

    return each_contact(case, J=by_columns)
