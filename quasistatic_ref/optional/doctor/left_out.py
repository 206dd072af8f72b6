"""Points that the k nearest leave out though they matter, and points that come and go."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from quasistatic_ref.contact.distance import closest_points
from quasistatic_ref.contact.jacobian import ContactGeometry
from quasistatic_ref.contact.pairs import contact_layout
from quasistatic_ref.errors import ContactError
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import least, more_points, slices
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.tolerances import BEARS, SUNK

DEEP = SUNK / 100
"""Depth [-], relative to a pair's smaller shape, of a point left out that would have borne."""
EXCHANGES = 3
"""How often points come and go before it is said: now and then they do where a body rolls."""


def border(run: Run) -> Iterator[Finding]:
    """Pairs whose next nearest point is in the other body after the last step."""
    n_c = run["phi"].shape[1]
    f_n = run.forces(run.steps - 1)[:, 2]
    loaded = f_n > BEARS * f_n.max(initial=0.0)
    wider = {
        pair.name: replace(pair, k=pair.n_c + 1)
        for pair, own in slices(run.pairs)
        if pair.n_c < pair.candidates and loaded[own].all()
    }
    if not (n_c and wider):
        return
    kinematics = run.system.kinematics(run["q"][-2])
    for pair in wider.values():
        try:
            points = closest_points([pair], kinematics)
        except ContactError:
            return
        geometry = ContactGeometry(contact_layout([pair]), run.system.column_map)
        contacts = geometry.contacts(points, kinematics)
        gap = points.phi + np.vecdot(points.n, contacts.motion(run["delta_q"][-1])[:, :3])
        if gap[-1] < -DEEP * least(pair):
            yield Finding(
                "border of k",
                False,
                more_points(run, pair),
                f"all {pair.k - 1} contacts of {pair.name} bear load in the last step, and point "
                f"{points.point[-1]}, the next nearest, ends {-1e6 * gap[-1]:.3g} um deep",
                {"depth_um": -1e6 * float(gap[-1])},
            )


def exchanged(run: Run) -> Iterator[Finding]:
    """Pairs that bear load and whose nearest points change from step to step and back."""
    for pair, own in slices(run.pairs):
        kept = np.sort(run["point"][:, own], axis=1)
        changed = (kept[1:] != kept[:-1]).any(axis=1)
        back = (kept[2:] == kept[:-2]).all(axis=1)
        bears = run["wrench"][2:, own, 2].any(axis=1)
        times = int((changed[1:] & back & bears).sum())
        if times >= EXCHANGES:
            yield Finding(
                "exchanged points",
                False,
                f"{more_points(run, pair)}, or take a smaller h",
                f"the nearest points of {pair.name} change and change back {times} times in "
                f"{run.steps} steps, and its forces with them",
                {"times": times, "steps": run.steps},
            )
