"""What decides the bits of a run, so that a sweep knows which runs it has."""

from __future__ import annotations

import hashlib
from importlib.metadata import PackageNotFoundError, version

import numpy as np

from quasistatic_ref import __version__
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.backends import QPSOLVERS


def run_settings(simulator: Simulator, start: Array, record: str) -> dict[str, str]:
    """What decides the bits of a run, by name, but for its target and its force.

    Parameters
    ----------
    simulator : Simulator
    start : ndarray, shape (n_q,)
        Where the run starts [m, rad, -].
    record : str
    """
    system = simulator.system
    settings = {
        "version of quasistatic_ref": __version__,
        "version of NumPy": np.__version__,
        **{
            name: str(one)
            for name, one in simulator.settings().items()
            if isinstance(one, str | float | bool)
        },
        "gravity": str(simulator.gravity.tolist()),
        "record": record,
        "version of the backend": _version(simulator.backend.removeprefix(QPSOLVERS)),
        **{f"limits.{name}": str(limit) for name, limit in vars(simulator.limits).items()},
        "extension": "none" if simulator.extension is None else "one",
    }
    for body, text in zip(system.bodies, system.texts, strict=True):
        body_settings = (text, body.base, body.actuated, body.xyz, body.rpy)
        settings[f"bodies.{body.name}"] = fingerprint(body_settings)
    settings["the order of the bodies"] = ", ".join(body.name for body in system.bodies)
    for pair in simulator.pairs:
        for field in ("mu_v", "mu_omega", "rows", "k"):
            settings[f"{field} of {pair.name}"] = repr(getattr(pair, field))
        settings[f"shapes of {pair.name}"] = fingerprint((pair.alpha, pair.beta))
    settings["the order of the contacts"] = ", ".join(pair.name for pair in simulator.pairs)
    arrays = {"K_q": simulator.K_q, "gravity_acts": simulator.gravity_acts, "start": start}
    return settings | {name: fingerprint(array) for name, array in arrays.items()}


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "unknown"


def fingerprint(value: object) -> str:
    """SHA-256 of what :func:`~quasistatic_ref.formats.plain.bits` compares, in hexadecimal.

    It is the same in every process: of arrays, texts and shapes, and not of mappings, whose order
    is not.
    """
    return hashlib.sha256(repr(bits(value)).encode()).hexdigest()
