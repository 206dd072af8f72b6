"""Does it stand after a step of a run? Its target and its loads stay as they are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.optional.stands.stands import stands
from quasistatic_ref.simulate.simulator import Simulator

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Array
    from quasistatic_ref.simulate.record.trajectory import Trajectory
    from quasistatic_ref.simulate.scene import Scene
    from quasistatic_ref.simulate.standing import Standings


def stands_after(run: Trajectory, k: int, scene: Scene, certify: str) -> Standings:
    """Whether each body would stay after step k of a run of a scene.

    Raises
    ------
    InputError
        If the loads of the step are not known.
    """
    q = run["q"][k + 1]
    if not isinstance(scene, Simulator):
        scenario: Any = scene
        simulator: Simulator = scenario.simulator()
        force = None if scenario.force is None else scenario.force(run["t"][k], q)
    elif "tau_u" in run:
        simulator = scene
        n_v = simulator.system.n_v
        tau = np.concatenate([run["tau_a"][k], run["tau_u"][k]])[:n_v]
        force = kept(simulator, run["q"][k], q, tau)
    else:
        problem = "holds no loads; give its scenario, or run again with record = 'full'"
        raise InputError(problem, field="record", value=run.header.record)
    return stands(simulator, q, run["q_bar_a"][k], force, certify)


def kept(simulator: Simulator, q: Array, there: Array, tau: Array) -> Array:
    """The loads of a step but gravity, kept for another configuration, shape (n_v,) [N, N m].

    Forces and torques on free bodies keep their directions in the world.

    Parameters
    ----------
    simulator : Simulator
    q, there : ndarray, shape (n_q,)
        Of the system [m, rad, -].
    tau : ndarray, shape (n_v,)
        All loads of the step, gravity included [N, N m].
    """
    system = simulator.system
    force = tau - simulator.generalised_force(q, None)
    bases = [joint for joint in system.joints if joint.free and not joint.actuated]
    if force.any() and bases:
        at = np.array([base.v.start for base in bases])[:, None, None] + np.arange(6).reshape(2, 3)
        links = [system.link(base.name.removesuffix("/base")) for base in bases]
        R, R_there = (system.kinematics(x).R[links] for x in (q, there))
        force[at] = force[at] @ R.swapaxes(1, 2) @ R_there
    return force
