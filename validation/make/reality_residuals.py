"""What is left of the errors of predicted pushes: ``python -m validation.make.reality_residuals``.

From the committed predictions (``results/reality.csv``): errors by whether the finger stuck or
slid, and by how far from the centre it pushed; whether the published simulator errs alike; how far
the finger was from the outline where it should have touched; and the errors of a tenth of the
pushes with each path shifted so that it touches.
"""

import argparse
import csv
import json
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.formats.files import json_text, text_written
from quasistatic_ref.formats.resources import reality_folder
from quasistatic_ref.lab.reality.errors import bootstrapped, pose_errors
from quasistatic_ref.lab.reality.identify import identified
from quasistatic_ref.lab.reality.loads import loads_read
from quasistatic_ref.lab.reality.pairs import pairs_read
from quasistatic_ref.lab.reality.predict import predicted, rotation
from quasistatic_ref.lab.reality.pushes import pushes_read
from quasistatic_ref.lab.reality.settings import Settings

RESULTS = Path(__file__).parents[1] / "results"
UNITS = np.array([1e3, np.degrees(1.0)])


def group(errors: list[np.ndarray]) -> dict[str, Any]:
    """Number, mean and its interval of the errors of some pushes."""
    every = np.concatenate(errors) if errors else np.zeros((0, 2))
    if len(every) < 2:
        return {"pushes": len(every)}
    found = bootstrapped([every])
    return {"pushes": len(every), **{k: v.tolist() for k, v in vars(found).items()}}


def main() -> None:
    """Analyse, and write the summary."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--predictions", type=Path, default=RESULTS / "reality.csv")
    parser.add_argument("--out", type=Path, default=RESULTS / "reality_residuals.json")
    options = parser.parse_args()
    with options.predictions.open(encoding="utf-8") as file:
        rows = {(f"{r['surface']}/{r['shape']}", int(r["push"])): r for r in csv.DictReader(file)}
    folder = reality_folder()
    pairs = pairs_read(folder)
    loads, pushes = loads_read(folder, pairs), pushes_read(folder, pairs)
    grips: dict[str, list[np.ndarray]] = {"sticks": [], "slides": [], "both": [], "misses": []}
    arms: dict[str, list[np.ndarray]] = {"below 1/3": [], "1/3 to 2/3": [], "above 2/3": []}
    own_gaps, other_gaps, starts = [], [], []
    shifted, unshifted = [], []
    for pair in pairs:
        own = pushes[pair.name]
        ratio = identified(loads[pair.name], pair.outline.gyration).ratio
        scene = Settings().pushed(pair, ratio)
        pair_shifted, pair_unshifted = [], []
        for k, number in enumerate(own.number.tolist()):
            if (pair.name, number) not in rows:
                continue
            row = rows[pair.name, number]
            found = np.array([float(row[name]) for name in ("x1", "y1", "theta1")])
            error = UNITS * pose_errors(found[None], own.after[k : k + 1])
            stuck, slid = int(row["sticks"]), int(row["slides"])
            kind = "misses" if not stuck + slid else "both"
            kind = "sticks" if stuck and not slid else "slides" if slid and not stuck else kind
            grips[kind].append(error)
            R = rotation(own.before[k, 2])
            start, end = (own.path[k] - own.before[k, :2]) @ R
            way = (end - start) / np.linalg.norm(end - start)
            arm = start - pair.outline.centre
            off = abs(arm[0] * way[1] - arm[1] * way[0]) / pair.outline.gyration
            arms[
                "below 1/3" if off < 1 / 3 else "above 2/3" if off > 2 / 3 else "1/3 to 2/3"
            ].append(error)
            distance, _, normal = pair.outline.closest(start)
            starts.append(1e3 * (distance - pair.radius))
            own_gaps.append((found - own.after[k])[:2] @ rotation(own.after[k, 2]))
            if own.published is not None:
                gap = (own.published[k] - own.after[k])[:2]
                other_gaps.append(gap @ rotation(own.after[k, 2]))
            if k % 10 == 0:
                shift = R @ normal * (distance - pair.radius)
                touching = predicted(scene, own.before[k], own.path[k] + shift, "off").pose
                pair_shifted.append(UNITS * pose_errors(touching[None], own.after[k : k + 1])[0])
                pair_unshifted.append(error[0])
        shifted.append(np.array(pair_shifted))
        unshifted.append(np.array(pair_unshifted))
    record: dict[str, Any] = {
        "by grip of the finger": {name: group(values) for name, values in grips.items()},
        "by distance of the push from the centre over the gyration": {
            name: group(values) for name, values in arms.items()
        },
        "correlation of displacement errors with the published simulator's": float(
            np.corrcoef(np.concatenate(own_gaps).ravel(), np.concatenate(other_gaps).ravel())[0, 1]
        ),
        "distance of the finger from the outline at the start [mm]": {
            "5, 25, 50, 75, 95 %": np.quantile(starts, [0.05, 0.25, 0.5, 0.75, 0.95]).tolist(),
            "standard deviation": float(np.std(starts)),
        },
        "paths shifted so that they touch": {
            "pushes": sum(map(len, shifted)),
            **{k: v.tolist() for k, v in vars(bootstrapped(shifted)).items()},
            "as recorded": bootstrapped(unshifted).mean.tolist(),
            "change": {
                k: v.tolist()
                for k, v in vars(
                    bootstrapped([a - b for a, b in zip(shifted, unshifted, strict=True)])
                ).items()
            },
        },
    }
    text_written(options.out, json.dumps(json.loads(json_text(record)), indent=1) + "\n")


if __name__ == "__main__":
    main()
