"""Contact forces by compliance: one answer, whatever should not matter.

Run ``python -m validation.make.forces`` (some hours; ``--random``, ``--oracle`` and ``--every``
make it shorter). Records are kept with ``--log``, and a run that was stopped goes on from them. On
random degenerate steps (duplicated contacts, penetration, coefficients of 0, masses 1e9 apart; one
polyhedral cone after the other), on the steps of the vectors and on those of all scenarios:

- every backend and none, plain and fast, cold, and contacts in another order give equal bits;
- so does the definition, in which what each contact gives way by is solved for, too;
- so do fractions, by which the optimum is proved (tests/oracles/compliant_forces.py; the pyramid);
- noise of 1e-17 in phi and J changes forces by less than 1e-6 of the load (of steps under 1 m).

Exit status 1 if anything of this fails.
"""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.certify.compliance.forces import WRENCH, contact_forces, defined_optimum
from quasistatic_ref.certify.exact import step_optimum
from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.parallel import Log
from quasistatic_ref.lab.scenes.contacts import repeated
from quasistatic_ref.lab.vectors.files import expected_read, inputs_read
from quasistatic_ref.lab.vectors.own.step import posed_case
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import COMPLIANCE
from tests.oracles.compliant_forces import forces as independent_forces
from tests.oracles.random_steps import mixed_step
from validation.tools.scripts import ROOT, asked, shown

VECTORS = ROOT / "validation" / "vectors"
BACKENDS = ("clarabel", "osqp", "piqp", "daqp", "scs", "none")
CONES = (PYRAMID, "product", "facets-6", "frictionless")
CHECKS = ("backends", "fast", "cold", "permuted", "definition", "independent", "noise")
NOISE = 1e-17
CHANGE = 1e-6
"""Largest change by the noise, of the sum of the normal forces and of what the step weighs."""
FAR = 1.0
"""Displacement [m, rad] from which no noise is added. Noise in J counts in proportion to it: where
masses are 1e9 apart, steps of 1e5 m are drawn, and 1e-17 of them over the compliance is 1e-3 N."""
Record = dict[str, Any]


def differences(step: StepData, oracle: bool) -> Record:
    """Of each check 1 if it fails and 0 if it holds; a check that was not made is not there."""
    first = solve_step(step, "none")
    forces = first.forces
    k = step.contacts
    bits = forces.tobytes()
    order = np.random.default_rng(0).permutation(k.n_c)
    moved = contact_forces(step.replace(contacts=repeated(k, order))).wrench
    others = [solve_step(step, name).forces.tobytes() for name in BACKENDS[:-1]]
    held = {
        "backends": set(others) == {bits},
        "fast": solve_step(step, "daqp", fast=True).forces.tobytes() == bits,
        "cold": contact_forces(step).wrench.tobytes() == bits,
        "permuted": moved.tobytes() == forces[order].tobytes(),
        "definition": defined_optimum(step, COMPLIANCE)[0][:, WRENCH].tobytes() == bits,
    }
    if np.abs(first.delta_q).max(initial=0.0) < FAR:
        held["noise"] = noise_of_rounding(step, first) < CHANGE
    if oracle and step.cone == PYRAMID and not step.extra.names:
        held["independent"] = independent_forces(step, COMPLIANCE).tobytes() == bits
    return {name: int(not holds) for name, holds in held.items()}


def noise_of_rounding(step: StepData, clean: StepSolution) -> float:
    """The largest change of a force by noise in phi and J, relative to the load of the step.

    A contact that moves with nothing may contradict the noise; it gives way all the same.
    """
    rng = np.random.default_rng(1)
    k = step.contacts
    forces = clean.forces
    phi = k.phi + NOISE * rng.standard_normal(k.phi.shape)
    J = k.J + NOISE * rng.standard_normal(k.J.shape)
    everyone = range(k.n_c)
    moved = step.replace(contacts=repeated(k, everyone, phi=phi, J=J))
    noisy = contact_forces(moved, near=(clean.delta_q, clean.wrench)).wrench
    load = np.abs(forces).sum() + np.abs(step.tau_u).sum() + np.abs(step.tau_a).sum()
    return float(np.abs(noisy - forces).max(initial=0.0) / max(load, 1.0))


def random_steps(count: int) -> Iterator[tuple[str, StepData]]:
    """The first random steps that have a solution."""
    seed = found = 0
    while found < count:
        step = mixed_step(seed).replace(cone=CONES[seed % len(CONES)])
        seed += 1
        try:
            step_optimum(step)
        except QuasistaticError:
            continue
        found += 1
        yield f"random {seed - 1}", step


def vector_steps() -> Iterator[tuple[str, StepData]]:
    """Those of the layer `step` of the vectors that have a solution."""
    solved = expected_read(VECTORS, "step")
    for case in inputs_read(VECTORS, "step"):
        if "farkas" not in solved[case.id]["output"]:
            yield case.id, posed_case(case.input).step


def scenario_steps(every: int) -> Iterator[tuple[str, StepData]]:
    """Steps of all scenarios in models/, every so many."""
    for folder in sorted(path for path in (ROOT / "models").iterdir() if path.is_dir()):
        run = load_scenario(folder.name, fast=True, record="full").run(progress=False)
        for k in range(0, run.steps, every):
            yield f"{folder.name} {k}", run.step_data(k)


def main() -> int:
    """Write the table; exit status 1 if anything fails."""
    given = asked(__doc__, random=2000, oracle=300, every=1, log=Path, out=Path)
    log = Log(given.log, lambda record: record["step"])
    families = {
        "random": random_steps(given.random),
        "vectors": vector_steps(),
        "scenarios": scenario_steps(given.every),
    }
    rows = []
    failed = 0
    for family, steps in families.items():
        found = []
        for i, (name, step) in enumerate(steps):
            if name not in log.found:
                log.add(
                    {"step": name, **differences(step, family == "random" and i < 4 * given.oracle)}
                )
            found.append(log.found[name])
        made = [sum(check in one for one in found) for check in CHECKS]
        fails = [sum(one.get(check, 0) for one in found) for check in CHECKS]
        failed += sum(fails)
        cells = [f"{bad} of {all_}" for bad, all_ in zip(fails, made, strict=True)]
        rows.append([family, len(found), *cells])
    lines = [
        "# Forces of single contacts",
        "",
        "Steps on which a check fails, of those on which it is made; `validation/make/forces.py` "
        f"says which checks these are. Backends: {', '.join(BACKENDS)}.",
        "",
        *markdown_table(["steps", "number", *CHECKS], rows, 1),
    ]
    shown("\n".join(lines), given.out)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
