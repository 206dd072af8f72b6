"""What the prediction of measured pushes depends on.

Run ``python -m validation.make.reality_ablations``.

Every tenth push (``--every``) of each pair is predicted with one thing changed at a time. Rows are
kept in the folder ``--work``, so that a run that was ended goes on; the summary has the mean errors
and, push by push, the change against the base, each with its 95 % interval.
"""

from collections import Counter
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.lab.folders import reality_folder
from quasistatic_ref.lab.reality.errors import bootstrap_estimate, errors_of
from quasistatic_ref.lab.reality.identify import identified_ratio
from quasistatic_ref.lab.reality.loads import loads_read
from quasistatic_ref.lab.reality.pairs import pairs_read
from quasistatic_ref.lab.reality.predictions import poses, predicted_pushes
from quasistatic_ref.lab.reality.pushes import pushes_read
from quasistatic_ref.lab.reality.settings import Settings
from validation.tools.scripts import RESULTS, record_written, script_options

OUT = RESULTS / "reality_ablations.json"
PYRAMID = {"cone": "pyramid"}
QUICK = {"certify": "residual"}
TIES = {
    "torque to the left": (0.0, 0.0, 0.01),
    "torque to the right": (0.0, 0.0, -0.01),
    "force along x": (0.01, 0.0, 0.0),
    "force along y": (0.0, 0.01, 0.0),
}
"""What breaks ties: a hundredth of friction."""

VARIANTS = {
    "ellipsoid": {},
    "pyramid, axes at 0 degrees": PYRAMID,
    "pyramid, axes at 22.5 degrees": PYRAMID | {"axes": 22.5},
    "pyramid, axes at 45 degrees": PYRAMID | {"axes": 45.0},
    "product": {"cone": "product"},
    "facets-8": {"cone": "facets-8"},
    "facets-16": {"cone": "facets-16"},
    "no torsion": {"torsion": 0.0},
    "half of the torsion": {"torsion": 0.5},
    "pyramid, ratio identified for it": PYRAMID | {"ratio": "pyramid"},
    "product, ratio identified for it": {"cone": "product", "ratio": "product"},
    "facets-16, ratio identified for it": {"cone": "facets-16", "ratio": "facets-16"},
    **{f"pyramid, tie broken by a {name}": PYRAMID | {"nudge": n} for name, n in TIES.items()},
    "pyramid, tie broken by gyration 4 mm": PYRAMID | {"gyration": 0.004},
    "9 points": QUICK | {"points": 9},
    "25 points": QUICK | {"points": 25},
    "steps of 2 mm": QUICK | {"advance": 2e-3},
    "steps of 0.5 mm": QUICK | {"advance": 5e-4},
    "mass 10 kg": QUICK | {"m": 10.0},
    "h 0.2 s": QUICK | {"h": 0.2},
    "h 2 s": QUICK | {"h": 2.0},
    "mu_v 0.15": QUICK | {"mu_v": 0.15},
    "mu_v 0.6": QUICK | {"mu_v": 0.6},
    "gyration 20 mm": QUICK | {"gyration": 0.02},
    "finger's stiffness 1e5 N/m": QUICK | {"stiffness": 1e5},
    "finger's friction fitted": QUICK | {"finger": "fitted"},
    "finger's friction 0.15": QUICK | {"finger": "0.15"},
    "finger's friction 0.35": QUICK | {"finger": "0.35"},
    "ratio published": QUICK | {"ratio": "published"},
    "ratio reverse": QUICK | {"ratio": "reverse"},
    "twice the torsion": QUICK | {"torsion": 2.0},
    "steps of 0.25 mm": QUICK | {"advance": 2.5e-4},
    "100 points": QUICK | {"points": 100},
}
"""Name -> what differs from the base: fields of Settings, the ratios, how steps are certified."""


def predictions(every: int, work: Path, jobs: int) -> Iterator[tuple[str, dict[str, Any]]]:
    """Name and summary of each variant, on every so manyth push."""
    folder = reality_folder()
    pairs = pairs_read(folder)
    loads = loads_read(folder, pairs)
    pushes = {name: own.every(every) for name, own in pushes_read(folder, pairs).items()}
    base = {}
    for name, changes in VARIANTS.items():
        own = dict(changes)
        source = own.pop("ratio", "ellipsoid")
        certify = own.pop("certify", "full")
        ratios = {}
        for pair in pairs:
            cone = source if source not in ("published", "reverse") else "ellipsoid"
            found = identified_ratio(loads[pair.name], pair.outline.gyration, cone)
            other = {"published": pair.published, "reverse": found.reverse}
            ratios[pair.name] = other.get(source, found.ratio)
        file = work / f"{name.replace(' ', '_').replace('/', '_per_')}.jsonl"
        rows = predicted_pushes(pairs, pushes, ratios, Settings(**own), file, jobs=jobs,
                                certify=certify, progress=False)  # fmt: skip
        errors = [errors_of(poses(rows[pair.name]), pushes[pair.name]) for pair in pairs]
        if not base:
            base = {pair.name: e.model for pair, e in zip(pairs, errors, strict=True)}
        kinds = Counter()
        for row in chain(*rows.values()):
            kinds.update(row["steps"])
        more = [e.model - base[pair.name] for pair, e in zip(pairs, errors, strict=True)]
        yield (
            name,
            {
                "pushes": sum(len(e.model) for e in errors),
                "steps": kinds,
                "error": plain(bootstrap_estimate([e.model for e in errors])),
                "more": plain(bootstrap_estimate(more)),
                "poses": np.concatenate([poses(rows[pair.name]) for pair in pairs]),
            },
        )


def plain(estimate: Any) -> dict[str, list[float]]:
    """An estimate with four digits."""
    return {key: [float(f"{x:.4g}") for x in value] for key, value in vars(estimate).items()}


def pose_spread(found: dict[str, dict[str, Any]], names: list[str]) -> dict[str, float]:
    """How far final poses of the same push lie apart, over variants that break ties otherwise."""
    ends = np.array([found[name]["poses"] for name in names])
    across = ends.max(0) - ends.min(0)
    way = np.hypot(across[:, 0], across[:, 1])
    return {
        "median [mm]": float(1e3 * np.median(way)),
        "95th percentile [mm]": float(1e3 * np.quantile(way, 0.95)),
        "median [deg]": float(np.degrees(np.median(across[:, 2]))),
        "95th percentile [deg]": float(np.degrees(np.quantile(across[:, 2], 0.95))),
    }


def summary(found: dict[str, dict[str, Any]], every: int) -> dict[str, Any]:
    """What the variants so far came to, as plain data."""
    ties = [name for name in found if name.startswith("pyramid, tie")]
    shown = {n: {k: v for k, v in e.items() if k != "poses"} for n, e in found.items()}
    record = {"every": every, "variants": shown}
    if ties:
        among = ["pyramid, axes at 0 degrees", *ties]
        record["spread over the pyramid's ties"] = pose_spread(found, among) | {"among": len(among)}
    return record


def main() -> None:
    """Predict what is left, and write the summary."""
    options = script_options(__doc__, work=Path("reality_work"), every=10, jobs=2, out=OUT)
    found = {}
    for name, entry in predictions(options.every, options.work, options.jobs):
        found[name] = entry
        mean = entry["error"]["mean"]
        print(f"{name}: {mean[0]:.2f} mm, {mean[1]:.2f} deg, {entry['steps']}", flush=True)
        record_written(options.out, summary(found, options.every))


if __name__ == "__main__":
    main()
