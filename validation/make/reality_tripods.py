"""A triangle on three points, pushed: ``python -m validation.make.reality_tripods``.

The first set calibrates frame and finger, by where the finger is at the ends of its pushes; with
these all five sets are predicted. The other cones and frictions of the finger are sensitivities.
"""

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.formats.files import json_text, text_written
from quasistatic_ref.formats.resources import reality_folder
from quasistatic_ref.lab.reality.errors import bootstrapped, pose_errors
from quasistatic_ref.lab.reality.tripods import (
    FINGER,
    calibration,
    tripod,
    tripod_prediction,
    tripods_read,
)

OUT = Path(__file__).parents[1] / "results" / "reality_tripods.json"
VARIANTS: dict[str, dict[str, Any]] = {
    "ellipsoid": {},
    "pyramid, axes at 0 degrees": {"cone": "pyramid"},
    "pyramid, axes at 22.5 degrees": {"cone": "pyramid", "axes": np.pi / 8},
    "pyramid, axes at 45 degrees": {"cone": "pyramid", "axes": np.pi / 4},
    "facets-16": {"cone": "facets-16"},
    "finger's friction 0.1": {"finger": 0.1},
    "finger's friction 0.5": {"finger": 0.5},
}
"""Name -> what differs; steps of the first are certified."""


def medians(values: np.ndarray, seed: int = 0) -> list[float]:
    """The median and the ends of its 95 % interval by the bootstrap."""
    rng = np.random.default_rng(seed)
    drawn = np.median(rng.choice(values, size=(2000, len(values))), axis=1)
    return [float(np.median(values)), *np.quantile(drawn, [0.025, 0.975]).tolist()]


def main() -> None:
    """Predict all sets, and write the summary."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=OUT)
    options = parser.parse_args()
    sets = tripods_read(reality_folder())
    frozen = calibration(sets[0])
    record: dict[str, Any] = {
        "calibrated on": sets[0].name,
        "offset [mm]": (1e3 * frozen.offset).tolist(),
        "angle [deg]": float(np.degrees(frozen.angle)),
        "radius [mm]": 1e3 * frozen.radius,
        "median distance at the ends [mm]": 1e3 * frozen.residual,
        "finger's friction": FINGER,
        "variants": {},
    }
    for name, changes in VARIANTS.items():
        entry: dict[str, Any] = {}
        for own in sets:
            scene, kinds, ends = tripod(own, frozen, **changes), {}, []
            certify = "off" if changes else "full"
            for before, path in zip(own.before, own.path, strict=True):
                end, found = tripod_prediction(scene, frozen, before, path, certify)
                ends.append(end)
                for kind, count in found.kinds.items():
                    kinds[kind] = kinds.get(kind, 0) + count
            units = [1e3, np.degrees(1.0)]
            errors = units * pose_errors(np.array(ends), own.after)
            moved = units * pose_errors(own.before, own.after)
            mean = bootstrapped([errors])
            entry[own.name] = {
                "pushes": len(ends),
                "steps": kinds,
                "median error [mm]": medians(errors[:, 0]),
                "median error [deg]": medians(errors[:, 1]),
                "mean error": [mean.mean.tolist(), mean.low.tolist(), mean.high.tolist()],
                "median motion [mm]": float(np.median(moved[:, 0])),
                "median motion [deg]": float(np.median(moved[:, 1])),
                "median error over median turn": float(
                    np.median(errors[:, 1]) / np.median(moved[:, 1])
                ),
            }
            print(name, own.name, entry[own.name]["median error over median turn"], flush=True)
        record["variants"][name] = entry
    text = json.dumps(json.loads(json_text(record)), indent=1)
    text_written(options.out, text + "\n")


if __name__ == "__main__":
    main()
