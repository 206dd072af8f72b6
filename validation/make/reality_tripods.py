"""A triangle on three points, pushed: ``python -m validation.make.reality_tripods``.

The first set calibrates frame and finger, by where the finger is at the ends of its pushes; with
these all five sets are predicted. The other cones and frictions of the finger are sensitivities.
"""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

from quasistatic_ref import InputError
from quasistatic_ref.lab.folders import reality_folder
from quasistatic_ref.lab.reality.errors import bootstrap_estimate, errors_of
from quasistatic_ref.lab.reality.outline import Outline, rotation
from quasistatic_ref.lab.reality.predict import Prediction, prediction
from quasistatic_ref.lab.reality.push import Pushed
from quasistatic_ref.lab.reality.pushes import Pushes
from quasistatic_ref.lab.reality.settings import ADVANCE, Settings
from quasistatic_ref.lab.reality.tables import table_read
from quasistatic_ref.step.cones import ELLIPSOID
from quasistatic_ref.step.data import Array
from validation.tools.scripts import RESULTS, record_written, script_options

LEG, MASS = 0.15, 1.518
"""Of the right triangle, the corner at the origin of its frame [m], [kg]."""
TRIANGLE = Outline(LEG * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]))

FINGER = 0.25
"""Friction of the finger on the object [-]: not measured; that of the other pushes is taken."""

PLACES = 40
"""Places of the finger along its path."""
SUPPORTS = ("support_x1", "support_y1", "support_x2", "support_y2", "support_x3",
                   "support_y3")  # fmt: skip
PATH = tuple(f"finger_{axis}{k}" for k in range(PLACES) for axis in "xy")
COLUMNS = {
    **dict.fromkeys(SUPPORTS, "[m] place of a support, object frame"),
    "push": "[-] number of the push in its set",
    "x0": "[m] origin of the object's frame before, world frame",
    "y0": "[m]",
    "theta0": "[rad]",
    "x1": "[m] after",
    "y1": "[m]",
    "theta1": "[rad]",
    **dict.fromkeys(PATH, "[m] place of the finger along its path"),
}


@dataclass(frozen=True, eq=False)
class TripodSet:
    """Pushes on one surface and one triple of supports.

    Parameters
    ----------
    name : str
        Surface and places [mm].
    supports : ndarray, shape (3, 2)
        Object frame [m].
    pushes : Pushes
        Each with a path of 40 places of the finger.
    """

    name: str
    supports: Array
    pushes: Pushes


@dataclass(frozen=True, eq=False)
class Calibration:
    """What is frozen after one set.

    Parameters
    ----------
    offset : ndarray, shape (2,)
        Of the object's frame in the measured one [m].
    angle : float
        Between them [rad].
    radius : float
        Of the finger [m].
    residual : float
        Median distance of the finger from the outline at the end of a push [m].
    """

    offset: Array
    angle: float
    radius: float
    residual: float

    def object_pose(self, measured: Array) -> Array:
        """The object's frame, shape (3,) [m, rad], where the measured one is known."""
        origin = measured[:2] + rotation(measured[2]) @ self.offset
        return np.append(origin, measured[2] + self.angle)

    def measured_pose(self, of: Array) -> Array:
        """The measured frame, shape (3,), where the object's is `of`, shape (3,) [m, rad]."""
        angle = of[2] - self.angle
        return np.append(of[:2] - rotation(angle) @ self.offset, angle)


def tripods_read(folder: Path) -> list[TripodSet]:
    """The sets of ``tripods.csv`` in the order of the file.

    Raises
    ------
    InputError
        If the file is missing or not as it must be.
    """
    table = table_read(folder / "tripods.csv", COLUMNS, {}, ("surface",))
    every = np.arange(len(table.pairs))
    places = table.array(every, *SUPPORTS)
    sets = {}
    for k, surface in enumerate(table.pairs):
        points = " ".join(f"({x:.0f}, {y:.0f})" for x, y in 1e3 * places[k].reshape(3, 2))
        sets.setdefault(f"{surface} {points}", []).append(k)
    found = []
    for name, rows in sets.items():
        own = np.array(rows)
        path = table.array(own, *PATH).reshape(-1, PLACES, 2)
        before = table.array(own, "x0", "y0", "theta0")
        after = table.array(own, "x1", "y1", "theta1")
        pushes = Pushes(table.numbers["push"][own], before, after, path, None)
        found.append(TripodSet(name, places[own[0]].reshape(3, 2), pushes))
    return found


def calibration(of: TripodSet) -> Calibration:
    """Offset, angle and radius with which the finger touches the outline at the ends of pushes.

    Least squares of the distances, those beyond a millimetre counted by their size (soft L1).

    Raises
    ------
    InputError
        If the set has fewer pushes than there are unknowns.
    """
    after = of.pushes.after
    if len(after) < 5:
        raise InputError("has too few pushes to calibrate on", field=of.name, value=len(after))
    ends = zip(after, of.pushes.path[:, -1], strict=True)
    tips = np.array([rotation(pose[2]).T @ (tip - pose[:2]) for pose, tip in ends])

    def gaps(x: Array) -> Array:
        own = (tips - 1e-3 * x[:2]) @ rotation(1e-3 * x[3])
        return np.array([1e3 * TRIANGLE.closest(tip)[0] - x[2] for tip in own])

    found = least_squares(gaps, np.zeros(4), loss="soft_l1").x
    residual = float(1e-3 * np.median(np.abs(gaps(found))))
    # A radius below zero is none: the recorded places are those of the finger's surface.
    return Calibration(1e-3 * found[:2], 1e-3 * found[3], max(1e-3 * found[2], 0.0), residual)


def tripod(
    of: TripodSet,
    frozen: Calibration,
    cone: str = ELLIPSOID,
    axes: float = 0.0,
    finger: float = FINGER,
    advance: float = ADVANCE,
) -> Pushed:
    """The scene of a set.

    Parameters
    ----------
    of : TripodSet
    frozen : Calibration
    cone : str
    axes : float
        Angle of d1 of the supports from the world's x [deg].
    finger : float
        Friction [-].
    advance : float
        Of the finger in a step [m].
    """
    points = tuple((float(x), float(y)) for x, y in of.supports - TRIANGLE.centre)
    by = Settings(cone=cone, axes=axes, advance=advance, m=MASS)
    return Pushed(TRIANGLE, frozen.radius, finger, 0.0, points, by)


def tripod_prediction(
    scene: Pushed, frozen: Calibration, before: Array, path: Array, certify: str = "full"
) -> tuple[Array, Prediction]:
    """The measured pose, shape (3,) [m, rad], that is predicted after a push.

    Parameters
    ----------
    scene : Pushed
    frozen : Calibration
    before : ndarray, shape (3,)
        Measured pose [m, rad].
    path : ndarray, shape (n, 2)
        Of the finger [m].
    certify : str
    """
    found = prediction(scene, frozen.object_pose(before), path, certify)
    return frozen.measured_pose(found.pose), found


OUT = RESULTS / "reality_tripods.json"
VARIANTS = {
    "ellipsoid": {},
    "pyramid, axes at 0 degrees": {"cone": "pyramid"},
    "pyramid, axes at 22.5 degrees": {"cone": "pyramid", "axes": 22.5},
    "pyramid, axes at 45 degrees": {"cone": "pyramid", "axes": 45.0},
    "facets-16": {"cone": "facets-16"},
    "finger's friction 0.1": {"finger": 0.1},
    "finger's friction 0.5": {"finger": 0.5},
}
"""Name -> what differs; steps of the first are certified."""


def medians(values: np.ndarray) -> list[float]:
    """The median and the ends of its 95 % interval by the bootstrap."""
    rng = np.random.default_rng(0)
    drawn = np.median(rng.choice(values, size=(2000, len(values))), axis=1)
    return [float(np.median(values)), *np.quantile(drawn, [0.025, 0.975]).tolist()]


def main() -> None:
    """Predict all sets, and write the summary."""
    options = script_options(__doc__, out=OUT)
    sets = tripods_read(reality_folder())
    frozen = calibration(sets[0])
    record = {
        "calibrated on": sets[0].name,
        "offset [mm]": (1e3 * frozen.offset).tolist(),
        "angle [deg]": float(np.degrees(frozen.angle)),
        "radius [mm]": 1e3 * frozen.radius,
        "median distance at the ends [mm]": 1e3 * frozen.residual,
        "finger's friction": FINGER,
        "variants": {},
    }
    for name, changes in VARIANTS.items():
        entry = {}
        for own in sets:
            scene = tripod(own, frozen, **changes)
            kinds = Counter()
            ends = []
            certify = "off" if changes else "full"
            for before, path in zip(own.pushes.before, own.pushes.path, strict=True):
                end, steps = tripod_prediction(scene, frozen, before, path, certify)
                ends.append(end)
                kinds.update(steps.kinds)
            found = errors_of(np.array(ends), own.pushes)
            mean = bootstrap_estimate([found.model])
            entry[own.name] = {
                "pushes": len(ends),
                "steps": kinds,
                "median error [mm]": medians(found.model[:, 0]),
                "median error [deg]": medians(found.model[:, 1]),
                "mean error": [mean.mean.tolist(), mean.low.tolist(), mean.high.tolist()],
                "median motion [mm]": float(np.median(found.moved[:, 0])),
                "median motion [deg]": float(np.median(found.moved[:, 1])),
                "median error over median turn": float(
                    np.median(found.model[:, 1]) / np.median(found.moved[:, 1])
                ),
            }
            print(name, own.name, entry[own.name]["median error over median turn"], flush=True)
        record["variants"][name] = entry
    record_written(options.out, record)


if __name__ == "__main__":
    main()
