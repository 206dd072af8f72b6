"""What readers ask of parts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from quasistatic_ref.parts import needing
from quasistatic_ref.solve.backends import DEFAULT

if TYPE_CHECKING:
    from quasistatic_ref.contact.pairs import ContactPair
    from quasistatic_ref.files.mesh import Mesh
    from quasistatic_ref.files.scenario.bodies import BodyEntry, OfBodies
    from quasistatic_ref.model.system import System
    from quasistatic_ref.numbers.arrays import Array
    from quasistatic_ref.simulate.simulator import Simulator


def file_points(path: Path, kind: str) -> Array:
    """``cloud``: the points of a file of this kind, as ``.ply``, shape (N, 3) [m]."""
    with needing(f"a {kind} cloud"):
        from quasistatic_ref.optional.readers.points import file_points as points
    return points(path)


def file_mesh(path: Path, kind: str) -> Mesh:
    """``mesh``: what a file of this kind, as ``.stl``, holds."""
    with needing(f"a {kind} mesh"):
        from quasistatic_ref.optional.readers.meshes import file_mesh as mesh
    return mesh(path, kind)


def extended_bodies(
    system: System,
    pairs: tuple[ContactPair, ...],
    entries: Mapping[str, BodyEntry],
    h: float,
    K_q: Array,
    gravity: Array,
) -> tuple[tuple[ContactPair, ...], OfBodies]:
    """``joint_friction``, ``support`` and ``joint_limits``: what a scenario's bodies extend.

    These are the pairs with those of supports, and what else is added to each step.
    """
    with needing("joint_friction, support and joint_limits"):
        from quasistatic_ref.optional.extensions.of_scenario import of_scenario
    return of_scenario(system, pairs, entries, h, K_q, gravity)


def fast_simulator(simulator: Simulator) -> Simulator:
    """``fast``: a simulator that takes the steps of another one sooner."""
    with needing("fast"):
        from quasistatic_ref.optional.fast.simulator import FastSimulator
    return FastSimulator(simulator)


def default_backend(
    fast: bool, system: System, pairs: Sequence[ContactPair], cone: str, law: str
) -> str:
    """The backend where none is named, with ``fast`` or without.

    Parameters
    ----------
    fast : bool
    system : System
    pairs : sequence of ContactPair
    cone, law : str
    """
    if not fast:
        return DEFAULT
    with needing("fast"):
        from quasistatic_ref.optional.fast.simulator import default_backend as of_fast
    return of_fast(system, pairs, cone, law)
