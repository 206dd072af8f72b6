"""Scenes with and without a derivative of q+, exact in float64, that are not among the vectors.

Lengths, masses and forces are sums of few powers of two, so that ties and limits of friction are
ties without rounding: in units of N = m h^2 g and the like.
"""

from quasistatic_ref.lab.vectors.tables import ORIGIN, UPRIGHT, at, link, on, scene

H = 0.125
G = [0.0, 0.0, -8.0]
MASS = {
    "mass": 0.5,
    "com": [0.0, 0.0, 0.0],
    "inertia": [[0.0078125, 0.0, 0.0], [0.0, 0.01171875, 0.0], [0.0, 0.0, 0.015625]],
}


def free_body(shape, xyz, **more):
    """A floating body with one shape, nothing else yet."""
    body = link("body", None, "floating", **MASS)
    given = {"h": H, "gravity": G, "pairs": [], **more}
    return scene([body], {"body": on("body", shape)}, [*xyz, *UPRIGHT], **given)


def onto(table, name, shape, pose=ORIGIN, **more):
    """The same with a shape of the world, and the pair of that and the body's."""
    friction = {"mu_v": 0.5, "mu_omega": 0.03125, "rows": 6, "k": 1, **more}
    pair = {"name": name, "alpha": name, "beta": "body", **friction}
    fixed = {"body": None, "pose": pose, "shape": shape}
    shapes = {**table["shapes"], name: fixed}
    return {**table, "shapes": shapes, "pairs": [*table["pairs"], pair]}


def with_force_on_body(table, force):
    """The same with a force on the body, along the world's axes [N]."""
    wrench = {"body": "body", "force": force, "torque": [0.0, 0.0, 0.0]}
    return {**table, "wrenches": [wrench]}


def squeezed_ball(push, cone="frictionless"):
    """A free ball of 1/2 kg between two fixed ones: a kink that no single coordinate shows.

    Moved across by eps it is free of both, by gaps of second order; a force across of the order eps
    takes it back by half of eps, whatever the force. h is 1/8 s, and nothing falls. The push is
    along x [N], on which the three centres are.
    """
    held = 0.25
    radius = 0.5
    table = free_body({"kind": "sphere", "radius": held}, [0.0] * 3, cone=cone, gravity=[0.0] * 3)
    for name, side in (("below", -1.0), ("above", 1.0)):
        place = at(side * (held + radius), 0.0, 0.0)
        table = onto(table, name, {"kind": "sphere", "radius": radius}, place, rows=4)
    return with_force_on_body(table, [push, 0.0, 0.0])
