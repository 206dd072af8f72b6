"""Layer `step`: everything at once, composed layer by layer.

Each layer's correctly rounded answer is the next one's input: poses of the shapes, closest points,
those that are kept, tangents, J, rows, the quadratic program, wrenches, the next configuration.
Contacts of a pair stand in the order of their index. Gravity acts on the un-actuated coordinates:
that of the others is compensated.
"""

from fractions import Fraction
from typing import Any

import numpy as np

from quasistatic_ref.lab.program import step as program
from quasistatic_ref.lab.program.candidates import tangents
from quasistatic_ref.lab.program.mechanism import kinematics
from quasistatic_ref.lab.program.rotation import quaternion_of
from quasistatic_ref.lab.vectors.distances.candidates import FIELDS, Chosen, chosen_points
from quasistatic_ref.lab.vectors.exact.compliant import compliant_forces, forces_bound
from quasistatic_ref.lab.vectors.exact.conditioning import Errors
from quasistatic_ref.lab.vectors.exact.entered import exact, exact_case
from quasistatic_ref.lab.vectors.exact.precision import Real, rounded_results, short
from quasistatic_ref.lab.vectors.exact.rational import tolerance
from quasistatic_ref.lab.vectors.exact.terms import terms
from quasistatic_ref.lab.vectors.expected import Expected, Json, Tolerance
from quasistatic_ref.lab.vectors.layers import layer, qp
from quasistatic_ref.lab.vectors.layers.rows import by_contact

EPS = 2.0**-52
SHOWN = ("pair", "index", *FIELDS, "d1", "d2", "J")
"""What the answer says of a contact."""
ANSWERED = ("delta_q", "lam", "A_lam")
LOOSEST = 5e-6
"""Of the largest force, or of 1 N: a bound that is larger would tell nothing."""
ROUNDINGS = 16
"""Units of rounding of a mass, a force or a pose: some products of rotations, deep chains."""


def expected(case_input: Json) -> Expected:
    """All that one step comes to, and q after it."""
    contacts, by_pair = contacts_of(case_input)
    contacts, jacobian, rows = with_rows(case_input, contacts)
    H, g = objective(case_input)
    H_size, g_size = terms(case_input)
    H_size = max([H_size, *(abs(x) for row in H for x in row)])
    qp_case = {"H": H, "g": g, "A": rows.output["A"], "b": rows.output["b"]}
    errors, bounds = _errors(case_input, qp_case, by_pair, jacobian, rows, (H_size, g_size))
    solved = qp.expected(qp_case, errors)
    output, wrenches, after = step_output(case_input, contacts, qp_case, solved)
    base_tolerance = {
        **{f"contacts.{name}": t for name, t in bounds.items()},
        "H": tolerance(errors.H, f"{ROUNDINGS} units of rounding of the largest term"),
        "g": tolerance(errors.g, f"{ROUNDINGS} units of rounding of the largest term"),
        "A": tolerance(errors.A, "that of the layer rows, and of J and the normals"),
        "b": tolerance(errors.b, "that of phi"),
    }  # fmt: skip
    ties = {"tie": not all(one.clear for one in by_pair)}
    ties["unique"] = all(one.unique for one in by_pair)
    flags = {**solved.flags, **ties}
    if wrenches is None or after is None:
        return Expected(output, flags=flags, tolerance={**base_tolerance, **solved.tolerance})
    wrench_bound = _wrench_bound(case_input, solved, wrenches)
    program = qp.matrices(qp_case)
    output["forces"], digits = compliant_forces(program, case_input, contacts, output["lam"])
    largest = max([1.0, *(abs(f) for row in output["forces"] for f in row)])
    forces_off = forces_bound(program, case_input, contacts, output["delta_q"], errors)
    forces_off = min(forces_off, LOOSEST * largest)
    q_bound = _plus(after.tolerance["q"], 4 * solved.tolerance["delta_q"].absolute)
    return Expected(
        output,
        {**solved.digits, **short({"forces": digits})},
        flags,
        tolerance={
            **base_tolerance,
            **{name: solved.tolerance[name] for name in ANSWERED},
            "wrench": tolerance(wrench_bound, "that of lam, over h"),
            "forces": tolerance(forces_off, "that of gaps and slips, over the compliance"),
            "q_next": tolerance(q_bound, "that of delta_q, and of the layer integrate"),
        },
    )


def with_rows(case: Json, contacts: list[Json]) -> tuple[list[Json], Expected, Expected]:
    """Contacts with their J, and what the layers `jacobian` and `rows` say of them."""
    place = {key: case[key] for key in ("mechanism", "q")}
    jacobian = layer("jacobian").expected({**place, "contacts": contacts})
    blocks = jacobian.output["J"]
    whole = [{**contact, "J": J} for contact, J in zip(contacts, blocks, strict=True)]
    return whole, jacobian, layer("rows").expected({"cone": case["cone"], "contacts": whole})


def step_output(
    case: Json, contacts: list[Json], qp_case: Json, solved: Expected
) -> tuple[dict[str, Json], Expected | None, Expected | None]:
    """The output of a step whose case of layer `qp` is solved, by layers wrench and integrate."""
    output = {**qp_case, "contacts": [{key: c[key] for key in SHOWN} for c in contacts]}
    if "farkas" in solved.output:
        return {**output, "farkas": solved.output["farkas"]}, None, None
    parts = by_contact(solved.output["lam"], case["cone"], contacts)
    loaded = [{**contact, "lam": lam} for contact, lam in zip(contacts, parts, strict=True)]
    loads = {"h": case["h"], "cone": case["cone"], "contacts": loaded, "bodies": {}}
    wrenches = layer("wrench").expected(loads)
    moved = {key: case[key] for key in ("mechanism", "q")} | {"delta_q": solved.output["delta_q"]}
    after = layer("integrate").expected(moved)
    output |= {name: solved.output[name] for name in ANSWERED}
    output |= {"wrench": wrenches.output["wrench"], "q_next": after.output["q"]}
    return output, wrenches, after


def own(case_input: Json) -> Json:
    """The package's answer, through its own System, pairs and simulator."""
    from quasistatic_ref.lab.vectors.own.step import own_step

    return own_step(case_input)


def _contacts_by_pair(case: Json) -> list[Chosen]:
    """The contacts of each pair."""
    names = {pair[side] for pair in case["pairs"] for side in ("alpha", "beta")}
    places = {name: shape_pose(case, case["shapes"][name]) for name in sorted(names)}
    by_pair = []
    for pair in case["pairs"]:
        alpha, beta = (case["shapes"][pair[side]]["shape"] for side in ("alpha", "beta"))
        by_pair.append(
            chosen_points(alpha, beta, places[pair["alpha"]], places[pair["beta"]], pair["k"])
        )
    return by_pair


def shape_pose(case: Json, entry: Json) -> Json:
    """Pose of a shape in the world, rounded; one that is fixed there as it is given.

    Parameters
    ----------
    case : dict
        Of which ``mechanism`` and ``q`` are read.
    entry : dict
        ``body`` and ``pose`` of the shape.
    """
    if entry["body"] is None:
        return entry["pose"]
    entry = {key: entry[key] for key in ("body", "pose")}
    place = {"mechanism": case["mechanism"], "q": case["q"], "shapes": {"it": entry}}
    place = exact_case(place)

    def world() -> Any:
        at = kinematics(place["mechanism"], np.array(place["q"]))
        R, t = program.pose_in_world(place["shapes"]["it"], at)
        return {"xyz": t, "quaternion": quaternion_of(R)}

    return rounded_results(world)[0]


def contacts_of(case: Json) -> tuple[list[Json], list[Chosen]]:
    """Contacts of all pairs without J, and whence they are."""
    by_pair = _contacts_by_pair(case)
    contacts = []
    for pair, one in zip(case["pairs"], by_pair, strict=True):
        of_both = of_pair(case, pair)
        contacts += [{**of_both, **c, **_tangents(c["n"])} for c in one.contacts]
    return contacts, by_pair


def of_pair(case: Json, pair: Json) -> Json:
    """What all contacts of a pair have in common."""
    bodies = {f"{side}_body": case["shapes"][pair[side]]["body"] for side in ("alpha", "beta")}
    friction = {k: pair[k] for k in ("mu_v", "mu_omega", "rows", "compliance") if k in pair}
    return {"pair": pair["name"], **bodies, **friction}


def _tangents(normal: list[float]) -> dict[str, Json]:
    """d1, the projection of the world axis farthest from n, and d2 = n x d1, each rounded."""
    n = np.array(exact(normal))
    d1 = rounded_results(lambda: tangents(n)[0])[0]
    return {"d1": d1, "d2": rounded_results(lambda: np.cross(n, np.array(exact(d1))))[0]}


def objective(case_input: Json) -> tuple[Json, Json]:
    """H (n_v, n_v) and g (n_v,) of Eq. (13), each entry rounded once."""
    case = exact_case({key: value for key, value in case_input.items() if key != "shapes"})

    def both() -> Any:
        at = kinematics(case["mechanism"], np.array(case["q"]))
        return dict(zip("Hg", program.objective(case, *program.loads(case, at)), strict=True))

    out = rounded_results(both)[0]
    return out["H"], out["g"]


def _errors(
    case: Json,
    qp_case: Json,
    by_pair: list[Chosen],
    jacobian: Expected,
    rows: Expected,
    sizes: tuple[float, float],
) -> tuple[Errors, dict[str, Tolerance]]:
    """What rounding in the layers before leaves in the case of layer `qp`, and in the contacts."""
    points = [abs(x) for one in by_pair for c in one.contacts for x in (*c["alpha"], *c["beta"])]
    pose = ROUNDINGS * EPS
    size_of = {"n": 1.0}
    worst = {
        name: max([one.tolerance[name] for one in by_pair], default=0.0)
        + pose * size_of.get(name, max(points, default=0.0))
        for name in FIELDS
    }
    why = "that of the layer distance, and of the poses"
    bounds = {name: tolerance(worst[name], why) for name in FIELDS}
    for name in ("d1", "d2"):
        bounds[name] = tolerance(4 * worst["n"], "that of n")
    reach = max([abs(x) for J in jacobian.output["J"] for row in J for x in row], default=0.0)
    mu = max([max(pair["mu_v"], pair["mu_omega"]) for pair in case["pairs"]], default=0.0)
    moved_J = jacobian.tolerance["J"].absolute + 2 * max(worst["alpha"], worst["beta"])
    turned_J = 12 * reach * worst["n"]
    bounds["J"] = tolerance(
        Fraction(moved_J + turned_J), "that of the layer jacobian, of the points, and of n"
    )
    A = (1 + 2 * mu) * (3 * moved_J + turned_J) + rows.tolerance["A"].absolute
    return Errors(
        H=Fraction(ROUNDINGS * EPS * sizes[0]),
        g=Fraction(ROUNDINGS * EPS * sizes[1]),
        A=Fraction(A if qp_case["A"] else 0.0),
        b=Fraction(worst["phi"] if qp_case["A"] else 0.0),
    ), bounds


def _wrench_bound(case: Json, solved: Expected, wrenches: Expected) -> Fraction:
    contacts = len(wrenches.output["wrench"])
    rows = len(solved.output["lam"]) // max(contacts, 1) + 1
    frictions = [max(p["mu_v"], p["mu_omega"]) for p in case["pairs"]] if contacts else []
    rounding = Fraction(wrenches.tolerance["wrench"].absolute)
    error = rows * max([1.0, *frictions]) * solved.tolerance["lam"].absolute
    return rounding + Fraction(error) / Fraction(case["h"])


def _plus(tolerance: Tolerance, more: float) -> Real:
    return Fraction(tolerance.absolute) + Fraction(more)
