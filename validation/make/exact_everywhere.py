"""Every backend, and none, ends at the same bits, and `verify` holds them to the last place.

Run ``python -m validation.make.exact_everywhere`` (some twenty minutes on two cores; ``--every``
and ``--random`` make it shorter). On all steps of both bunny_grasp runs, of sphere_spin, and on
1,000 random steps that have an optimum (and all infeasible ones met on the way):

- delta_q, A'lam and the slacks have equal bits, whichever backend gave the warm start;
- `verify` accepts each certificate, and refuses it after any one entry of delta_q is moved by one
  unit in the last place, in either direction.

Prints a table, and exits with status 1 if anything of this fails.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from itertools import count, islice
from pathlib import Path

import numpy as np
from tqdm import tqdm

from quasistatic_ref.certify.certificate import verify
from quasistatic_ref.certify.exact import exact_step
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.certify.rows import flat_rows
from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.errors import StepIllPosed, StepInfeasible
from quasistatic_ref.lab.grasp import CASES
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import StepData
from tests.oracles.random_steps import mixed_step
from validation.tools.scripts import asked, shown

BACKENDS = ("clarabel", "osqp", "piqp", "daqp", NONE)
OPTIMAL, INFEASIBLE, ILL_POSED = "optimal", "infeasible", "ill-posed"


@dataclass
class Check:
    """What was found on one step.

    Parameters
    ----------
    kinds : set of str
        What the backends ended at: one kind, if they agree.
    faults : list of str
        Sentences; empty if all holds.
    certificates, refusals : int
        Different certificates that were accepted; moved answers that were refused.
    lost : list of str
        Backends that gave no warm start.
    digits : dict of str to float
        Correct digits of each backend's own answer.
    """

    kinds: set[str] = field(default_factory=set)
    faults: list[str] = field(default_factory=list)
    certificates: int = 0
    refusals: int = 0
    lost: list[str] = field(default_factory=list)
    digits: dict[str, float] = field(default_factory=dict)


def checked(step: StepData) -> Check:
    """Ask every backend, and compare all that they end at."""
    check = Check()
    bits: dict[bytes, str] = {}
    certificates: dict[tuple[tuple[int, int], ...], StepSolution] = {}
    for backend in BACKENDS:
        try:
            solution = solve_step(step, backend)
        except StepInfeasible as failure:
            check.kinds.add(INFEASIBLE)
            reason = farkas_refutation(step, failure.farkas.exact)
            check.faults += [f"{backend}: {reason}"] if reason else []
            continue
        except StepIllPosed as failure:
            check.kinds.add(ILL_POSED)
            bits.setdefault(failure.delta_q.tobytes(), backend)
            continue
        check.kinds.add(OPTIMAL)
        said = solution.statistics
        check.lost += [backend] if said.status.startswith("failed") else []
        check.digits |= {} if said.digits is None else {backend: said.digits}
        optimum = exact_step(step, flat_rows(step, solution.certificate.active))
        if optimum.delta_q.tobytes() != solution.delta_q.tobytes():
            check.faults.append(f"{backend}: its own working set leads to other bits")
        bits.setdefault(
            b"".join(part.tobytes() for part in (solution.delta_q, optimum.net, optimum.slack)),
            backend,
        )
        certificates.setdefault(solution.certificate.active, solution)
    if len(check.kinds) != 1:
        check.faults.append(f"backends end at different kinds: {sorted(check.kinds)}")
    if len(bits) > 1:
        check.faults.append(f"different bits first at {', '.join(bits.values())}")
    if not check.faults:
        for solution in certificates.values():
            _certificate_checked(step, solution, check)
    return check


def _certificate_checked(step: StepData, solution: StepSolution, check: Check) -> None:
    claims, lam = solution.certificate, np.concatenate([solution.lam, solution.lam_extra])
    verdict = verify(step, solution.delta_q, claims.active, lam, claims)
    if verdict:
        check.certificates += 1
    else:
        check.faults.append(f"{solution.backend} refused: {verdict.reason}")
    for v in range(step.n_v):
        for side in (-np.inf, np.inf):
            moved = solution.delta_q.copy()
            moved[v] = np.nextafter(moved[v], side)
            verdict = verify(step, moved, claims.active, lam, claims)
            if not verdict and f"delta_q[{v}]" in verdict.reason:
                check.refusals += 1
            else:
                check.faults.append(f"{solution.backend}: delta_q[{v}] towards {side} is accepted")


def run_steps(scenario: str, own: list[str], every: int) -> list[StepData]:
    """Steps of a run, all or every so many."""
    run = load_scenario(scenario, own, fast=True).run()
    return [run.step_data(k) for k in range(0, run.steps, every)]


def traits(step: StepData) -> Iterator[str]:
    """What is unusual about a random step."""
    c = step.contacts
    if len(np.unique(c.J, axis=0)) < c.n_c:
        yield "duplicated contacts"
    if (c.phi < 0).any():
        yield "phi < 0"
    if (c.mu_v == 0).any() or (c.mu_omega == 0).any():
        yield "a friction coefficient of 0"
    diagonals = [d for d in (np.diag(step.M_u), np.diag(step.K_q)) if d.size > 1]
    if any(d.max() / d.min() > 1e8 for d in diagonals):
        yield "masses or stiffnesses 1e9 apart"


def family_checked(
    name: str, steps: Iterator[StepData], wanted: int, pool: ProcessPoolExecutor
) -> tuple[str, int]:
    """Check steps until so many have an optimum: lines for the table, and the number of faults."""
    kinds: Counter[str] = Counter()
    lost: Counter[str] = Counter()
    met: Counter[str] = Counter()
    certificates = refusals = 0
    faults: list[str] = []
    least = dict.fromkeys(BACKENDS[:-1], 16.0)
    with tqdm(total=wanted, desc=name) as bar:
        while block := list(islice(steps, min(32, wanted - kinds[OPTIMAL]))):
            for step, check in zip(block, pool.map(checked, block), strict=True):
                faults += [f"{name}, step {kinds.total()}: {fault}" for fault in check.faults]
                kinds.update(check.kinds)
                lost.update(check.lost)
                met.update(traits(step))
                certificates += check.certificates
                refusals += check.refusals
                for backend, digits in check.digits.items():
                    least[backend] = min(least[backend], digits)
                bar.update(OPTIMAL in check.kinds)
    backends = ", ".join(f"{b} {d:.1f} ({lost[b]})" for b, d in least.items())
    lines = [
        f"{name}: " + ", ".join(f"{n} {kind}" for kind, n in sorted(kinds.items(), reverse=True)),
        f"  {certificates} different certificates accepted, {refusals} answers moved by one ulp "
        f"refused, {len(faults)} faults",
        f"  fewest correct digits of a backend's own answer (steps not solved): {backends}",
        *(["  with " + ", ".join(f"{t} {n}" for t, n in sorted(met.items()))] if met else []),
        *(f"  FAULT {fault}" for fault in faults[:10]),
    ]
    return "\n".join(lines), len(faults)


def main() -> int:
    """Print the table; exit status 1 if anything fails."""
    options = asked(__doc__, every=1, random=1000, out=Path)
    families: dict[str, Iterable[StepData]] = {
        f"bunny_grasp {case}": run_steps("bunny_grasp", own, options.every)
        for case, own in CASES.items()
    }
    families["sphere_spin"] = run_steps("sphere_spin", [], options.every)
    families[f"random, until {options.random} are optimal"] = map(mixed_step, count())
    report = [f"warm starts from {', '.join(BACKENDS[:-1])}, and from a cold start"]
    faults = 0
    with ProcessPoolExecutor(2) as pool:
        for name, steps in families.items():
            wanted = len(steps) if isinstance(steps, list) else options.random
            lines, found = family_checked(name, iter(steps), wanted, pool)
            report.append(lines)
            faults += found
    report.append("all bits equal" if not faults else f"{faults} faults")
    shown("\n".join(report), options.out)
    return int(faults > 0)


if __name__ == "__main__":
    sys.exit(main())
