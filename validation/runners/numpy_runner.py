"""Every layer of the reference vectors in plain NumPy, from their README alone.

Usage: python numpy_runner.py VECTORS ANSWERS [LAYER ...]; without arguments it answers a challenge,
line by line. Shares no code with quasistatic_ref.
Beside it: runner_mechanism.py (coordinates), runner_distance.py and runner_qp.py.
"""

import json
import sys
from pathlib import Path

import numpy as np
from runner_distance import closest_points
from runner_mechanism import difference, kinematics, moved, point_jacobian, rotation, slices
from runner_qp import conic_answer, qp_answer

LAYERS = ("distance", "selection", "jacobian", "rows", "qp", "wrench", "integrate", "step")


def jacobian(case):
    """Layer 3."""
    at = kinematics(case["mechanism"], np.array(case["q"]))
    found = []
    for contact in case["contacts"]:
        v_beta, w_beta = point_jacobian(at[contact["beta_body"]], contact["beta"])
        v_alpha, w_alpha = point_jacobian(at[contact["alpha_body"]], contact["alpha"])
        found.append(np.vstack([v_beta - v_alpha, np.array(contact["n"]) @ (w_beta - w_alpha)]))
    return {"J": found}


def selection(case):
    """Layer 2: a stable sort is a tie broken by index; of two solids those about one normal."""
    found = []
    for g, phi in enumerate(case["phi"]):
        order = np.argsort(phi, kind="stable")
        if "normals" in case:
            n = np.array(case["normals"][g])
            order = order[n[order] @ n[-1] >= np.cos(0.25)]
        filling = range(len(phi), 2 * len(phi) - len(order))
        found.append([*order.tolist(), *filling][: case["k"]])
    return {"indices": found}


def cone_table(cone, rows):
    """T of each row of a contact, in units of (mu_v, mu_v, mu_omega)."""
    sides = [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]
    spins = [[0, 0, 1], [0, 0, -1]]
    if cone == "frictionless":
        return np.zeros((1, 3))
    if cone == "product":
        both = [[a, b, s if rows == 6 else 0] for s in (1, -1) for a, b, _ in sides]
        return np.array(both if rows == 6 else both[:4], dtype=float)
    if cone != "pyramid":
        K = int(cone.split("-")[1])
        angles = 2 * np.pi * np.arange(K) / K
        sides = [[np.cos(a), np.sin(a), 0] for a in angles]
    return np.array(sides + (spins if rows == 6 else []), dtype=float)


def rows(case):
    """Layer 4."""
    A, b = [], []
    for c in case["contacts"]:
        T = cone_table(case["cone"], c["rows"])
        linear = np.array(c["n"]) + c["mu_v"] * T[:, :2] @ np.array([c["d1"], c["d2"]])
        J = np.array(c["J"], dtype=float)
        A.extend(np.column_stack([linear, c["mu_omega"] * T[:, 2]]) @ J)
        b.extend([-c["phi"]] * len(T))
    return {"A": A, "b": b}


def qp(case):
    """Layer 5."""
    H, g = np.array(case["H"]), np.array(case["g"])
    if "second_order" in case:
        return conic_answer(
            H, g, [(np.array(c["F"]), np.array(c["f"])) for c in case["second_order"]]
        )
    return qp_answer(H, g, np.array(case["A"]).reshape(-1, len(g)), np.array(case["b"]))


def wrench(case):
    """Layer 6."""
    wrenches, net = [], {name: np.zeros(6) for name in case["bodies"]}
    for c in case["contacts"]:
        lam = np.array(c["lam"]) / case["h"]
        if case["cone"] == "ellipsoid":
            f_n, f1, f2, tau = lam
        else:
            mu = np.array([c["mu_v"], c["mu_v"], c["mu_omega"]])
            f1, f2, tau = mu * (lam @ cone_table(case["cone"], c["rows"]))
            f_n = lam.sum()
        wrenches.append([f1, f2, f_n, tau])
        n = np.array(c["n"])
        force = f1 * np.array(c["d1"]) + f2 * np.array(c["d2"]) + f_n * n
        for side, sign in (("beta", 1), ("alpha", -1)):
            body = c[f"{side}_body"]
            if body in net:
                arm = np.array(c[side]) - case["bodies"][body]["point"]
                net[body] += sign * np.concatenate([force, np.cross(arm, force) + tau * n])
    return {"wrench": wrenches, "net": net}


def integrate(case):
    """Layer 7."""
    at, _, _ = slices(case["mechanism"])
    q, delta_q = np.array(case["q"]), np.array(case["delta_q"])
    for body in case["mechanism"]["bodies"]:
        i, k = at.get(body["name"], (slice(0, 0), slice(0, 0)))
        if i.stop > i.start:
            q[i] = moved(body, q[i], delta_q[k])
    return {"q": q}


def tangents(n):
    """d1, d2 of a normal."""
    i = int(np.argmin(np.abs(n)))
    d1 = np.eye(3)[i] - n[i] * n
    d1 /= np.linalg.norm(d1)
    return d1, np.cross(n, d1)


def corners(shape):
    """The corners of a box, the sign of x changing first; other solids have none here."""
    if shape["kind"] != "box":
        return []
    signs = 2 * ((np.arange(8)[:, None] >> np.arange(3)) & 1) - 1
    return signs * np.array(shape["size"]) / 2


def candidates(alpha, pose_alpha, beta, pose_beta, k):
    """phi, alpha, beta, n of all candidates, and which come after all others."""
    clouds = "cloud" in (alpha["kind"], beta["kind"])
    parts = []
    if k > 1 and not clouds:
        for shape, swap in ((alpha, True), (beta, False)):
            points = {"kind": "cloud", "points": corners(shape)}
            if len(points["points"]):
                pair = (points, pose_alpha, beta, pose_beta)
                parts.append(pair if swap else (alpha, pose_alpha, points, pose_beta))
    parts.append((alpha, pose_alpha, beta, pose_beta))
    found = [closest_points(*part) for part in parts]
    phi = np.concatenate([np.atleast_1d(one[0]) for one in found])
    a, b, n = (np.concatenate([np.reshape(one[i], (-1, 3)) for one in found]) for i in (1, 2, 3))
    every = np.column_stack([phi, a, n])
    late = np.zeros(len(phi), dtype=bool)
    if k > 1 and not clouds:
        near = np.abs(every[:, None] - every).max(axis=2) <= 1e-9
        late = np.tril(near, -1).any(axis=1)
        late[-1] |= np.sum(~late[:-1] & (phi[:-1] <= phi[-1] + 1e-9)) >= k
    return phi, a, b, n, late


def step_contacts(case, at):
    """The contacts of a step, pair by pair, without J."""
    found = []
    for pair in case["pairs"]:
        alpha, beta = case["shapes"][pair["alpha"]], case["shapes"][pair["beta"]]
        placed = []
        for shape in (alpha, beta):
            R, t, _ = at[shape["body"]]
            pose = shape["pose"]
            placed.append((R @ rotation(pose["quaternion"]), R @ pose["xyz"] + t))
        k = pair["k"]
        phi, a, b, n, late = candidates(alpha["shape"], placed[0], beta["shape"], placed[1], k)
        for i in np.sort(np.lexsort((np.arange(len(phi)), phi, late))[:k]):
            d1, d2 = tangents(n[i])
            geometry = {"phi": phi[i], "alpha": a[i], "beta": b[i], "n": n[i], "d1": d1, "d2": d2}
            bodies = {"alpha_body": alpha["body"], "beta_body": beta["body"]}
            friction = {key: pair[key] for key in ("mu_v", "mu_omega", "rows")}
            found.append({"pair": pair["name"], "index": int(i), **geometry, **bodies, **friction})
    return found


def masses(case, at, n_a, n_v):
    """M, and tau of gravity (un-actuated only) and of the wrenches."""
    M, tau = np.zeros((n_v, n_v)), np.zeros(n_v)
    centre = {}
    for body in case["mechanism"]["bodies"]:
        R, t, _ = at[body["name"]]
        mass = body.get("mass", 0.0)
        centre[body["name"]] = R @ body.get("com", np.zeros(3)) + t
        v, w = point_jacobian(at[body["name"]], centre[body["name"]])
        M += mass * v.T @ v + w.T @ R @ body.get("inertia", np.zeros((3, 3))) @ R.T @ w
        tau += mass * v.T @ case["gravity"]
    tau[:n_a] = 0
    for given in case.get("wrenches", []):
        v, w = point_jacobian(at[given["body"]], centre[given["body"]])
        tau += v.T @ given["force"] + w.T @ given["torque"]
    return M, tau


def step(case):
    """Layer 8: all of it."""
    mechanism, q, h = case["mechanism"], np.array(case["q"]), case["h"]
    at = kinematics(mechanism, q)
    places, n_a, n_v = slices(mechanism)
    contacts = step_contacts(case, at)
    J = jacobian({"mechanism": mechanism, "q": q, "contacts": contacts})["J"]
    for contact, block in zip(contacts, J, strict=True):
        contact["J"] = block
    M, tau = masses(case, at, n_a, n_v)
    delta_q_bar_a = np.zeros(n_a)
    for body in mechanism["bodies"]:
        i, k = places.get(body["name"], (slice(0, 0), slice(0, 0)))
        if body.get("actuated") and k.stop > k.start:
            delta_q_bar_a[k] = difference(body, np.array(case["q_bar_a"])[i], q[i])
    K_q = np.array(case["K_q"]).reshape(n_a, n_a)
    H, g = np.zeros((n_v, n_v)), h * tau
    H[:n_a, :n_a], H[n_a:, n_a:] = h * K_q, M[n_a:, n_a:] / h
    g[:n_a] += h * (K_q @ delta_q_bar_a)
    AB = rows({"cone": case["cone"], "contacts": contacts})
    A, b = np.array(AB["A"]).reshape(-1, n_v), np.array(AB["b"])
    found = qp_answer(H, g, A, b)
    keys = ("pair", "index", "phi", "alpha", "beta", "n", "d1", "d2", "J")
    shown = [{key: contact[key] for key in keys} for contact in contacts]
    output = {"contacts": shown, "H": H, "g": g, "A": A, "b": b}
    if "farkas" in found:
        return {**output, **found}
    counts = [len(cone_table(case["cone"], c["rows"])) for c in contacts]
    lam = np.split(found["lam"], np.cumsum(counts)[:-1]) if counts else []
    loaded = [{**c, "lam": part} for c, part in zip(contacts, lam, strict=True)]
    wrenches = wrench({"h": h, "cone": case["cone"], "contacts": loaded, "bodies": {}})["wrench"]
    q_next = integrate({"mechanism": mechanism, "q": q, "delta_q": found["delta_q"]})["q"]
    solved = {key: found[key] for key in ("delta_q", "lam", "A_lam")}
    return {**output, **solved, "wrench": wrenches, "q_next": q_next}


def distance(case):
    """Layer 1."""
    poses = [
        (rotation(p["quaternion"]), np.array(p["xyz"]))
        for p in (case["pose_alpha"], case["pose_beta"])
    ]
    found = closest_points(case["alpha"], poses[0], case["beta"], poses[1])
    return dict(zip(("phi", "alpha", "beta", "n"), found, strict=True))


def plain(value):
    """Arrays as lists."""
    if isinstance(value, dict):
        return {key: plain(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def whole(value, shapes):
    """A case with the shapes that its file keeps in a table."""
    if isinstance(value, dict):
        if value.get("kind") == "shared":
            return shapes[value["name"]]
        return {key: whole(v, shapes) for key, v in value.items()}
    return [whole(v, shapes) for v in value] if isinstance(value, list) else value


def answers(layer, inputs):
    """The content of answers/LAYER.json."""
    solve, shapes = globals()[layer], inputs.get("shapes", {})
    found = [
        {"id": case["id"], "output": plain(solve(whole(case["input"], shapes)))}
        for case in inputs["cases"]
    ]
    return {"format": "quasistatic-ref/vectors-answers", "version": 1, "layer": layer,
            "implementation": "numpy_runner", "answers": found}  # fmt: skip


def challenged():
    """Answer the cases of a challenge: one a line in, one a line out."""
    print(
        json.dumps({"protocol": 1, "implementation": "numpy_runner", "layers": LAYERS}), flush=True
    )
    for text in sys.stdin:
        case = json.loads(text)
        try:
            answer = {"output": plain(globals()[case["layer"]](case["input"]))}
        except (ArithmeticError, LookupError, TypeError, ValueError) as error:
            answer = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps({"id": case["id"], **answer}), flush=True)


def main(vectors, out, *layers):
    """Answer every layer that has inputs."""
    Path(out).mkdir(parents=True, exist_ok=True)
    for layer in layers or LAYERS:
        path = Path(vectors, "inputs", f"{layer}.json")
        if path.exists():
            text = json.dumps(answers(layer, json.loads(path.read_text())))
            Path(out, f"{layer}.json").write_text(text + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:]) if sys.argv[1:] else challenged()
