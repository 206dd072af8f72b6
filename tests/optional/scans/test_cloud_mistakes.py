"""Mistakes of who describes a body by a cloud: the first finding names each."""

import numpy as np
import pytest

import quasistatic_ref as qr
from tests.oracles.scanned import SOLIDS

POINTS, (VOLUME, CENTRE, GYRATION) = SOLIDS["can"](np.random.default_rng(0), 1500)
"""A can about its middle, 115 mm high and 66 mm wide."""
MASS = 0.35
REST = 0.0575
"""Height at which it stands on the floor [m]."""


def urdf(mass=MASS, inertia=MASS * GYRATION, at=(0.0, 0.0, 0.0)):
    (xx, xy, xz), (_, yy, yz), (*_, zz) = inertia
    return (
        f'<robot name="can"><link name="can"><inertial><origin xyz="{at[0]} {at[1]} {at[2]}"/>'
        f'<mass value="{mass}"/><inertia ixx="{xx}" iyy="{yy}" izz="{zz}" ixy="{xy}" ixz="{xz}" '
        f'iyz="{yz}"/></inertial></link></robot>'
    )


def findings(folder, points=POINTS, text=None, z=REST, gravity=(0, 0, -9.81), **floor):
    """Names of the findings, the grave ones first, of a can on a floor for two steps."""
    np.save(folder / "can.npy", points)
    table = {"alpha": "floor", "beta": "can", "mu_v": 0.5, "rows": 4, "k": 8, **floor}
    scene = {
        "h": 0.01,
        "steps": 2,
        "gravity": list(gravity),
        "bodies": {
            "can": {
                "urdf": urdf() if text is None else text,
                "base": "floating",
                "pose": {"xyz": [0, 0, z]},
                "cloud": str(folder / "can.npy"),
            }
        },
        "shapes": {"floor": qr.HalfSpace((0, 0, 1), 0.0)},
        "contacts": {} if floor.get("alpha") == "none" else {"rest": table},
    }
    found = qr.load_scenario(scene).findings()
    return [one.name for one in found]


def test_a_can_as_it_is_has_no_finding(tmp_path):
    assert findings(tmp_path) == []


STRAY = np.array([[0.3, 0.2, 0.1], [-0.4, 0.1, 0.2], [0.1, 0.5, 0.3], [0.2, -0.3, 0.6], [0, 0, 1]])
MISTAKES = {
    "mass in grams": ({"text": urdf(350.0, 350.0 * GYRATION)}, "density"),
    "mass in tonnes": ({"text": urdf(3.5e-4, 3.5e-4 * GYRATION)}, "density"),
    "inertia in kg mm^2": ({"text": urdf(inertia=1e6 * MASS * GYRATION)}, "inertia"),
    "inertia of a template": ({"text": urdf(inertia=np.eye(3))}, "inertia"),
    "an inertia so that it is not zero": ({"text": urdf(inertia=1e-9 * np.eye(3))}, "inertia"),
    "centre of mass of another part": ({"text": urdf(at=(0.35, 0, 0))}, "centre of mass"),
    "centre of mass from the scanner": ({"text": urdf(at=(0, 0.12, 0.4))}, "centre of mass"),
    "points from the scanner": ({"points": POINTS + np.array([0.4, 0, 0])}, "centre of mass"),
    "points in millimetres": ({"points": 1e3 * POINTS, "z": 57.5}, "unit of a shape"),
    "points in centimetres": ({"points": 1e2 * POINTS, "z": 5.75}, "density"),
    "five stray points": ({"points": np.concatenate([POINTS, STRAY])}, "stray points"),
    "one of them below the floor": (
        {"points": np.concatenate([POINTS, [[0, 0, -0.2]]])},
        "stray points",
    ),
    "two stray points side by side": (
        {"points": np.concatenate([POINTS, STRAY[:1], STRAY[:1] + 1e-4])},
        "stray points",
    ),
    "the origin taken to be at the bottom": ({"z": 0.0}, "initial penetration"),
    "no table of a floor": ({"alpha": "none"}, "unsupported body"),
    "one point for all of it": ({"k": 1}, "too few points"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_the_first_finding(mistake, tmp_path):
    given, name = MISTAKES[mistake]
    assert findings(tmp_path, **given)[:1] == [name]
