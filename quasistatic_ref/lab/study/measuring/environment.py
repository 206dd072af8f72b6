"""Versions of what a study calls."""

from importlib.metadata import PackageNotFoundError, version

from quasistatic_ref.lab.study.calling.packages import entry_of, package_of
from quasistatic_ref.lab.study.calling.solvers import Solver
from quasistatic_ref.lab.study.calling.study_only import EVERY


def versions(solvers: tuple[Solver, ...]) -> dict[str, str]:
    """Versions of this package, of what stands between it and the solvers, and of these."""
    packages = ["quasistatic-ref", "numpy", "scipy", "cvxpy", "qpsolvers"]
    packages += [EVERY[str(s.target)].to_install for s in solvers if s.target in EVERY]
    packages += [package_of(entry_of(str(s.target))) for s in solvers if s.interface == "package"]
    return {name: _version(name) for name in dict.fromkeys(packages)}


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        if package == "quasistatic-ref":
            from quasistatic_ref import __version__

            return __version__
        return "not known"
