"""What happened: arrays over the steps, with a header, in one ``.npz`` file without pickles."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Never

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import InputError, MissingKey, check_kind
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.parts import part
from quasistatic_ref.quoting import counted, nearest_name
from quasistatic_ref.shown import HasPage
from quasistatic_ref.simulate import wrenches
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.record.header import Header
from quasistatic_ref.simulate.scene import Scene
from quasistatic_ref.simulate.standing import Standings
from quasistatic_ref.step.data import Contacts, Extra, StepData, no_extra
from quasistatic_ref.step.solution import UNKNOWN, ContactForces, ForcesOfStep, warn_of_imbalance
from quasistatic_ref.text.module_on_demand import ModuleOnDemand
from quasistatic_ref.text.plain import Plain

if TYPE_CHECKING:
    import pandas as pd
else:
    pd = ModuleOnDemand("pandas")

Table = Callable[["Trajectory"], "pd.DataFrame"]
StandsAfter = Callable[["Trajectory", int, Scene, str], Standings]


class RecordArrays:
    """The arrays of a record as attributes with types; which of them there are, the record says.

    `certificate`, `worst_residual`, `motion`, `lam_extra`, `extra_A`, `extra_b`, `extra_H`,
    `extra_g`, `s` and `s_residual` have the shapes (T, ...) of the table
    of the record [its units].

    ``forces`` and ``imbalance`` are not among them: a trajectory forms them where they are missing.
    """

    q: Array
    t: Array
    delta_q: Array
    q_bar_a: Array
    phi: Array
    alpha: Array
    beta: Array
    n: Array
    d1: Array
    d2: Array
    point: Indices
    lam: Array
    wrench: Array
    certificate: NDArray[np.str_]
    worst_residual: Array
    digits: Array
    H: Array
    g: Array
    A: Array
    b: Array
    J: Array
    K_q: Array
    M_u: Array
    tau_a: Array
    tau_u: Array
    delta_q_bar_a: Array
    motion: Array
    lam_extra: Array
    extra_A: Array
    extra_b: Array
    extra_H: Array
    extra_g: Array
    s: Array
    s_residual: Array
    s_iterations: Indices
    mu_v: Array
    mu_omega: Array
    rows: Indices


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory(RecordArrays, Plain, HasPage, Mapping[str, NDArray[Any]]):
    """A run, or the part of it that succeeded: a mapping of its arrays by their names.

    A run makes it; its constructor checks nothing.

    Parameters
    ----------
    header : Header
        See :class:`~quasistatic_ref.simulate.record.header.Header`.
    arrays : mapping of str to ndarray
        Of the notation's shape and unit, behind a first axis, the step [-]: ``t`` (end of the
        step), ``delta_q``, ``q_bar_a``, ``phi``, ``alpha``, ``beta``, ``n``, ``d1``, ``d2``,
        ``point``, ``lam``, ``wrench``,
        ``certificate`` (its kind), ``worst_residual`` (natural units; NaN where nothing was
        certified), ``digits`` (correct ones of the backend; NaN where the exact answer is not
        known); ``q`` has one entry more, the start. A full record adds ``H``, ``g``, ``A``, ``b``
        and what they are made of: ``K_q``, ``M_u``, ``tau_a``, ``tau_u``, ``delta_q_bar_a``,
        ``J``. An extension's rows add ``lam_extra``, and to a
        full record ``extra_A`` and ``extra_b``, its quadratic cost ``extra_H`` and ``extra_g``.
        Coulomb's law adds ``s``, ``s_residual`` and ``s_iterations``, those of
        :class:`~quasistatic_ref.optional.coulomb.fixed_point.CoulombSolution`; ``A`` and ``b`` are
        then of phi + s. A record of forces has ``forces``, (n_c, 4) a step, ``imbalance``, and
        ``motion``, (n_c, 4): J delta_q.
        ``mu_v``, ``mu_omega`` and ``rows`` are constant.
    seconds : mapping of str to ndarray
        Wall time of the parts of each step [s], shape (steps,): those of a step, and of a run also
        ``record``, between steps, and ``findings``, at its end, which counts as the last step's.
        They add up to the run's. Kept in memory only, so that equal runs make equal files.
    scene : Scene, optional
        The system and the pairs, where the run was made in this process; kept in memory only, and
        not copied or pickled.

    Each array is an attribute as well: ``trajectory.phi`` is ``trajectory["phi"]``. All are
    read-only.

    Examples
    --------
    >>> run = qr.load_scenario("sphere_spin", steps=3).run(progress=False)
    >>> run.steps, run.wrench.shape
    (3, (3, 1, 4))
    """

    header: Header
    arrays: Mapping[str, NDArray[Any]]
    seconds: Mapping[str, Array] = field(default_factory=dict, compare=False)
    scene: Scene | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        for array in self.arrays.values():
            array.setflags(write=False)

    def __getitem__(self, name: str) -> NDArray[Any]:
        if not isinstance(name, str) or name not in self.arrays:
            near = nearest_name(str(name), self.arrays)
            raise MissingKey(f"is not an array of this trajectory{near}", field=str(name))
        return self.arrays[name]

    if not TYPE_CHECKING:  # it would answer any name

        def __getattr__(self, name: str) -> NDArray[Any]:
            arrays = self.__dict__.get("arrays", {})  # not there yet while it is unpickled
            if name not in arrays:
                hint = nearest_name(name, arrays)
                raise AttributeError(f"this trajectory has no {name!r}{hint}")
            return np.asarray(arrays[name])

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.arrays})

    def __contains__(self, name: object) -> bool:
        return name in self.arrays

    def __iter__(self) -> Iterator[str]:
        return iter(self.arrays)

    def __len__(self) -> int:
        return len(self.arrays)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self.arrays)

    def __array__(self, dtype: object = None, copy: object = None) -> Never:
        problem = "is many arrays: run.to_pandas() is a table of a row a step, run['q'] one array"
        raise InputError(problem, field="trajectory")

    def __bool__(self) -> bool:
        return True  # a run without steps is a run

    def __reduce__(self) -> tuple[Any, ...]:
        return Trajectory, (self.header, self.arrays, self.seconds)  # without the scene

    @property
    def steps(self) -> int:
        """Number of steps that succeeded."""
        return len(self.arrays["t"])

    @property
    def failed(self) -> str | None:
        """Why the run ended early, or None."""
        return self.header.failed

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Findings on the scene and the run: causes come before their effects.

        There are none without ``optional/doctor``, nor in files from before there were findings.
        Those of :attr:`ignored_findings` are left out.
        """
        return tuple(one for one in self.header.findings if one.name not in self.header.ignore)

    @property
    def ignored_findings(self) -> tuple[Finding, ...]:
        """Findings that the scene or the user has chosen to ignore."""
        return tuple(one for one in self.header.findings if one.name in self.header.ignore)

    def step_data(self, k: int) -> StepData:
        """The problem of step k (from 0), bit for bit as it was solved.

        Raises
        ------
        InputError
            If there is no such step, or the record is light.
        """
        self._check_step(k)
        if self.header.record != "full":
            problem = f"a {self.header.record} record has no quadratic programs"
            raise InputError(f"{problem}; run again with record = 'full'")
        a = self.arrays
        n_v = a["tau_a"].shape[1] + a["tau_u"].shape[1]
        contacts = Contacts(
            name=self.header.contacts[k],
            phi=a["phi"][k] + a["s"][k] if "s" in a else a["phi"][k],
            J=a["J"][k],
            **{key: a[key][k] for key in ("n", "d1", "d2")},
            **{key: a[key] for key in ("mu_v", "mu_omega", "rows")},
        )
        names = self.header.extra
        extra = no_extra(n_v)
        if names:
            extra = Extra(names, a["extra_A"][k], a["extra_b"][k])
        if "extra_H" in a:
            extra = replace(extra, H=a["extra_H"][k], g=a["extra_g"][k])
        return StepData(
            h=self.header.h,
            **{key: a[key][k] for key in ("K_q", "M_u", "tau_a", "tau_u", "delta_q_bar_a")},
            contacts=contacts,
            cone=self.header.cone,
            extra=extra,
        )

    def _check_step(self, k: int) -> None:
        check_kind(k, int | np.integer, "step", "a whole number")
        if not 0 <= k < self.steps:
            raise InputError(f"must be 0 to {self.steps - 1}", field="step", value=k)

    @cached_property
    def forces(self) -> Array:
        """Forces of single contacts in each step, shape (steps, n_c, 4) [N, N m].

        They are those of :attr:`~quasistatic_ref.step.solution.StepSolution.forces`. A record of
        forces holds them. Of a full record they are formed when they are first read, in some
        milliseconds a step. A warning says so where they leave more than 1e-4 of the load.

        Raises
        ------
        InputError
            If the record is light, the steps are not all that was solved, or there is no
            ``optional/forces``.
        """
        known = self.imbalance[np.isfinite(self.imbalance)]
        warn_of_imbalance(float(known.max(initial=0.0)))
        if "forces" in self.arrays:
            return self.arrays["forces"]
        shape = (self.steps, len(self.header.slots), 4)
        return np.array([forces.wrench for forces in self._compliant]).reshape(shape)

    @cached_property
    def imbalance(self) -> Array:
        """The share of the load that the forces of each step do not balance, (steps,) [-].

        That of :class:`~quasistatic_ref.step.solution.ContactForces`.

        Raises
        ------
        InputError
            As of :attr:`forces`.
        """
        if "imbalance" in self.arrays:
            return self.arrays["imbalance"]
        return np.array([forces.imbalance for forces in self._compliant])

    @cached_property
    def _compliant(self) -> list[ContactForces]:
        return [self._step_compliant(k) for k in range(self.steps)]

    def step_forces(self, k: int) -> Array:
        """Forces of single contacts in step k (from 0), shape (n_c, 4) [N, N m].

        Raises
        ------
        InputError
            As of :attr:`forces`, or if there is no such step.
        """
        if "forces" in self.arrays and 0 <= k < self.steps:
            return np.asarray(self.arrays["forces"][k])
        return self._step_compliant(k).wrench

    def _step_compliant(self, k: int) -> ContactForces:
        if self.header.record == "light":
            problem = "a light record holds no forces; run again with record = 'forces' or 'full'"
            raise InputError(problem)
        if not self.header.alone:
            raise InputError(UNKNOWN, field="forces")
        step = self.step_data(k)
        delta_q = self["delta_q"][k]
        near = (delta_q, self["wrench"][k]) if step.n_v == len(delta_q) else None
        contact_forces: ForcesOfStep = part("contact_forces")
        return contact_forces(step, None, near)

    def wrench_on(self, name: str, scene: Scene | None = None) -> Array:
        """Sum of the contact wrenches by lam on a body or a link, for each step.

        Parameters
        ----------
        name : str
            A body, for all of its links; or one link, such as ``gripper/left_finger``.
        scene : Scenario or Simulator, optional
            That of the run; only a trajectory that comes from a file or a pickle needs it.

        Returns
        -------
        ndarray, shape (steps, 6)
            Force [N] and torque [N m] along the world's axes; the torque about the origin of the
            link (of a body: of its root link) where the step starts, as the points and normals
            are. The rows of an extension are no contacts, and not in it.

        Raises
        ------
        InputError
            If there is no such body or link, or the scene is missing or another one.
        """
        scene = self._scene(scene)
        return wrenches.wrench_on(
            wrenches.contacts_over_steps(self.arrays, self["wrench"]), scene, name
        )

    def forces_on(self, name: str, scene: Scene | None = None) -> Array:
        """Sum of :attr:`forces` on a body or a link: force [N] and torque [N m], shape (steps, 6).

        Parameters
        ----------
        name, scene
            As for :meth:`wrench_on`.

        Raises
        ------
        InputError
            As :meth:`wrench_on`, or as of :attr:`forces`.
        """
        scene = self._scene(scene)
        return wrenches.wrench_on(
            wrenches.contacts_over_steps(self.arrays, self.forces), scene, name
        )

    def pair_forces(self) -> dict[str, Array]:
        """Force of each pair on its beta's body, by the pair's name.

        Returns
        -------
        dict of str to ndarray, shape (steps, 3)
            Sums of :attr:`forces` over the pair's contacts [N], world frame. A name of no pair is
            answered by a MissingKey that lists the pairs.

        Raises
        ------
        InputError
            As of :attr:`forces`.
        """
        contacts = wrenches.contacts_over_steps(self.arrays, self.forces)
        return wrenches.pair_forces(contacts, self.pair_names)

    @property
    def pair_names(self) -> list[str]:
        """The pair of each contact, shape (n_c,); numbers, of a file that has no names."""
        return [slot.rpartition("/")[0] for slot in self.header.slots]

    def stands(self, k: int, scene: Scene | None = None, *, certify: str = "off") -> Standings:
        """Whether each body would stay after step k, if its target and loads stayed as they are.

        Parameters
        ----------
        k : int
            From 0.
        scene : Scenario or Simulator, optional
            That of the run. A trajectory that comes from a file or a pickle needs it, a light
            record needs the scenario, which has the loads.
        certify : str
            As of :meth:`~quasistatic_ref.simulate.simulator.Simulator.stands`, as is what returns.

        Raises
        ------
        InputError
            Also if there is no such step, the scene is missing or another one, or the loads are not
            known.
        """
        self._check_step(k)
        stands_after: StandsAfter = part("stands_after")
        return stands_after(self, k, self._scene(scene), certify)

    def _scene(self, scene: Scene | None) -> Scene:
        if scene is None:
            scene = self.scene
        if scene is None:
            problem = "is not known: this trajectory is from a file; give its scenario or simulator"
            raise InputError(problem, field="scene")
        return scene

    def to_pandas(self) -> pd.DataFrame:
        """A data frame with a row for each step; a column is e.g. ``arm/elbow [rad]``.

        See :func:`~quasistatic_ref.optional.show.table.data_frame`.

        Raises
        ------
        InputError
            If pandas is not installed, or that part is missing.
        """
        step_table: Table = part("step_table")
        return step_table(self)

    def contacts_to_pandas(self) -> pd.DataFrame:
        """A data frame with a row for each contact of each step.

        Raises
        ------
        InputError
            As for :meth:`to_pandas`.
        """
        contact_table: Table = part("contact_table")
        return contact_table(self)


NOT_PROVED = "nothing proved"


def certified(trajectory: Trajectory) -> str:
    """How many steps are certified exactly, e.g. ``"300 of 300 steps exact"``.

    In the ellipsoid, also how many are enclosed: ``"20 of 30 steps exact, 10 enclosed"``; and in
    how many of them the backend failed, if in any. Of a run that asks for no proof, that nothing is
    proved.
    """
    kinds = [str(kind) for kind in trajectory["certificate"]] if trajectory.steps else []
    backend = trajectory.header.backend
    for kind, certify in (("none", "off"), ("residual", "residual")):
        if kinds and set(kinds) == {kind}:
            steps = counted(trajectory.steps, "step")
            return f"{steps} by {backend}, {NOT_PROVED} (certify = {certify})"
    exact = kinds.count("exact")
    enclosed = kinds.count("enclosure")
    rest = f", {enclosed} enclosed" if enclosed else ""
    failed = len(trajectory.header.unanswered)
    failures = f" (the backend failed in {failed} of them)" if failed else ""
    return f"{exact} of {trajectory.steps} steps exact{rest}{failures}"
