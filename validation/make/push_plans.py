"""Pushes that are planned by gradient descent: ``python -m validation.make.push_plans --out FILE``.

The example `plan_a_push` from each of its starts, on a support that resists turning and on one that
does not; the settings are the same for all. Needs the extra `jax`, and takes half a minute a core.
Exits with status 1 if a plan that is executed leaves the block farther from its goal than it may,
or a step is not certified.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.examples.plan_a_push import ARM, KAPPAS, STARTS, STEPS, SUPPORTS, planned

MOST = (5.0, 5.0)
"""How far off a block may end [mm, deg]."""

PAGE = """# A block pushed to a pose by one finger

Written by `python -m validation.make.push_plans --out validation/results/push_plans.md`: {descent}
steps of gradient descent through {steps} smoothed steps, then the plan executed in exact steps. The
goal is at x = 150 mm, y = 0, angle 0.

| support | x [mm] | y [mm] | angle [deg] | off by [mm] | turned by [deg] | exact optima |
|---|---|---|---|---|---|---|
"""


def main() -> int:
    """Plan and execute all of them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    lines, good = [], True
    for support, mu_omega in SUPPORTS.items():
        for start in STARTS:
            push = planned(start, mu_omega)
            off = 1e3 * float(np.hypot(*push.left[:2]))
            turned = float(np.degrees(abs(push.left[2]) / ARM))
            good &= off <= MOST[0] and turned <= MOST[1] and push.certified == STEPS
            x, y, angle = 1e3 * start[0], 1e3 * start[1], np.degrees(start[2])
            where = f"{x:g} | {y:g} | {angle:.1f}"
            lines.append(f"| {support} | {where} | {off:.2f} | {turned:.2f} | {push.certified} |")
    page = PAGE.format(descent=len(KAPPAS), steps=STEPS) + "\n".join(lines) + "\n"
    print(page)
    if options.out:
        text_written(options.out, page)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
