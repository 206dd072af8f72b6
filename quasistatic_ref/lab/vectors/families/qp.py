"""Inputs of the layer `qp`: closed forms, grasps, degenerate and infeasible programs, all cones."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.lab.scenes.at_random import random_contacts, random_step
from quasistatic_ref.lab.scenes.contacts import repeated
from quasistatic_ref.lab.scenes.grasps import aligned_grasp_step
from quasistatic_ref.lab.vectors.families.by_hand import Case, by_hand
from quasistatic_ref.lab.vectors.families.steps import program
from quasistatic_ref.step.data import Contacts

CONES = ("product", "facets-8", "frictionless", "ellipsoid")
ULP = 2.0**-52


def qp_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    for kind, programs in by_hand("qp").items():
        for name, written in programs.items():
            yield f"qp/{kind}/{name}", written.pop("provenance"), written
    yield from _grasps(np.random.default_rng(51))
    yield from _random(np.random.default_rng(52))
    yield from _corners(np.random.default_rng(53))
    yield from _ellipsoid(np.random.default_rng(54))


def _grasps(rng: np.random.Generator) -> Iterator[Case]:
    for i in range(8):
        why = "a body squeezed between two fingers over a floor: 13 coordinates, 80 rows"
        yield f"qp/grasp/{i}", why, program(aligned_grasp_step(rng))
    for cone in CONES[:3]:
        why = f"the same in the cone {cone}"
        yield f"qp/grasp/{cone}", why, program(aligned_grasp_step(rng).replace(cone=cone))
    why = "two bodies in one gripper: 19 coordinates"
    yield "qp/grasp/two_bodies", why, program(aligned_grasp_step(rng, grip=8, floor=4, n_bodies=2))


def _random(rng: np.random.Generator) -> Iterator[Case]:
    for i in range(30):
        n_a, n_u, n_c = (int(v) for v in rng.integers(0, 6, 3))
        n_u += n_a + n_u == 0
        ratio = (1.0, 1e4, 1e8)[i % 3]
        at = random_contacts(rng, n_c, n_a + n_u, phi=abs(1e-3 * rng.standard_normal(n_c)))
        why = f"a random step of {n_c} contacts, masses and stiffness {ratio:g} apart"
        yield f"qp/random/{i}", why, program(random_step(rng, n_a, n_u, at, ratio))


def _corners(rng: np.random.Generator) -> Iterator[Case]:
    free = random_contacts(rng, 3, 6, phi=1e-4)
    split = free.phi * (1 + ULP * np.arange(3))
    for name, at, why in (
        ("duplicated", repeated(free, [0, 0, 1, 1, 1, 2]), "each contact there several times"),
        ("mu_v_zero", repeated(free, range(3), mu_v=np.zeros(3)), "no tangential friction"),
        ("mu_omega_zero", _with(free, mu_omega=0.0, rows=6), "mu_omega = 0 in six rows"),
        ("no_friction", _with(free, mu_v=0.0, mu_omega=0.0, rows=6), "six equal rows a contact"),
        ("four_rows", _with(free, rows=4), "no torsion"),
        ("six_rows", _with(free, rows=6), "torsion everywhere"),
        ("penetrating", _with(free, phi=-1e-3), "phi < 0: pushed out"),
        ("touching", _with(free, phi=0.0), "phi = 0"),
        ("far", _with(free, phi=1e3), "contacts a kilometre away"),
        (
            "nearly_tied",
            repeated(free, [0, 0, 0], phi=split),
            "one contact three times, its gaps one unit in the last place apart",
        ),
        ("huge_mu", _with(free, mu_v=1e5), "mu_v = 1e5"),
        ("tiny_mu", _with(free, mu_v=1e-9), "mu_v = 1e-9"),
    ):
        for n_a, n_u in ((6, 0), (0, 6), (2, 4)):
            what = {0: "nothing moves freely", 6: "nothing is actuated"}.get(n_u, "both kinds")
            step = random_step(rng, n_a, n_u, at)
            yield f"qp/corner/{name}_{n_a}_{n_u}", f"{why}; {what}", program(step)
    heavy = random_contacts(rng, 4, 8, phi=abs(1e-3 * rng.standard_normal(4)))
    for ratio in (1e6, 1e9, 1e12):
        why = f"masses and stiffness {ratio:g} apart"
        yield f"qp/ratio/{ratio:g}", why, program(random_step(rng, 4, 4, heavy, ratio))
    for n_a, n_u in ((5, 0), (0, 5), (3, 3)):
        why = f"no contacts: H^-1 g, with {n_a} actuated and {n_u} free coordinates"
        none = random_contacts(rng, 0, n_a + n_u)
        yield f"qp/no_contacts/{n_a}_{n_u}", why, program(random_step(rng, n_a, n_u, none))


def _ellipsoid(rng: np.random.Generator) -> Iterator[Case]:
    for i in range(10):
        n_c = 1 + i % 4
        at = random_contacts(rng, n_c, 6, phi=abs(1e-3 * rng.standard_normal(n_c)))
        why = f"a random step of {n_c} contacts in the ellipsoid"
        yield f"qp/ellipsoid/{i}", why, program(random_step(rng, 3, 3, at, cone="ellipsoid"))
    why = "a body squeezed between two fingers, in the ellipsoid"
    grasp = aligned_grasp_step(rng, 4, 2).replace(cone="ellipsoid")
    yield "qp/ellipsoid/grasp", why, program(grasp)
    flat = random_contacts(rng, 2, 6, mu_omega=0.0, rows=6, phi=1e-4)
    why = "an ellipsoid without torsion: a second-order cone in the plane"
    yield "qp/ellipsoid/flat", why, program(random_step(rng, 2, 4, flat, cone="ellipsoid"))


def _with(given: Contacts, **changes: float) -> Contacts:
    fields = {key: np.full(given.n_c, value) for key, value in changes.items()}
    return repeated(given, range(given.n_c), **fields)
