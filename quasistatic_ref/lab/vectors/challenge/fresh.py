"""Cases of every layer for any seed, easy ones first: a scene is drawn, and its layers are cut out.

Easy is a ball on a plane; then come scenes as the vectors have them, then those that are
degenerate, badly scaled, or without solution.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.made_steps.at_random import Rng
from quasistatic_ref.lab.program.candidates import candidates
from quasistatic_ref.lab.program.layers import plain
from quasistatic_ref.lab.program.mechanism import kinematics
from quasistatic_ref.lab.program.rows import cone_table
from quasistatic_ref.lab.program.step import contacts_of, sides_of, step_at
from quasistatic_ref.lab.vectors.agreed import agreed_record
from quasistatic_ref.lab.vectors.challenge.random_mechanisms import few_digits, random_step
from quasistatic_ref.lab.vectors.challenge.random_scenes import EASY, HARD, random_scene
from quasistatic_ref.lab.vectors.check.valid_witness import Sides
from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.lab.vectors.own.step import with_compliance
from quasistatic_ref.lab.vectors.trees import Json

CHALLENGED = LAYERS[:-1]
"""Layers with new cases: all but `derivative`."""
TRIES = 40
"""Scenes that are drawn until one has an answer; most have one at once."""
MARGIN = 4.0
"""Tolerances are so many times those at which two programs agree [-]."""
FARTHEST = 1e3
"""A step of more [m, rad] is one of contacts that all but contradict each other: in float64 they
do."""
REFUSALS = (QuasistaticError, ArithmeticError, ValueError, LookupError)
"""What is raised where a draw is no case: of an input that cannot be, or by 0 / 0."""


def fresh_case(name: str, seed: tuple[int, ...], level: int) -> tuple[Json, Json]:
    """A random input of a layer and its expected output; one seed gives one case.

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
        case = cut_scene((*seed, number), level).get(name)
        record = None if case is None else record_of(name, case)
        if record is not None:
            return case, record
    raise RuntimeError(f"no case of the layer {name} in {TRIES} draws: its maker is at fault")


def record_of(name: str, case: Json) -> Json | None:
    """The expected output of an input; None if the input is invalid or has no one answer."""
    try:
        with np.errstate(all="ignore"):  # as the plain program meets 0 / 0
            record = agreed_record(name, case)
    except REFUSALS:
        return None
    if record is None:
        return None
    for tolerance in record["tolerance"].values():
        tolerance["absolute"] *= MARGIN
    beyond = max(map(abs, record["output"].get("delta_q", [])), default=0.0) > FARTHEST
    return None if beyond else record


@lru_cache(maxsize=4)
def cut_scene(seed: tuple[int, ...], level: int) -> dict[str, Json]:
    """The input of each layer of a scene that is drawn once; nothing of one that is no scene."""
    rng = np.random.default_rng([*seed, level])
    try:
        with np.errstate(all="ignore"):
            case = random_scene(rng, level)
            at = kinematics(case["mechanism"], np.array(case["q"]))
            contacts = contacts_of(case, at)
            program = step_at(case, at, contacts)  # gives the contacts their J
            cases = {name: plain(cut(rng, level, case, contacts)) for name, cut in CUTS.items()}
            special = level == HARD and rng.integers(2)
            qp = {key: program[key] for key in ("H", "g", "A", "b")}
            return cases | {"qp": plain(_special_qp(rng, program, contacts) if special else qp)}
    except REFUSALS:
        return {}


def _kept(entries: Json, *keys: str) -> Json:
    """The entries with these fields alone."""
    return [{key: entry[key] for key in keys} for entry in entries]


def _sides(rng: Rng, case: Json) -> Sides:
    """The two shapes of a pair of a scene, with their poses in the world."""
    pair = case["pairs"][int(rng.integers(len(case["pairs"])))]
    sides: Sides = sides_of(case, pair, kinematics(case["mechanism"], np.array(case["q"])))
    return sides


def _distance(rng: Rng, level: int, case: Json, contacts: Json) -> Json:
    far = 1e4 if level == HARD and rng.integers(4) == 0 else 0.0
    cut = {}
    for side, (shape, (R, t)) in _sides(rng, case).items():
        quaternion = Rotation.from_matrix(R).as_quat() * rng.uniform(0.5, 2)
        cut[side] = shape
        cut[f"pose_{side}"] = {"xyz": few_digits(t + far, 6), "quaternion": quaternion}
    if level == HARD and rng.integers(8) == 0:  # the centre of one is that of the other
        cut["pose_alpha"]["xyz"] = cut["pose_beta"]["xyz"]
    return cut


def _selection(rng: Rng, level: int, case: Json, contacts: Json) -> Json:
    """Distances of the candidates of a pair, in whole mm where they are to be equal."""
    sides = _sides(rng, case)
    phi_of_candidates, _, _, n, *_ = candidates(*sides["alpha"], *sides["beta"], 5)
    phi = few_digits(phi_of_candidates, int(rng.choice([2, 3, 9])))
    k = int(rng.integers(1, 6))
    if "cloud" in (shape["kind"] for shape, _ in sides.values()):
        return {"k": k, "phi": [phi, phi[:1], []]}
    if len(phi) == 1:
        return {"k": k, "phi": [few_digits(rng.standard_normal(12), 1), phi]}
    return {"k": k, "phi": [phi], "normals": [np.array(n, dtype=np.float64)]}


def _jacobian(rng: Rng, level: int, case: Json, contacts: Json) -> Json:
    keys = ("alpha_body", "beta_body", "alpha", "beta", "n", "d1", "d2")
    return {"mechanism": case["mechanism"], "q": case["q"], "contacts": _kept(contacts, *keys)}


def _rows(rng: Rng, level: int, case: Json, contacts: Json) -> Json:
    keys = ("phi", "n", "d1", "d2", "J", "mu_v", "mu_omega", "rows")
    return {"cone": case["cone"], "contacts": _kept(contacts, *keys)}


def _wrench(rng: Rng, level: int, case: Json, contacts: Json) -> Json:
    """Input of the layer `wrench`: a scene's contacts with random multipliers, some of them 0."""
    cone = "ellipsoid" if level != EASY and rng.integers(5) == 0 else case["cone"]
    loaded = []
    for contact in contacts:
        count = 4 if cone == "ellipsoid" else len(cone_table(cone, contact["rows"]))
        lam = rng.random(count) * (rng.random(count) < 0.6)
        if cone == "ellipsoid":
            lam = lam * [4, 0.1, -0.1, 0.001] + 0.0
        loaded.append({**contact, "lam": lam})
    sides = ("alpha_body", "beta_body")
    keys = ("n", "d1", "d2", "mu_v", "mu_omega", "rows", "alpha", "beta", *sides, "lam")
    touched = {contact[side] for contact in contacts for side in sides} - {None}
    bodies = {name: {"point": few_digits(rng.uniform(-1, 1, 3))} for name in sorted(touched)}
    return {"h": case["h"], "cone": cone, "contacts": _kept(loaded, *keys), "bodies": bodies}


def _integrate(rng: Rng, level: int, case: Json, contacts: Json) -> Json:
    size = 10.0 ** -int(rng.integers(9)) if level == HARD else 0.5
    moved = random_step(rng, case["mechanism"], size)
    return {"mechanism": case["mechanism"], "q": case["q"], "delta_q": moved}


def _step(rng: Rng, level: int, case: Json, contacts: Json) -> Json:
    """The scene, with the compliance of its contacts where it makes a step."""
    try:
        return with_compliance(case)
    except QuasistaticError:
        return case


def _special_qp(rng: Rng, program: Json, contacts: Json) -> Json:
    """A scene's program badly scaled, without room, or with second-order cones."""
    H, g, A, b = (program[key] for key in ("H", "g", "A", "b"))
    kind = int(rng.integers(3))
    if kind == 0:
        scale = 10.0 ** rng.integers(-2, 3, len(g))
        return {"H": scale[:, None] * H * scale, "g": scale * g, "A": A * scale, "b": b}
    if kind == 1:  # a row and its opposite
        opposed = {"A": np.vstack([A, -A[:1]]), "b": np.append(b, 1e-3 - b[0])}
        return {"H": H, "g": g, **opposed}
    blocks = []
    for c in contacts:
        sides = np.array([c["n"], c["mu_v"] * c["d1"], c["mu_v"] * c["d2"]]) @ c["J"][:3]
        spin = c["mu_omega"] * (c["rows"] == 6) * c["J"][3:]
        blocks.append({"F": np.vstack([sides, spin]), "f": [abs(c["phi"]), 0.0, 0.0, 0.0]})
    return {"H": H, "g": g, "second_order": blocks}


CUTS: dict[str, Callable[[Rng, int, Json, Json], Json]] = {
    "distance": _distance,
    "selection": _selection,
    "jacobian": _jacobian,
    "rows": _rows,
    "wrench": _wrench,
    "integrate": _integrate,
    "step": _step,
}
"""What each layer is given of a scene and its contacts."""
