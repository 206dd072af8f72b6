"""Layer 8: a whole step."""

import numpy as np

from .candidates import candidates, gaps, k_first, smaller, tangents
from .forces import forces
from .integration import integrate, way
from .mechanism import jacobian, kinematics, point_jacobian, slices
from .optimum import optimum, qp_answer
from .rotation import AXES, NONE, frame
from .rows import cone_table, rows
from .wrench import wrench

SHOWN = ("pair", "index", "phi", "alpha", "beta", "n", "d1", "d2", "J")
"""What the answer says of a contact."""


def pose_in_world(shape, at):
    """(R, t) of a shape in the world."""
    R, t, _ = at[shape["body"]]
    R_shape, t_shape = frame(shape["pose"])
    return R @ R_shape, R @ t_shape + t


def sides_of(case, pair, at):
    """The two shapes of a pair, each with its pose in the world."""
    entries = {side: case["shapes"][pair[side]] for side in ("alpha", "beta")}
    return {side: (one["shape"], pose_in_world(one, at)) for side, one in entries.items()}


def entry_of(case, pair):
    """The fields of a contact that all contacts of a pair share."""
    entry = {"pair": pair["name"]}
    entry |= {f"{side}_body": case["shapes"][pair[side]]["body"] for side in ("alpha", "beta")}
    return entry | {k: pair[k] for k in ("mu_v", "mu_omega", "rows", "compliance") if k in pair}


def contacts_of(case, at):
    """The contacts, pair by pair, without J.

    Raises
    ------
    ValueError
        If a pair of a mesh asks for several contacts.
    """
    contacts = []
    for pair in case["pairs"]:
        k = pair["k"]
        alpha, beta = sides_of(case, pair, at).values()
        kinds = {alpha[0]["kind"], beta[0]["kind"]}
        if k > 1 and "convex" in kinds and "cloud" not in kinds:
            raise ValueError("outlines of a mesh's faces are not known here: ask for k = 1")
        phi, a, b, n, index, late = candidates(*alpha, *beta, k)
        rank = gaps(phi, smaller(alpha[0], beta[0]))
        for i in k_first(rank, index, late, k):
            d1, d2 = tangents(n[i])
            contact = {"index": int(index[i])}
            contact |= {"phi": phi[i], "alpha": a[i], "beta": b[i], "n": n[i], "d1": d1, "d2": d2}
            contacts.append({**entry_of(case, pair), **contact})
    return contacts


def loads(case, at):
    """M, and tau of gravity (un-actuated only) and of the wrenches."""
    _, n_a, n_v = slices(case["mechanism"])
    M = np.zeros((n_v, n_v))
    weight = np.zeros(n_v)
    centre = {}
    for body in case["mechanism"]["bodies"]:
        R, t, _ = at[body["name"]]
        mass = body.get("mass", 0)
        centre[body["name"]] = R @ np.array(body.get("com", NONE)) + t
        inertia = R @ np.array(body.get("inertia", 0 * AXES)) @ R.T
        v, w = point_jacobian(at[body["name"]], centre[body["name"]])
        M = M + mass * v.T @ v + w.T @ inertia @ w
        weight = weight + mass * v.T @ np.array(case["gravity"])
    tau = np.append(np.zeros(n_a), weight[n_a:])
    for load in case.get("wrenches", []):
        point = centre[load["body"]]
        v, w = point_jacobian(at[load["body"]], point)
        tau = tau + v.T @ np.array(load["force"]) + w.T @ np.array(load["torque"])
    return M, tau


def objective(case, M, tau):
    """H and g; a case may have a further generalised force, ``tau``."""
    h = case["h"]
    n_a = len(case["K_q"])
    K_q = np.array(case["K_q"]).reshape(n_a, n_a)
    delta_q_bar_a = way(case["mechanism"], case["q"], case["q_bar_a"])
    tau_k = K_q @ delta_q_bar_a
    g = h * tau
    if "tau" in case:
        g = g + h * case["tau"]
    g[:n_a] += h * tau_k
    H = np.zeros(M.shape)
    H[:n_a, :n_a] = h * K_q
    H[n_a:, n_a:] = M[n_a:, n_a:] / h
    return H, g


def step(case):
    """Layer 8: a whole step, from poses and loads to the next q."""
    at = kinematics(case["mechanism"], np.array(case["q"]))
    return step_at(case, at, contacts_of(case, at))


def step_at(case, at, contacts, method=optimum):
    """The step of these bodies with these contacts, solved by the optimum or another method."""
    mechanism = case["mechanism"]
    h = case["h"]
    cone = case["cone"]
    blocks = jacobian({"mechanism": mechanism, "q": case["q"], "contacts": contacts})["J"]
    for contact, J in zip(contacts, blocks, strict=True):
        contact["J"] = J
    H, g = objective(case, *loads(case, at))
    A_b = rows({"cone": cone, "contacts": contacts})
    A = np.array(A_b["A"]).reshape(-1, len(g))
    b = np.array(A_b["b"])
    shown = [{key: contact[key] for key in SHOWN} for contact in contacts]
    output = {"contacts": shown, "H": H, "g": g, "A": A, "b": b}
    answer = qp_answer(H, g, A, b, method)
    if "farkas" in answer:
        return {**output, **answer}
    delta_q = answer["delta_q"]
    lam = answer["lam"]
    A_lam = answer["A_lam"]
    counts = [len(cone_table(cone, c["rows"])) for c in contacts]
    shares = np.split(lam, np.cumsum(counts)[:-1]) if counts else []
    loaded = [{**contact, "lam": part} for contact, part in zip(contacts, shares, strict=True)]
    wrenches = wrench({"h": h, "cone": cone, "contacts": loaded, "bodies": {}})["wrench"]
    q_next = integrate({"mechanism": mechanism, "q": case["q"], "delta_q": delta_q})["q"]
    output |= {"delta_q": delta_q, "lam": lam, "A_lam": A_lam}
    output |= {"wrench": wrenches, "forces": forces(H, g, A, b, contacts, cone, h, method)}
    return {**output, "q_next": q_next}
