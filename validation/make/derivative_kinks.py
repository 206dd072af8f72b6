"""Verdicts of derivatives at constructed kinks, and numbers near them.

``python -m validation.make.derivative_kinks --kinks 528``. Each kink is built where nothing but its
construction says that there is one, and turned at random; the verdict must have its name and the
contacts that it is about. Differences of steps without rounding show the kink too: slopes along a
random direction differ on its two sides. At seven distances from it, either there is a verdict or
the numbers are right. With ``--log FILE`` a run can be stopped and goes on where it was. Exit
status 1 if a verdict is wrong, or a number without one.
"""

import argparse
import sys
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.formats.files import text_written
from quasistatic_ref.optional.derivatives.derivatives import derivatives
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.step.data import Array
from tests.oracles.gradients.log import Record, logged
from tests.oracles.gradients.placing import Kink, Rng, unit_vector
from tests.oracles.gradients.reference import reference, slope, tied_pairs
from tests.oracles.gradients.row_kinks import ROWS
from tests.oracles.gradients.shape_kinks import SHAPES
from tests.oracles.gradients.states import State, table_of, whole_state
from tests.oracles.gradients.tie_kinks import TIES

FAMILIES: Final[tuple[Callable[[Rng], Kink], ...]] = (*ROWS, *TIES, *SHAPES)
ASIDE: Final = 1e-7
"""How far on both sides of a kink slopes are taken [m or rad]."""
BENDS: Final = 1e-4
"""Difference of slopes, relative to the larger, that shows a kink: of smooth steps ASIDE."""
TRIES: Final = 4
"""Directions along which a kink is looked for."""
NEAR: Final = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
"""Distances from the kink at which numbers are compared [m or rad]."""
WITHIN: Final = 1e-9
"""Largest difference that is promised, relative to the largest entry of the same derivative."""
UNSEEN: Final = (reason.ZERO_FRICTION, reason.HALF_TURN)
"""Kinks by what they are, which no motion of q shows."""


def kink(i: int) -> Kink:
    """The i-th kink."""
    return FAMILIES[i % len(FAMILIES)](np.random.default_rng([21, i]))


def record(i: int, *, nearby: bool = True) -> Record:
    """What the package says of the i-th kink, and whether it is right; and near it."""
    one, rng = kink(i), np.random.default_rng([22, i])
    found = derivatives(one.simulator, one.q, one.q_bar_a, one.force)
    kinds = {why.kind for why in found.reasons}
    named = {name for why in found.reasons if why.kind == one.kind for name in why.where}
    named |= {name.rpartition("/")[0] for name in named}
    right = one.kind in kinds and kinds <= one.also | {one.kind} and one.where <= named
    right &= not found.differentiable
    said: Record = {"i": i, "kind": one.kind, "what": one.what, "kinds": sorted(kinds)}
    said |= {"right": bool(right), "shown": None, "near": []}
    if nearby and one.kind not in UNSEEN:
        said["shown"] = _shown(one, rng)
        e = unit_vector(rng, len(one.force))
        said["near"] = [[r, *_near(one, r * e, rng)] for r in NEAR]
    return said


def _state(one: Kink, way: Array) -> State:
    q = one.simulator.system.integrate(one.q, way)
    table = table_of(one.simulator)
    return whole_state("kink", one.what, one.simulator, table, q, one.q_bar_a, one.force)


def _shown(one: Kink, rng: Rng) -> bool:
    """Whether slopes differ on both sides, or contacts are tied without rounding."""
    try:
        if one.kind == reason.POINTS and tied_pairs(reference(_state(one, 0 * one.force))):
            return True
        for _ in range(TRIES):
            e = unit_vector(rng, len(one.force))
            ahead, behind = (
                slope(reference(_state(one, side * ASIDE * e)), "dq_dq", e)[0] for side in (1, -1)
            )
            size = max(np.abs(ahead).max(), np.abs(behind).max())
            if np.abs(ahead - behind).max() > BENDS * size:
                return True
    except (QuasistaticError, ArithmeticError, IndexError):
        return False
    return False


def _near(one: Kink, way: Array, rng: Rng) -> tuple[str, float | None, float]:
    """Near a kink: verdict or numbers; how wrong they are, relative; their largest entry."""
    state = _state(one, way)
    try:
        found = derivatives(state.simulator, state.q, state.q_bar_a, state.force)
        if any("dq_dq" in why.fields for why in found.reasons):
            return "verdict", None, 0.0
        e = unit_vector(rng, len(way))
        there, smooth = slope(reference(state), "dq_dq", e)
    except (QuasistaticError, ArithmeticError, IndexError) as failure:
        return f"none: {failure}"[:120], None, 0.0
    size = float(np.abs(found.dq_dq).max())
    wrong = float(np.abs(found.dq_dq @ e - there).max()) / size
    return ("numbers" if smooth else "kink"), wrong, size


def faults(one: Record) -> list[str]:
    """What is wrong about a record."""
    said = [] if one["right"] else [f"the verdict is {one['kinds']}"]
    for distance, what, wrong, _ in one["near"]:
        if what == "kink" or (wrong is not None and wrong > WITHIN):
            said.append(f"{distance:g} from it {what}, wrong by {wrong:.1e}")
    return said


def page(found: list[Record]) -> str:
    """The tables as Markdown."""
    groups: dict[tuple[str, str], list[Record]] = defaultdict(list)
    for one in found:
        groups[one["kind"], FAMILIES[one["i"] % len(FAMILIES)].__doc__ or ""].append(one)
    rows = [
        f"| {kind} | {what.rstrip('.')} | {len(some)} | {sum(one['right'] for one in some)} | "
        f"{'' if kind in UNSEEN else sum(one['shown'] for one in some)} |"
        for (kind, what), some in sorted(groups.items())
    ]
    right, shown = (sum(bool(one[key]) for one in found) for key in ("right", "shown"))
    seen = sum(one["kind"] not in UNSEEN for one in found)
    lines = [
        "# Verdicts at constructed kinks, and numbers near them",
        "",
        f"`python -m validation.make.derivative_kinks --kinks {len(found)}`. {len(found)} kinks; "
        f"in {right} the verdict has the right name and the right contacts. Of {seen} that a "
        f"motion of q shows, the slopes of steps without rounding differ on both sides, or "
        f"candidates are tied, in {shown}.",
        "",
        "| verdict | construction | tried | right | shown |",
        "|---|---|---|---|---|",
        *rows,
        "",
        "At a distance from the kink along a random direction [m or rad]: verdicts given, and of "
        "the others how wrong dq_dq is along a random direction, relative to its largest entry. "
        f"Promised is {WITHIN:g}.",
        "",
        "| distance | verdicts | numbers | median error | worst | worst, entries below 1e3 |",
        "|---|---|---|---|---|---|",
        *(_beside(found, k) for k in range(len(NEAR))),
    ]
    return "\n".join(lines) + "\n"


def _beside(found: list[Record], k: int) -> str:
    every = [one["near"][k] for one in found if one["near"]]
    errors = [(wrong, size) for _, what, wrong, size in every if what == "numbers"]
    tame = max((wrong for wrong, size in errors if size < 1e3), default=0.0)
    verdicts = sum(what == "verdict" for _, what, _, _ in every)
    median, worst = np.median([w for w, _ in errors]), max(w for w, _ in errors)
    return f"| {NEAR[k]:g} | {verdicts} | {len(errors)} | {median:.0e} | {worst:.0e} | {tame:.0e} |"


def main(arguments: list[str] | None = None) -> int:
    """Write the tables; 1 if a promise does not hold."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kinks", type=int, default=22 * len(FAMILIES))
    parser.add_argument("--log", type=Path)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args(arguments)
    found = list(map(logged(record, options.log), range(options.kinks)))
    bad = [(one, said) for one in found if (said := faults(one))]
    for one, said in bad:
        print(f"kink {one['i']}, {one['what']} ({one['kind']}): {said}", file=sys.stderr)
    text = page(found)
    if options.out is None:
        print(text, end="")
    else:
        text_written(options.out, text)
    return int(bool(bad))


if __name__ == "__main__":
    sys.exit(main())
