"""Where a study ran: machine and versions, recorded with its times."""

import os
import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from quasistatic_ref.lab.study.solvers import Solver
from quasistatic_ref.solve.backends import BACKENDS


def machine() -> dict[str, object]:
    """Processor, its cores, system and Python."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.release()}",
        "python": platform.python_version(),
    }


def versions(solvers: tuple[Solver, ...]) -> dict[str, str]:
    """Versions of this package, of what stands between it and the solvers, and of these."""
    packages = ["quasistatic-ref", "numpy", "scipy", "cvxpy", "qpsolvers"]
    packages += [BACKENDS[str(s.target)].to_install for s in solvers if s.target in BACKENDS]
    return {name: _version(name) for name in dict.fromkeys(packages)}


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        if package == "quasistatic-ref":
            from quasistatic_ref import __version__

            return __version__
        return "not known"


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()
