"""Artifacts of the model where they change what happens: drag, boundary layer, corners.

Each is measured by what it changes in documented steps of a run
(:mod:`~quasistatic_ref.optional.doctor.compared`). Of bodies that are not in equilibrium in a step
nothing else is said of that step: of another, in which their contacts bear them, it is.
"""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.formats.quoting import listed
from quasistatic_ref.optional.doctor.compared import LookedAt, PairMotion
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import SHORT
from quasistatic_ref.optional.doctor.unsupported import falls
from quasistatic_ref.simulate.finding import Finding

COUNTS = 0.1
"""Least difference that counts, over the larger of two numbers [-]."""
DISTANCE = "the step shows where to, not how far"


def out_of_balance(run: Run) -> Iterator[Finding]:
    """Free bodies whose loads no forces in the cones of their contacts bear.

    A body that falls until the end because its contacts bear nothing is in free fall.
    """
    falling = falls(run)
    for name, missing in run.compared.unbalanced.items():
        weight = run.system.mass(name) * run.g
        if name in falling and missing.force >= (1 - COUNTS) * weight:
            continue
        yield Finding(
            "not in equilibrium",
            False,
            f"give {name} what holds it, or do not read how far it moves",
            f"it is not in equilibrium: {missing} are missing in step {missing.k}; {DISTANCE}",
            {"missing_N": missing.force, "missing_Nm": missing.torque, "step": missing.k},
        )


def corners(run: Run) -> Iterator[Finding]:
    """Bodies and pairs that slip in the corners of the pyramid, and not in the ellipsoid.

    Of a pair that does not slip without its drag either, the drag is said: speed comes first.
    """
    names = run.compared.held_in_ellipsoid
    if names:
        k = min(names.values())
        is_not = "is not" if len(names) == 1 else "are not"
        yield Finding(
            "corners of the cone",
            False,
            'set cone = "ellipsoid"',
            f"{listed([*names])} {is_not} in equilibrium in the {run.simulator.cone} in step {k}, "
            "but in the ellipsoid, whose friction is the same in all directions",
            {"step": k},
        )
        return
    for at in run.compared.steps:
        if not at.slips_inside:
            continue
        for i, here, there in _pairs(run, at, at.in_ellipsoid):
            pair = run.pairs[i]
            slow = at.without_drag
            by_drag = slow is not None and _slips_more(at, i, here, slow[i])
            if _slips_more(at, i, here, there) and not by_drag:
                yield Finding(
                    "corners of the cone",
                    False,
                    'set cone = "ellipsoid"',
                    f"{pair.name} {_slip(at, i, here, there)} in the ellipsoid, in step {at.k}",
                    {"slip_mm": 1e3 * here.way, "ellipsoid_mm": 1e3 * there.way, "step": at.k},
                )
                return


def drag(run: Run) -> Iterator[Finding]:
    """The pair whose force or slip changes most where bodies have a sixteenth of their drag."""
    worst: tuple[float, Finding] | None = None
    for at in run.compared.steps:
        for i, here, there in _pairs(run, at, at.without_drag):
            pair = run.pairs[i]
            change = _relative(here.normal, there.normal, run.light)
            slips = _slips_more(at, i, here, there)  # not less: loads move a lighter body farther
            if not (change > COUNTS or slips):
                continue
            does = f"{here.normal:.3g} N, without it {there.normal:.3g} N"
            if slips:
                does = f"it {_slip(at, i, here, there)} without it"
            finding = Finding(
                "drag",
                False,
                "move more slowly, or take a larger h",
                f"the drag m v / h of the step counts in {pair.name}: {does}, in step {at.k}",
                {"normal_N": here.normal, "without_drag_N": there.normal, "step": at.k},
            )
            amount = 1.0 if slips else change
            if worst is None or amount > worst[0]:
                worst = (amount, finding)
    if worst:
        yield worst[1]


def layer(run: Run) -> Iterator[Finding]:
    """The pair whose force or slip is most unlike that of Coulomb's law.

    Steps in which that law reaches no fixed point are counted, and say nothing.
    """
    worst: tuple[float, Finding] | None = None
    unsettled = sum(at.by_coulomb is None for at in run.compared.steps)
    for at in run.compared.steps:
        for i, here, there in _pairs(run, at, at.by_coulomb):
            pair = run.pairs[i]
            change = _relative(here.normal, there.normal, max(run.light, at.comes_down(pair)))
            way = _relative_way(at, i, here, there)
            if max(change, way) <= COUNTS:
                continue
            does = f"presses with {here.normal:.3g} N, where Coulomb's law allows "
            does += f"{there.normal:.3g} N"
            if way > change:
                does = f"slips by {1e3 * here.way:.3g} mm, where Coulomb's law allows "
                does += f"{1e3 * round(there.way, 9):.3g} mm"
            finding = Finding(
                "boundary layer",
                False,
                'move more slowly, take a smaller h, or set law = "coulomb"',
                f"{pair.name} {does}, in step {at.k}: what slides rises by mu_v h v, against what "
                "presses it",
                {
                    "normal_N": here.normal,
                    "coulomb_N": there.normal,
                    "slip_mm": 1e3 * here.way,
                    "coulomb_mm": 1e3 * there.way,
                    "steps_without_fixed_point": unsettled,
                    "step": at.k,
                },
            )
            if worst is None or max(change, way) > worst[0]:
                worst = (max(change, way), finding)
    if worst:
        yield worst[1]


def _pairs(
    run: Run, at: LookedAt, changed: list[PairMotion] | None
) -> Iterator[tuple[int, PairMotion, PairMotion]]:
    """Pairs whose bodies are in equilibrium: number, what they do in the run, and when changed.

    Those are left out that press with less than a tenth of the largest force of the step: a pair
    that comes to touch, or ceases to, does so a step earlier or later.
    """
    if changed is None:
        return
    largest = max((pair.normal for pair in at.as_it_is), default=0.0)
    for i, (here, there) in enumerate(zip(at.as_it_is, changed, strict=True)):
        bears = max(here.normal, there.normal) >= COUNTS * largest
        if bears and not run.bodies(run.pairs[i]) & at.moved.keys():
            yield i, here, there


def _relative(a: float, b: float, nothing: float) -> float:
    """Difference of two forces over the larger [-]; 0 where it is `nothing` [N]."""
    return abs(a - b) / max(a, b) if abs(a - b) > nothing else 0.0


def _relative_way(at: LookedAt, i: int, a: PairMotion, b: PairMotion) -> float:
    """Largest difference of slips over the larger [-].

    It is 0 without friction or motion, and for what comes down from its layer.
    """
    off = float(np.linalg.norm(a.slip - b.slip, axis=1).max(initial=0.0))
    if at.run.pairs[i].mu_v == 0 or off <= max(at.run.shortest[i], 2 * at.floats):
        return 0.0
    return off / max(a.way, b.way)


def _slips_more(at: LookedAt, i: int, a: PairMotion, b: PairMotion) -> bool:
    """Whether a pair with friction slips or spins in the first of two answers alone."""
    pair = at.run.pairs[i]
    turns = pair.rows == 6 and pair.mu_omega > 0
    spins = turns and a.spin > SHORT and b.spin < COUNTS * a.spin
    return spins or (pair.mu_v > 0 and _farther(at, i, a, b))


def _farther(at: LookedAt, i: int, a: PairMotion, b: PairMotion) -> bool:
    return bool(a.way > at.run.shortest[i] and b.way < COUNTS * a.way)


def _slip(at: LookedAt, i: int, a: PairMotion, b: PairMotion) -> str:
    """How far a pair slips or spins in the first of two answers, and in the second."""
    if _farther(at, i, a, b):
        there = f"by {1e3 * b.way:.2g} mm" if b.way > at.run.shortest[i] else "not"
        return f"slips by {1e3 * a.way:.2g} mm, and {there}"
    there = f"by {np.degrees(b.spin):.2g} degrees" if b.spin > SHORT else "not"
    return f"turns by {np.degrees(a.spin):.2g} degrees, and {there}"
