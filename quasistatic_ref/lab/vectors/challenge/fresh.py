"""A case of a layer for any seed, easy ones first.

Easy is one contact, few bodies and numbers of one digit; then come cases as the vectors have them,
then those that are degenerate, badly scaled, or without solution.
"""

import math
from collections.abc import Callable

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.program.rotation import frame
from quasistatic_ref.lab.scenes.at_random import Rng, random_contacts, random_frames
from quasistatic_ref.lab.scenes.at_random import random_step as random_program
from quasistatic_ref.lab.scenes.contacts import NUMBERS, repeated
from quasistatic_ref.lab.scenes.grasps import grasp_step
from quasistatic_ref.lab.vectors.challenge.agreed import agreed_record
from quasistatic_ref.lab.vectors.challenge.random_mechanisms import (
    few_digits,
    random_follower,
    random_pose,
    random_q,
    random_step,
    random_tree,
)
from quasistatic_ref.lab.vectors.challenge.random_scenes import random_scene
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers import FILES, LAYERS, layer
from quasistatic_ref.lab.vectors.layers.rows import by_contact
from quasistatic_ref.lab.vectors.own.step import with_compliance
from quasistatic_ref.lab.vectors.tables import free_body, link
from quasistatic_ref.lab.vectors.trees import mapped
from quasistatic_ref.step.cones import cone as cone_of
from quasistatic_ref.step.data import Contacts, StepData
from quasistatic_ref.step.standard_form import standard_form

CONES = (
    "pyramid",
    "product",
    "facets-4",
    "facets-6",
    "facets-8",
    "facets-16",
    "frictionless",
)
SHAPES: dict[str, Json] = {
    "sphere": {"radius": 0.2},
    "box": {"size": [0.3, 0.5, 0.4]},
    "capsule": {"radius": 0.1, "length": 0.5},
    "convex": {
        "vertices": [
            [0.3, 0.1, 0.0],
            [-0.2, 0.3, 0.1],
            [-0.1, -0.3, 0.0],
            [0.05, 0.0, 0.4],
            [0.0, 0.1, -0.2],
            [0.2, -0.2, 0.15],
        ]
    },
    "cylinder": {"radius": 0.15, "length": 0.4},
    "cone": {"radius": 0.2, "length": 0.5},
    "ellipsoid": {"half_axes": [0.1, 0.2, 0.3]},
    "halfspace": {"normal": [0.1, 0.2, 0.97], "offset": 0.1},
}
"""One shape of each kind, of the size of things that a robot holds [m]."""
EASY, PLAIN, HARD = 0, 1, 2
"""How hard cases are: one contact and round numbers; as the vectors have them; corners."""
TRIES = 20
"""Inputs that are drawn until one has an answer; most have one at once."""
UNROUNDED = ("rows", "k", "n", "d1", "d2", "actuated", "joint", "compliance")
"""Fields of an easy case that keep their digits: what counts, names, or changes together."""


def fresh_case(name: str, seed: tuple[int, ...], level: int) -> tuple[Json, Json]:
    """An input of a layer and what is expected of it: the same for the same seed.

    Parameters
    ----------
    name : str
        A layer of CHALLENGED.
    seed : tuple of int
    level : int
        EASY, PLAIN or HARD.

    Raises
    ------
    RuntimeError
        If no draw gives a valid input.
    """
    for number in range(TRIES):
        rng = np.random.default_rng([*seed, LAYERS.index(name), number])
        case = MAKERS[name](rng, level)
        if level == EASY:
            case = _rounded(name, case)
        record = record_of(name, case)
        if record is not None:
            return case, record
    raise RuntimeError(f"no case of the layer {name} in {TRIES} draws: its maker is at fault")


def record_of(name: str, case: Json) -> Json | None:
    """What is expected of an input; None if it is none, or if nothing decides its answer."""
    try:
        with np.errstate(all="ignore"):  # as the plain program meets 0 / 0
            record = (
                agreed_record(name, case) if name in FILES else layer(name).expected(case).json()
            )
    except (QuasistaticError, ArithmeticError, ValueError, IndexError, KeyError):
        return None
    if record is None:
        return None
    for tolerance in record["tolerance"].values():
        tolerance["absolute"] *= MARGIN
    output = record["output"]
    if not _is_definite(case.get("H", output.get("H", []))):
        return None
    beyond = max(map(abs, output.get("delta_q", [])), default=0.0) > FARTHEST
    return None if beyond else record


MARGIN = 4.0
"""Tolerances are so many times those of the vectors, or of what two programs agree on [-]."""
FARTHEST = 1e3
"""A step of more [m, rad] is one of contacts that all but contradict each other: in float64 they
do."""


def _is_definite(H: Json) -> bool:
    return not H or bool(np.linalg.eigvalsh(np.array(H)).min() > 0)


def _rounded(name: str, case: Json) -> Json:
    """The same with numbers of one digit and frames along the axes; a whole step as it is."""
    if name == "step":
        return case  # rounded, what nearly touches would not

    def one_digit(x: Json) -> Json:
        return float(f"{x:.1g}") + 0.0 if isinstance(x, float) else x

    changed = mapped(case, one_digit, UNROUNDED)
    for contact in changed.get("contacts", []):
        contact |= _frame_of_axes(contact)
    return changed


def _frame_of_axes(contact: Json) -> Json:
    """A frame along the axes, n along the nearest."""
    n = np.array(contact["n"])
    axis = int(np.abs(n).argmax())
    along = np.sign(n[axis]) * np.eye(3)[axis]
    d1 = np.eye(3)[int(np.abs(along).argmin())]
    frame_of = {"n": along, "d1": d1, "d2": np.cross(along, d1)}
    return {key: (value + 0.0).tolist() for key, value in frame_of.items()}


def _contacts(rng: Rng, level: int, n_v: int) -> Contacts:
    n_c = 1 if level == EASY else int(rng.integers(1, 5))
    contacts = random_contacts(rng, n_c, n_v)
    if level < HARD:
        return contacts
    kind = rng.integers(8)
    changes = (
        {"phi": np.zeros(n_c)},
        {"phi": np.full(n_c, 1e3)},
        {"mu_v": np.zeros(n_c)},
        {"mu_omega": np.zeros(n_c)},
        {"mu_v": np.full(n_c, 1e5)},
        {"mu_v": np.full(n_c, 1e-9)},
        {"phi": np.full(n_c, -1e-3)},
        {},
    )[kind]
    return repeated(contacts, [0, *range(n_c - 1)] if kind == 7 else range(n_c), **changes)


def _contact_entries(at: Contacts, keys: tuple[str, ...]) -> Json:
    """The contacts as a case holds them: a list of tables with these fields."""
    return [{key: getattr(at, key)[j].tolist() for key in keys} for j in range(at.n_c)]


def _program(step: StepData) -> Json:
    """H, g, A, b of a step, in float64, as a case holds them; second-order cones likewise."""
    form = standard_form(step)
    H = form.H.tolist()
    g = form.g.tolist()
    if step.cone != "ellipsoid":
        return {"H": H, "g": g, "A": form.A.tolist(), "b": form.b.tolist()}
    at = step.contacts
    torsion = np.where(at.rows == 6, at.mu_omega, 0.0)
    mu = np.stack([np.ones(at.n_c), at.mu_v, at.mu_v, torsion], axis=1)
    F = form.A.reshape(at.n_c, 4, -1) * mu[:, :, None]
    blocks = [
        {"F": F_j.tolist(), "f": [phi, 0.0, 0.0, 0.0]}
        for F_j, phi in zip(F, at.phi.tolist(), strict=True)
    ]
    return {"H": H, "g": g, "second_order": blocks}


def _rows(rng: Rng, level: int) -> Json:
    at = _contacts(rng, level, int(rng.integers(1, 3 if level == EASY else 9)))
    return {"cone": str(rng.choice(CONES)), "contacts": _contact_entries(at, NUMBERS)}


def _qp(rng: Rng, level: int) -> Json:
    if level == HARD and rng.integers(4) == 0:
        return _program(grasp_step(rng, grip=int(rng.integers(2, 6)), floor=2))
    n_a, n_u = (int(v) for v in rng.integers(0, 2 if level == EASY else 4, 2))
    n_u += n_a + n_u == 0
    if level == PLAIN and rng.integers(4) == 0:
        at = _contacts(rng, PLAIN, n_a + n_u)
        at = repeated(at, range(at.n_c), phi=abs(at.phi))
        return _program(random_program(rng, n_a, n_u, at, cone="ellipsoid"))
    kind = int(rng.integers(3)) if level == HARD else -1  # one trouble at a time
    ratio = 10.0 ** int(rng.integers(9)) if kind == 0 else 1.0
    at = _contacts(rng, HARD if kind == 1 else min(level, PLAIN), n_a + n_u)
    program = _program(random_program(rng, n_a, n_u, at, ratio))
    if kind == 2:  # a row and its opposite, that leave no room
        program["A"].append([-x for x in program["A"][0]])
        program["b"].append(-program["b"][0] + 1e-3)
    return program


def _wrench(rng: Rng, level: int) -> Json:
    """Multipliers at random, on contacts between three bodies and the world."""
    cone = "pyramid" if level == EASY else str(rng.choice([*CONES, "ellipsoid"]))
    at = random_contacts(rng, 1 if level == EASY else int(rng.integers(1, 6)), 1)
    contacts = _contact_entries(at, ("n", "d1", "d2", "mu_v", "mu_omega", "rows"))
    names = [None, "a", "b", "c"]
    touched = set()
    for contact, n, phi in zip(contacts, at.n, at.phi, strict=True):
        one, two = rng.choice(4, 2, replace=False)
        alpha = 0.2 * rng.standard_normal(3)
        contact |= {"alpha_body": names[one], "beta_body": names[two]}
        contact |= {"alpha": alpha.tolist(), "beta": (alpha + phi * n).tolist()}
        touched |= {names[one], names[two]}
    points = {body: rng.uniform(-1, 1, 3).tolist() for body in names[1:] if body in touched}
    count = int(cone_of(cone).counts(at.rows).sum())
    lam = rng.random(count) * (rng.random(count) < 0.6)
    if cone == "ellipsoid":
        lam = (lam.reshape(-1, 4) * [4, 0.1, -0.1, 0.001]).ravel() + 0.0
    for contact, part in zip(contacts, by_contact(lam.tolist(), cone, contacts), strict=True):
        contact["lam"] = part
    bodies = {body: {"point": point} for body, point in points.items()}
    h = float(rng.choice([0.01, 0.02, 0.005, 0.1]))
    return {"h": h, "cone": cone, "contacts": contacts, "bodies": bodies}


def _tree(rng: Rng, level: int) -> Json:
    kinds = ("revolute", "prismatic", "continuous", "planar", "floating")
    if level == EASY:
        joint = str(rng.choice(kinds))
        return {"bodies": [link("body", None, joint, actuated=bool(rng.integers(2)))]}
    tree = random_tree(rng, int(rng.integers(1, 6)), str(rng.choice(["fixed", *kinds])))
    if rng.integers(3) == 0:
        tree["bodies"] += random_follower(rng, tree["bodies"][-1]["name"])
    elif rng.integers(3) == 0:
        tree["bodies"].append(free_body("other", actuated=bool(rng.integers(2))))
    return tree


def _jacobian(rng: Rng, level: int) -> Json:
    tree = _tree(rng, level)
    count = 1 if level == EASY else int(rng.integers(1, 4))
    names = [body["name"] for body in tree["bodies"]]
    contacts = []
    for axes in random_frames(rng, count):
        d1, d2, n = axes.tolist()
        bodies = {"alpha_body": [None, *names][int(rng.integers(len(names)))]}
        point = {side: few_digits(rng.uniform(-1, 1, 3)) for side in ("alpha", "beta")}
        contacts.append({**bodies, "beta_body": names[-1], "n": n, "d1": d1, "d2": d2, **point})
    return {"mechanism": tree, "q": random_q(rng, tree), "contacts": contacts}


def _integrate(rng: Rng, level: int) -> Json:
    size = (0.5, 0.5, 10.0 ** -int(rng.integers(9)))[level]
    tree = _tree(rng, level)
    q = random_q(rng, tree)
    delta_q = random_step(rng, tree, size)
    return {"mechanism": tree, "q": q, "delta_q": delta_q}


def _selection(rng: Rng, level: int) -> Json:
    most = (6, 20, 60)[level]
    sizes = [int(rng.integers(2, most))]
    k = int(rng.integers(1, 6))
    unit = (0.25, 1e-3, 2.0**-10)[level]
    draw = rng.standard_normal if level == PLAIN else lambda n: rng.integers(-3, 4, n)
    if level != EASY and rng.integers(3) == 0:
        sizes += [int(size) for size in rng.permutation([0, 1, int(rng.integers(2, most))])]
    phi = [(unit * draw(size)).tolist() for size in sizes]
    if level == EASY or min(sizes) == 0 or rng.integers(2):
        return {"phi": phi, "k": k}
    tilts = [rng.choice([0.0, 0.2, 0.3], size - 1).tolist() for size in sizes]  # [rad]
    normals = [[[math.sin(t), 0.0, math.cos(t)] for t in (*one, 0.0)] for one in tilts]
    return {"phi": phi, "normals": normals, "k": k}


def _shape(rng: Rng, kind: str) -> Json:
    """A shape of other lengths."""
    factor = float(rng.choice([0.5, 1.0, 2.0, 0.1]))
    lengths = {key: value for key, value in SHAPES[kind].items() if key != "normal"}
    scaled = {key: np.multiply(factor, value).tolist() for key, value in lengths.items()}
    return {"kind": kind, **SHAPES[kind], **scaled}


def _distance(rng: Rng, level: int) -> Json:
    easy = ("sphere", "halfspace", "box")
    kinds = [str(kind) for kind in rng.choice(easy if level == EASY else list(SHAPES), 2)]
    kinds = ["sphere" if kind == "halfspace" and i else kind for i, kind in enumerate(kinds)]
    if level == EASY and kinds[0] == "box":
        kinds[1] = "sphere"
    sides = [_shape(rng, kind) for kind in kinds]
    if level == HARD and rng.integers(4) == 0:
        points = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.21], *rng.uniform(-0.45, 0.45, (3, 3)).tolist()]
        sides[1] = {"kind": "cloud", "points": points}
    sides = sides[:: 1 if rng.integers(2) else -1]
    places = [random_pose(rng, 0.6) for _ in sides]
    if level != EASY and rng.integers(6) == 0:  # a small ball inside of a turned box
        sides, places = _ball_in_box(rng, places[0])
    if level == HARD and rng.integers(4) == 0:
        places = [{**place, "xyz": few_digits(1e4 * np.array(place["xyz"]))} for place in places]
    elif level == HARD and rng.integers(8) == 0:  # the centre of one is that of the other
        places[1]["xyz"] = places[0]["xyz"]
    elif level == HARD and rng.integers(8) == 0:
        sides[0] = _thin(sides[0])
    named = zip(("alpha", "beta"), sides, places, strict=True)
    return {k: v for s, shape, at in named for k, v in ((s, shape), (f"pose_{s}", at))}


def _thin(shape: Json) -> Json:
    """A plate or a needle: its first length is a thousandth."""
    match shape:
        case {"size": [first, *others]}:
            return {**shape, "size": [first / 1000, *others]}
        case {"vertices": vertices}:
            return {**shape, "vertices": [[x / 1000, y, z] for x, y, z in vertices]}
        case {"radius": radius}:
            return {**shape, "radius": radius / 1000}
        case _:
            return shape


def _ball_in_box(rng: Rng, place: Json) -> tuple[list[Json], list[Json]]:
    """A ball whose centre is in a box: the normal is that of the nearest face."""
    size = np.array(SHAPES["box"]["size"])
    R, t = frame(place)
    centre = R @ (size * rng.uniform(-0.45, 0.45, 3)) + t
    ball = {"kind": "sphere", "radius": float(rng.choice([0.01, 0.05]))}
    sides = [{"kind": "box", **SHAPES["box"]}, ball]
    places = [place, {**random_pose(rng), "xyz": few_digits(centre)}]
    turn = 1 if rng.integers(2) else -1
    return sides[::turn], places[::turn]


def _step(rng: Rng, level: int) -> Json:
    """A scene, with the compliance of its contacts where it makes a step."""
    case = random_scene(rng, level == HARD)
    try:
        return with_compliance(case)
    except QuasistaticError:
        return case


MAKERS: dict[str, Callable[[Rng, int], Json]] = {
    "distance": _distance,
    "selection": _selection,
    "jacobian": _jacobian,
    "rows": _rows,
    "qp": _qp,
    "wrench": _wrench,
    "integrate": _integrate,
    "step": _step,
}
CHALLENGED = tuple(MAKERS)
"""Layers with new cases: all but `derivative`."""
