"""Scenes at which q+ has no derivative, exact in float64, that are not among the vectors.

Lengths, masses and forces are sums of few powers of two, so that ties and limits of friction are
ties without rounding: in units of N = m h^2 g and the like.
"""

from typing import Any, Final

from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.mechanisms import ORIGIN, UPRIGHT, at, link
from quasistatic_ref.lab.vectors.families.step_scenes import on, scene

H: Final = 0.125
G: Final = [0.0, 0.0, -8.0]
MASS: Final[Json] = {
    "mass": 0.5,
    "com": [0.0, 0.0, 0.0],
    "inertia": [[0.0078125, 0.0, 0.0], [0.0, 0.01171875, 0.0], [0.0, 0.0, 0.015625]],
}


def free(shape: Json, xyz: list[float], quaternion: list[float] = UPRIGHT, **more: Any) -> Json:
    """A floating body with one shape, nothing else yet."""
    body = link("body", None, "floating", **MASS)
    given = {"h": H, "gravity": G, "pairs": [], **more}
    return scene([body], {"body": on("body", shape)}, [*xyz, *quaternion], **given)


def onto(table: Json, name: str, shape: Json, pose: Json = ORIGIN, **more: Any) -> Json:
    """The same with a shape of the world, and the pair of that and the body's."""
    friction = {"mu_v": 0.5, "mu_omega": 0.03125, "rows": 6, "k": 1, **more}
    pair = {"name": name, "alpha": name, "beta": "body", **friction}
    fixed = {"body": None, "pose": pose, "shape": shape}
    shapes = {**table["shapes"], name: fixed}
    return {**table, "shapes": shapes, "pairs": [*table["pairs"], pair]}


def pushed(table: Json, force: list[float], torque: list[float] | None = None) -> Json:
    """The same with a wrench on the body.

    Parameters
    ----------
    table : dict
    force, torque : list of float
        World frame, shape (3,) [N, N m].
    """
    wrench = {"body": "body", "force": force, "torque": torque or [0.0, 0.0, 0.0]}
    return {**table, "wrenches": [wrench]}


def squeezed(
    held: float, radius: float, push: float, *, axis: int = 0, cone: str = "frictionless"
) -> Json:
    """A free ball of 1/2 kg between two fixed ones: a kink that no single coordinate shows.

    Moved across by eps it is free of both, by gaps of second order; a force across of the order eps
    takes it back by half of eps, whatever the force. h is 1/8 s, and nothing falls.

    Parameters
    ----------
    held, radius : float
        Of the ball and of the fixed ones [m], sums of few powers of two.
    push : float
        Force on the ball along the axis [N].
    axis : int
        Of the world, on which the three centres are.
    cone : str
    """
    table = free({"kind": "sphere", "radius": held}, [0.0] * 3, cone=cone, gravity=[0.0] * 3)
    for name, side in (("below", -1.0), ("above", 1.0)):
        place = at(*_along(axis, side * (held + radius)))
        table = onto(table, name, {"kind": "sphere", "radius": radius}, place, rows=4)
    return pushed(table, _along(axis, push))


def _along(axis: int, length: float) -> list[float]:
    return [length if i == axis else 0.0 for i in range(3)]


def squeezed_at_random(rng: Rng) -> Json:
    """The same of any such sizes."""
    held, radius = (float(2.0 ** -int(rng.integers(1, 5))) for _ in range(2))
    push = float(rng.choice([-2.0, -0.5, 0.0, 1.0, 4.0]))
    return squeezed(held, radius, push, axis=int(rng.integers(3)))
