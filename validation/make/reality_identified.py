"""mu_omega / mu_v of all pairs in the ellipsoid: ``python -m validation.make.reality_identified``.

Loads are read, and no pushes. Each ratio has its 95 % interval, by a bootstrap over the loads.
"""

import numpy as np
from scipy.stats import bootstrap

from quasistatic_ref.lab.reality.identify import cosines, identified_ratio
from quasistatic_ref.lab.reality.measurements import Loads, loads_read, pairs_read
from quasistatic_ref.numbers.arrays import Array
from validation.tools.scripts import RESULTS, record_written, script_options

OUT = RESULTS / "reality_identified.json"


def interval(loads: Loads, ratio: float, rho: float) -> tuple[float, float]:
    """The ends of the interval of a ratio [m], on a grid of steps of a third of a per cent."""
    grid = ratio * np.geomspace(0.5, 2.0, 401)
    table = np.array([cosines(loads, chi, rho) for chi in grid])

    def best(rows: Array) -> float:
        return float(grid[table[:, rows].sum(axis=1).argmax()])

    drawn = bootstrap((np.arange(len(loads.wrench)),), best, n_resamples=1000, vectorized=False,
                      method="percentile", rng=0)  # fmt: skip
    return float(drawn.confidence_interval.low), float(drawn.confidence_interval.high)


def main() -> None:
    """Identify, and write the summary."""
    options = script_options(__doc__, out=OUT)
    pairs = pairs_read()
    record = {}
    for pair in pairs:
        loads = loads_read([pair])[pair.name]
        rho = pair.outline.gyration
        ratio = identified_ratio(loads, rho)
        low, high = interval(loads, ratio, rho)
        record[pair.name] = {
            "published": pair.published, "uniform": pair.outline.mean_distance, "gyration": rho,
            "mu_finger": pair.mu_finger, "count": len(loads.wrench), "ratio": ratio,
            "low": low, "high": high,
        }  # fmt: skip
    record_written(options.out, record)


if __name__ == "__main__":
    main()
