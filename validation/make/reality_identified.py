"""mu_omega / mu_v of all pairs in each cone: ``python -m validation.make.reality_identified``.

Loads are read, and no pushes.
"""

import numpy as np

from quasistatic_ref.lab.folders import reality_folder
from quasistatic_ref.lab.reality.identify import identified_ratio
from quasistatic_ref.lab.reality.loads import Loads, loads_read
from quasistatic_ref.lab.reality.pairs import pairs_read
from quasistatic_ref.lab.reality.report import identified_record
from validation.tools.scripts import RESULTS, record_written, script_options

OUT = RESULTS / "reality_identified.json"
CONES = ("ellipsoid", "pyramid", "product", "facets-8", "facets-16")


def best_axes(loads: Loads, rho: float) -> float:
    """The least lost share of the pyramid over angles of its axes in the object's frame [-]."""
    angles = np.radians([0.0, 15.0, 30.0, 45.0, 60.0, 75.0])
    found = [identified_ratio(loads.turned(float(angle)), rho, "pyramid") for angle in angles]
    return min(own.misfit for own in found if own is not None)


def main() -> None:
    """Identify, and write the summary."""
    options = script_options(__doc__, out=OUT)
    folder = reality_folder()
    pairs = pairs_read(folder)
    loads = loads_read(folder, pairs)
    record = {
        pair.name: {
            "published": pair.published,
            "uniform": pair.outline.mean_distance,
            "gyration": pair.outline.gyration,
            "mu_finger": pair.mu_finger,
            "pyramid, best axes": best_axes(loads[pair.name], pair.outline.gyration),
            "cones": {
                cone: identified_record(
                    identified_ratio(loads[pair.name], pair.outline.gyration, cone)
                )
                for cone in CONES
            },
        }
        for pair in pairs
    }
    record_written(options.out, record)


if __name__ == "__main__":
    main()
