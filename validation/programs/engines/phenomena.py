"""Phenomena with closed forms: scene, formula, tolerance and its reason, and how it is measured."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from validation.programs.engines.scenes import (
    GRAVITY,
    TIME_STEP,
    Body,
    Load,
    Motion,
    Scene,
    Shape,
    Turning,
    times,
)

MU_V = 0.5
MU_OMEGA = 0.01
WEIGHT = 0.3 * GRAVITY
"""Of the sled and of the ball [N]."""
START = 0.5
"""When loads begin, on a body that has settled [s]."""
EVERY = 0.02
"""Between the times at which poses are read [s]."""


@dataclass(frozen=True)
class Phenomenon:
    """A question whose answer is known.

    Parameters
    ----------
    title, unit : str
    scenes : tuple of Scene
    measure : callable
        Motions of the scenes -> the value.
    answer : float
    formula : str
        Where the answer comes from.
    tolerance : float
        Absolute; infinite where no closed form exists, and nothing is judged.
    reason : str
        Of the tolerance.
    torsion : bool
        Whether an engine needs a coefficient of torsional friction.
    """

    title: str
    unit: str
    scenes: tuple[Scene, ...]
    measure: Callable[[list[Motion]], float]
    answer: float
    formula: str
    tolerance: float
    reason: str
    torsion: bool = False

    def holds(self, value: float) -> bool:
        """Whether a value is the answer."""
        return abs(value - self.answer) <= self.tolerance

    def with_friction(self, scale: float) -> "Phenomenon":
        """The same question to an engine whose coefficients are wrong by a factor."""
        wrong = [
            replace(scene, mu_v=scale * scene.mu_v, mu_omega=scale * scene.mu_omega)
            for scene in self.scenes
        ]
        return replace(self, scenes=tuple(wrong))


# -- Scenes --------------------------------------------------------------------------------------

FEET = tuple(Shape("sphere", (0.01,), (x, y, -0.01)) for y in (-0.1, 0.1) for x in (-0.1, 0.1))
SLED = Body("sled", "free", 0.3, (1e-3, 1e-3, 2e-3), (0.0, 0.0, 0.02), FEET)
BALL = Body("ball", "free", 0.3, (3e-4,) * 3, (0.0, 0.0, 0.05), (Shape("sphere", (0.05,)),))
HALF = 0.1
"""Half of the length and width of the box on four corners [m]."""
CENTRE = (0.03, 0.02)
"""Its centre of mass, from its middle [m]."""
BOX = Body(
    "box", "free", 1.0, (4e-3, 4e-3, 7e-3), (0.0, 0.0, 0.05),
    (Shape("box", (2 * HALF, 2 * HALF, 0.1), (-CENTRE[0], -CENTRE[1], 0.0)),),
)  # fmt: skip


def on_slope(tangent: float, heading: float = 0.0) -> Scene:
    """The sled, under gravity that turns by atan(tangent) towards a heading [rad]."""
    angle = np.arctan(tangent)
    across = WEIGHT * np.sin(angle)
    lift = WEIGHT * (1 - np.cos(angle))
    force = (across * np.cos(heading), across * np.sin(heading), lift)
    load = Load("sled", START, tuple(map(float, force)))
    return Scene((SLED,), MU_V, MU_OMEGA, times(START, 1.0, EVERY), (load,))


def twisted(share: float) -> Scene:
    """The ball, under a share of the torque that torsional friction bears."""
    load = Load("ball", START, torque=(0.0, 0.0, share * MU_OMEGA * WEIGHT))
    return Scene((BALL,), MU_V, MU_OMEGA, times(START, 1.0, EVERY), (load,))


def held(offset: float, grip: float, finger: Shape) -> Scene:
    """A bar between two fingers at a distance from its centre of mass [m]; its weight is a load."""
    bar = Body("bar", "free", 0.2, (1e-4,) * 3, (0.0, 0.0, 0.0), (Shape("box", (0.06, 0.2, 0.04)),))
    left = Body("left", "fixed", 0.1, (1e-4,) * 3, (-0.05, offset, 0.0), (finger,))
    right = Body("right", "rail_x", 0.1, (1e-4,) * 3, (0.05, offset, 0.0), (finger,))
    squeeze = Load("right", 0.0, (-grip, 0.0, 0.0))
    weight = Load("bar", START, (0.0, 0.0, -0.2 * GRAVITY))
    bodies = (bar, left, right)
    loads = (squeeze, weight)
    return Scene(bodies, 0.6, 0.005, times(START, START + 10.0, 0.1), loads, 0.0, floor=False)


TABLE = Body(
    "table", "hinge_z", 1200.0, (101.0, 101.0, 200.0), (0.0, 0.0, -0.05),
    (Shape("box", (1.0, 1.0, 0.1)),),
)  # fmt: skip
"""So heavy that the sled hardly slows it. Bullet takes the inertia of a link from its shape."""
RADIUS = 0.2
"""Of the sled's way on the table [m]."""
RATE = 1.0
"""Of the table, once it turns evenly [rad/s]."""


def on_turntable() -> Scene:
    """The sled on a table that turns evenly from START on."""
    turning = Turning(TABLE, RATE, START)
    sled = replace(SLED, xyz=(RADIUS, 0.0, SLED.xyz[2]))
    return Scene(
        (sled, TABLE), MU_V, MU_OMEGA, times(START, START + 2.0, 0.1), turning.loads,
        floor=False, turning=turning,
    )  # fmt: skip


DROP = replace(BALL, xyz=(0.0, 0.0, 0.051))
"""The ball, one millimetre above the floor."""
OFFSET = 0.03
SLIP_GRIP = 0.2 * GRAVITY / (2 * 0.6)
"""The least grip at which the bar does not slip, without a torque [N]."""
TURN_GRIP = 0.2 * GRAVITY * OFFSET / (2 * 0.005)
"""The least grip at which it does not turn, if friction bore no force [N]."""


# -- Measures ------------------------------------------------------------------------------------


def drift(motions: list[Motion]) -> float:
    """Mean speed of the centre of mass over the second half [um/s]."""
    (motion,) = motions
    return 1e6 * motion.distance / motion.seconds


def creep(motions: list[Motion]) -> float:
    """The same, in a minute [um]."""
    return 60 * drift(motions)


def spin(motions: list[Motion]) -> float:
    """Mean rate of turning over the second half [rad/s]."""
    (motion,) = motions
    return float(motion.turns[motion.middle :].sum() / motion.seconds)


def turned(motions: list[Motion]) -> float:
    """Turned from the first time to the last [mrad]."""
    (motion,) = motions
    return float(1e3 * motion.turns.sum())


def torque_limit(motions: list[Motion]) -> float:
    """Share at which the turn of the second half, a line over the torque, is zero [-]."""
    low, high = (motion.turns[motion.middle :].sum() for motion in motions)
    return float((TWISTS[0] * high - TWISTS[1] * low) / (high - low))


def slope_limit(motions: list[Motion]) -> float:
    """Slope at which distances, which are as sin a - mu cos a, are zero: atan mu [deg]."""
    low, high = (motion.distance for motion in motions)
    sine, cosine = np.sin(np.arctan(SLOPES)), np.cos(np.arctan(SLOPES))
    return float(np.degrees(np.arctan2(
        high * sine[0] - low * sine[1], high * cosine[0] - low * cosine[1]
    )))  # fmt: skip


def rise(motions: list[Motion]) -> float:
    """Largest height above that of the start, over the slip of a last step [-]."""
    (motion,) = motions
    speed = np.linalg.norm((motion.places[-1] - motion.places[-2])[:2]) / EVERY
    return float(max(0.0, motion.places[:, 2].max() - SLED.xyz[2]) / (speed * TIME_STEP))


def outwards(motions: list[Motion]) -> float:
    """Speed away from the axis in the second half, over the centripetal acceleration [ms]."""
    (motion,) = motions
    radii = np.linalg.norm(motion.places[:, :2], axis=1)
    return float(1e3 * np.log(radii[-1] / radii[motion.middle]) / (motion.seconds * RATE**2))


def uneven(motions: list[Motion]) -> float:
    """Largest difference of a corner's force to that of equal springs, over the weight [%]."""
    (motion,) = motions
    weight = BOX.mass * GRAVITY
    middle = motion.places[-1, :2] - CENTRE
    contacts = motion.engine.normal_forces()
    worst = 0.0
    for corner in np.array([(x, y) for x in (-1, 1) for y in (-1, 1)]):
        force = sum(N for point, N in contacts if (np.sign(point[:2] - middle) == corner).all())
        springs = weight / 4 * (1 + corner @ CENTRE / HALF)
        worst = max(worst, abs(force - springs) / weight)
    return 100 * worst


SLOPES = (0.75, 1.0)
TWISTS = (1.5, 2.0)
RESTING = Scene((BOX,), MU_V, MU_OMEGA, times(0.0, 1.0, 0.5))
FALLING = Scene((DROP,), MU_V, MU_OMEGA, times(0.0, 1.0, EVERY))
MICROMETRE = "A millimetre in 17 minutes; rounding leaves less, even in float32."

PHENOMENA = {
    "sticks_on_slope": Phenomenon(
        "sticks on a slope", "um/s", (on_slope(0.45),), drift, 0.0,
        "Zero: the slope's tangent is 0.45, and mu_v = 0.5.", 1.0, MICROMETRE,
    ),
    "incline_angle": Phenomenon(
        "begins to slide at", "deg", tuple(map(on_slope, SLOPES)), slope_limit,
        float(np.degrees(np.arctan(MU_V))),
        "atan(mu_v), from the distances at the tangents 0.75 and 1, as sin a - mu_v cos a.",
        0.27, "One per cent.",
    ),
    "incline_diagonal": Phenomenon(
        "the same, along the diagonal", "deg",
        tuple(on_slope(tangent, np.pi / 4) for tangent in SLOPES), slope_limit,
        float(np.degrees(np.arctan(MU_V))),
        "atan(mu_v) again. A pyramid with edges along x and y has atan(mu_v / sqrt 2), 19.47.",
        0.27, "One per cent.",
    ),
    "no_lift_off": Phenomenon(
        "rises while it slides", "of the slip of a step", (on_slope(1.0),), rise, 0.0,
        "Zero: a sliding body stays on the floor. The slope's tangent is 1.", 0.01,
        "A relaxation of Coulomb's law that couples slip and gap has mu_v = 0.5.",
    ),
    "carried_on_a_turntable": Phenomenon(
        "carried on a turntable, walks outwards", "ms times the centripetal acceleration",
        (on_turntable(),), outwards, 0.0,
        "Zero: the table turns evenly at 1 rad/s, and of mu_v g = 4.9 m/s^2 the sled, 0.2 m from "
        "the axis, needs 0.2 m/s^2.", 0.005,
        "A micrometre a second; rounding leaves less, even in float32.",
    ),
    "sticks_in_torsion": Phenomenon(
        "sticks in torsion", "rad/s", (twisted(0.99),), spin, 0.0,
        "Zero: the torque about the normal is 0.99 mu_omega m g.", 1e-4, "A turn in 17 hours.",
        torsion=True,
    ),
    "torsional_limit": Phenomenon(
        "begins to spin at", "mu_omega m g", tuple(map(twisted, TWISTS)), torque_limit, 1.0,
        "One, from the turns at 1.5 and 2 mu_omega m g, which are as the torque less its limit.",
        0.02, "Two per cent: the contact settles within some steps.", torsion=True,
    ),
    "bar_turns": Phenomenon(
        "a bar held off its centre turns in 10 s", "mrad",
        (held(OFFSET, 1.2 * (SLIP_GRIP + TURN_GRIP), Shape("sphere", (0.02,))),), turned, 0.0,
        "Zero: the grip is 1.2 (m g / (2 mu_v) + m g d / (2 mu_omega)), the most that any of the "
        "cones of this project needs (R21 to R23).", 1.0, "A millimetre at the far end of 1 m.",
        torsion=True,
    ),
    "box_creeps": Phenomenon(
        "a box between two pads creeps in a minute", "um",
        (held(0.0, 1.5 * SLIP_GRIP, Shape("box", (0.04,) * 3)),), creep, 0.0,
        "Zero: the grip is 1.5 times the least, m g / (2 mu_v).", 60.0, MICROMETRE,
    ),
    "comes_to_rest": Phenomenon(
        "comes to rest after a fall of 1 mm", "um/s", (FALLING,), drift, 0.0,
        "Zero, from half a second to a second after the start.", 1.0, MICROMETRE,
    ),
    "four_corners": Phenomenon(
        "a box on four corners, from equal springs", "% of m g", (RESTING,), uneven, 0.0,
        "Four normal forces of a rigid box have no closed form. Equal springs would bear "
        "m g / 4 (1 + x c_x / a^2 + y c_y / a^2), at corners (x, y) = (+-a, +-a).",
        float("inf"), "Shown, and not judged.",
    ),
}  # fmt: skip
