"""Steps that follow on each other, in few calls, as long as C decides all of a step."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, overload

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.certify.arithmetic import check_arithmetic
from quasistatic_ref.certify.certificate import Certificate
from quasistatic_ref.certify.residuals import Residuals
from quasistatic_ref.certify.rows import contact_rows
from quasistatic_ref.certify.solution import SolverStatistics, StepSolution
from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.optional.fast.compiled.certificate import Prover, claims_of
from quasistatic_ref.optional.fast.compiled.library import library
from quasistatic_ref.optional.fast.compiled.natural import NaturalProgram
from quasistatic_ref.optional.fast.compiled.structure import Structure, address_of
from quasistatic_ref.optional.fast.posed import posed
from quasistatic_ref.optional.fast.rechecked import WHOLE, check, is_due
from quasistatic_ref.optional.fast.solver import FastSolver
from quasistatic_ref.optional.fast.sparse_solver import SparseSolver
from quasistatic_ref.simulate.recorder import SECONDS
from quasistatic_ref.simulate.result import StepArrays, StepResult, Steps
from quasistatic_ref.solve.solve import NOTHING_CLAIMED
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.step.arrays import read_only
from quasistatic_ref.step.data import Array, StepData

if TYPE_CHECKING:
    from quasistatic_ref.optional.fast.simulator import FastSimulator

TO_PYTHON, DONE, REGROUPED, SINES = range(4)
"""As in onward.c."""
LAPS = ("distances", "rows", "solve", "proof", "integrate")
RESIDUALS = tuple(Residuals.__dataclass_fields__)
PROVED = {"kind": "exact", "error_bound": 0.0, "gap": None}
"""What all certificates of proofs say."""
NO_ROWS = {"lam_extra": read_only(np.zeros(0)), "alone": True}
SHARED = ("J", "phi", "tau", "g", "b", "delta_q_bar_a")
"""What the scene writes where the proofs read it."""


class Onward:
    """What takes a step after another.

    Parameters
    ----------
    simulator : FastSimulator
        At the poses of the step.
    solver : FastSolver or SparseSolver
    step : StepData
        One of the steps.
    by : Prover or NaturalProgram
        What proves these steps, on the rows that the step before has pressed; or into what they are
        written, if the backend answers, and nothing is claimed.

    Attributes
    ----------
    record : dtype
        Of what is kept of a step.
    said : list of (int or None, float or None)
        Iterations and time [s] of the backend in each step since the last :meth:`begin`.
    """

    def __init__(
        self,
        simulator: FastSimulator,
        solver: FastSolver | SparseSolver,
        step: StepData,
        by: Prover | NaturalProgram,
    ) -> None:
        self.solver = solver
        self.prover = by if isinstance(by, Prover) else None
        self._simulator = simulator
        self._option_set = solver.option_sets(simulator.accuracy)[0]
        self.said: list[tuple[int | None, float | None]] = []
        compiled = library()
        self._posed = compiled.step_posed
        self._answered = compiled.step_answered
        self._proved = compiled.step_proved
        self._led = compiled.step_led
        self._within = compiled.step_within
        self._groups_proved = compiled.groups_proved
        numbers = simulator.numbers
        screws = simulator.screws
        n = step.n_v
        m = step.m
        self._s = s = Structure("onward.c", "Onward")
        self._address = s.address
        self._hessian = solver.hessian
        screws.changes.put({"delta_q": numbers["delta_q_bar_a"]})
        self._target = screws.target
        self._force = numbers["force"]
        self._links = simulator.system.links
        s.put(
            {
                "n": n, "m": m, "change": screws.changes.address, "sum": screws.sums.address,
                "pairs": simulator.contacts.address, "scene": numbers.address,
                "penetration": np.array([simulator.limits.penetration]),
                "residuals": np.zeros(4), "clock": np.zeros(1), "seconds": np.zeros(len(LAPS)),
                "reach": np.array([simulator.surely_within]),
                "x": np.zeros(n), "y": np.zeros(m), "delta_q": np.zeros(n), "lam": np.zeros(m),
            }
        )  # fmt: skip
        if isinstance(by, Prover):
            self._share(by, step)
        else:
            s.put(
                {
                    "program": by.address, "units": by.units,
                    "coordinate": by.hessian.coordinate,
                }
            )  # fmt: skip
        screws.sums.put({"delta_q": s["delta_q"]})
        kept: dict[str, NDArray[np.generic]] = {
            "scene": numbers.written, "delta_q_bar_a": numbers["delta_q_bar_a"],
            "delta_q": s["delta_q"], "lam": s["lam"], "q": screws.sums["q_next"],
        }  # fmt: skip
        if isinstance(by, Prover):
            claims = {name: by.s[name] for name in ("net", "least", "claims")}
            kept |= {"residuals": s["residuals"], **claims}
        kept["seconds"] = s["seconds"]  # C adds the last lap at the end of a record
        self.record = np.dtype(
            [(name, numbers.given if name == "scene" else (array.dtype, array.shape))
             for name, array in kept.items()]
        )  # fmt: skip
        s.put(
            {
                "pieces": len(kept),
                "piece": np.array([*map(address_of, kept.values())]),
                "size": np.array([array.nbytes // 8 for array in kept.values()]),
            }
        )

    def _share(self, prover: Prover, step: StepData) -> None:
        """Have proofs read what C writes of a step, and the record what they find."""
        s = self._s
        numbers = self._simulator.numbers
        solver = self.solver
        self._first = solver.prover.proofs.parts[0]
        prover.s.share(numbers, SHARED)
        if isinstance(solver, SparseSolver):
            entry = solver.kind.entry
        else:
            entry = np.zeros(0, np.int64)
            prover.s.share(numbers, ("A",))
        prover.s["mu"][:, 1:] = step.contacts.mu
        s.share(prover.s, ("frame", "pressure", "delta_q", "lam", "group"))
        s.put(
            {
                "groups": len(prover.proofs), "entries": len(entry), "entry": entry,
                "entries_of_A": prover.s["A"],
                "moves": np.asarray(step.contacts.kept_J.any(axis=1), np.int64),
            }
        )  # fmt: skip

    def fits(self, solver: Solver | None) -> bool:
        """Whether it takes the steps of a solver: of one that is asked, with the H that it had."""
        own = self.solver
        return solver is own and (self.prover is not None or own.hessian is self._hessian)

    def forget(self) -> None:
        """Begin the next proof with its answer alone."""
        if self.prover is not None:
            self.prover.forget()

    def begin(self, records: NDArray[np.void], pressed: Array | None) -> None:
        """Write the next steps into `records`.

        Parameters
        ----------
        records : ndarray, shape (steps,)
            [of the notation]
        pressed : ndarray, shape (m,), or None
            The lam of the last proved step, if there is one [N s].
        """
        s = self._s
        s.point("record", records)
        self.said = []
        if self.prover is not None:
            s["pressure"][:] = 0.0 if pressed is None else pressed
            self.prover.s["gap"][:] = 0.0

    def take(self, q_bar_a: Array, force: Array) -> int:
        """Take the step from the poses that are there: TO_PYTHON, DONE or REGROUPED.

        Parameters
        ----------
        q_bar_a : ndarray, shape (n_q_a,)
            Checked [m, rad, -].
        force : ndarray, shape (n_v,)
            [N, N m].
        """
        simulator = self._simulator
        address = self._address
        self._target[:] = q_bar_a
        self._force[:] = force
        simulator.poses.weigh(simulator.down)
        code: int = self._posed(address)
        if code != DONE:
            return code
        code = self._by_backend() if self.prover is None else self._by_proof(self.prover)
        if code == SINES:
            simulator.screws.say_sines()
            code = self._led(address)
        if code != DONE:
            return TO_PYTHON
        poses = simulator.poses
        poses.move(simulator.screws.sums["q_next"])
        if self._within(address):
            return DONE
        beyond = simulator.limits.out_of_reach(self._links, poses.kinematics().t)
        return DONE if beyond is None else TO_PYTHON

    def _by_proof(self, prover: Prover) -> int:
        check_arithmetic()
        if not self._groups_proved(prover.s.address):
            return TO_PYTHON
        if is_due(WHOLE, len(self._first.group.coordinates)):
            decided = prover.proofs[0].decided() if prover.proofs[0] else None
            assert decided is not None
            simulator = self._simulator
            numbers = simulator.numbers
            step, _ = simulator.step_of(numbers.taken(), numbers["delta_q_bar_a"].copy())
            check(self._first.step(step), decided)
        code: int = self._proved(self._address)
        return code

    def _by_backend(self) -> int:
        try:
            reply = self.solver.reply(self._option_set, None)
        except Exception:  # whatever another package raises: Python tries again
            return TO_PYTHON
        if not reply.solved or reply.x is None or reply.lam is None:
            return TO_PYTHON
        self._s["x"][:] = reply.x
        self._s["y"][:] = reply.lam
        self.said.append((reply.iterations, reply.seconds))
        code: int = self._answered(self._address)
        return code


class Taken(Steps):
    """Steps that were taken so; each becomes an object when it is asked for.

    Parameters
    ----------
    onward : Onward
    simulator : FastSimulator
    q : ndarray, shape (n_q,)
        Where they start.
    records : ndarray, shape (steps,)
        What C has written of them [of the notation].
    """

    def __init__(
        self, onward: Onward, simulator: FastSimulator, q: Array, records: NDArray[np.void]
    ) -> None:
        self._records = read_only(records)
        self._simulator = simulator
        self._start = q
        self._proved = onward.prover is not None
        self._solver = onward.solver
        self._said = onward.said
        self._made: dict[int, StepResult] = {}

    def __len__(self) -> int:
        return len(self._records)

    @overload
    def __getitem__(self, i: int) -> StepResult: ...

    @overload
    def __getitem__(self, i: slice) -> list[StepResult]: ...

    def __getitem__(self, i: int | slice) -> StepResult | list[StepResult]:
        if isinstance(i, slice):
            return [self[k] for k in range(*i.indices(len(self)))]
        k = range(len(self))[i]
        if k not in self._made:
            self._made[k] = self._result(k)
        return self._made[k]

    @cached_property
    def arrays(self) -> StepArrays:
        """As of any such steps."""
        records = self._records
        scene = records["scene"]
        names = ("phi", "alpha", "beta", "n", "point", "d1", "d2", "tau")
        kind = "exact" if self._proved else NOTHING_CLAIMED.kind
        worst = records["residuals"].max(axis=1) if self._proved else np.nan
        count = len(records)
        columns = self[0].step.contacts.kept_columns
        of_all = records["delta_q"]
        own = of_all[:, None] if columns is None else np.pad(of_all, ((0, 0), (0, 1)))[:, columns]
        return {
            **{name: scene[name] for name in names},
            **{name: records[name] for name in ("delta_q", "lam", "q")},
            "motion": (scene["J"] @ own[..., None])[..., 0],
            "certificate": np.full(count, kind),
            "worst_residual": np.full(count, worst),
            "digits": np.full(count, np.nan),
            **{SECONDS + name: records["seconds"][:, i] for i, name in enumerate(LAPS)},
        }

    def _result(self, k: int) -> StepResult:
        record = self._records[k, ...]  # an array, whose fields are read in less time
        own = {
            "q": record["q"], "q_start": self._records["q"][k - 1] if k else self._start,
            "scene": self._simulator.scene, "simulator": self._simulator, "record": record,
            "solver": self._solver, "said": None if self._proved else self._said[k],
        }  # fmt: skip
        return posed(FollowingResult, {}, own)


class FollowingResult(StepResult):
    """The result of such a step, whose parts become objects when they are asked for.

    Attributes
    ----------
    simulator : FastSimulator
    solver : FastSolver or SparseSolver
    record : ndarray, shape ()
        What C has written of the step [of the notation].
    said : (int or None, float or None) or None
        Iterations and time [s] of the backend; None of a proved step, for which none was asked.
    """

    simulator: FastSimulator
    solver: FastSolver | SparseSolver
    record: NDArray[np.void]
    said: tuple[int | None, float | None] | None

    @classmethod
    def compared_as(cls) -> type:
        """It is compared as :class:`~quasistatic_ref.simulate.result.StepResult`."""
        return StepResult

    @cached_property
    def _posed(self) -> tuple[StepData, ClosestPoints]:
        record = self.record
        return self.simulator.step_of(record["scene"], record["delta_q_bar_a"])

    @cached_property
    def step(self) -> StepData:
        """The problem of the step."""
        return self._posed[0]

    @cached_property
    def points(self) -> ClosestPoints:
        """Where the contacts were."""
        return self._posed[1]

    @cached_property
    def seconds(self) -> dict[str, float]:
        """Wall time of the parts [s]."""
        return dict(zip(LAPS, self.record["seconds"].tolist(), strict=True))

    @cached_property
    def solution(self) -> StepSolution:
        """What C has found."""
        solver = self.solver
        record = self.record
        proved = self.said is None
        iterations, solve_time = self.said or (None, None)
        statistics = SolverStatistics(
            solver.name,
            "not called" if proved else "optimal",
            iterations,
            solve_time,
            self.simulator.accuracy,
            interface=solver.interface,
            proof_time=self.seconds["proof"],
        )
        own = {
            "delta_q": record["delta_q"], "lam": record["lam"], "step": self.step,
            "backend": solver.name, "statistics": statistics,
            "net_impulse": record["net"] if proved else None,
            "certificate": self._certificate() if proved else NOTHING_CLAIMED,
        }  # fmt: skip
        return posed(StepSolution, NO_ROWS, own)

    def _certificate(self) -> Certificate:
        """As of :func:`~quasistatic_ref.certify.certificate.exact_certificate`."""
        record = self.record
        working = record["lam"].nonzero()[0].tolist()
        unique, smooth, least_slack, least_multiplier = claims_of(record["claims"], record["least"])
        own = {
            "residuals": dict(zip(RESIDUALS, record["residuals"].tolist(), strict=True)),
            "active": contact_rows(self.step, working), "multipliers_unique": unique,
            "differentiable": smooth, "smallest_inactive_slack": least_slack,
            "smallest_active_multiplier": least_multiplier if working else None, "step": self.step,
        }  # fmt: skip
        return posed(Certificate, PROVED, own)


def proved_bits(result: StepResult) -> object:
    """The bits of a proved step that are the same however it is taken, to compare two ways."""
    one = result.solution
    certificate = one.certificate
    claims = certificate.kind, certificate.multipliers_unique, certificate.differentiable
    step = result.step
    contacts = step.contacts
    of_step = [getattr(step, name) for name in step.kept() if name != "contacts"]
    of_contacts = [getattr(contacts, name) for name in contacts.kept()]  # of J the blocks, if kept
    same = [result.q, one.delta_q, one.net_impulse, claims, result.points, of_step, of_contacts]
    return bits(same)
