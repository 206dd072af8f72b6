"""Names that parts have."""

from __future__ import annotations

from quasistatic_ref.parts import is_there


def finding_names() -> frozenset[str]:
    """``ignore``: the names that findings have; none without ``optional/doctor``."""
    if not is_there("doctor"):
        return frozenset()
    from quasistatic_ref.optional.doctor.names import NAMES

    return NAMES


def qpsolvers_names() -> list[str]:
    """Names of the solvers that qpsolvers finds here."""
    if not is_there("qpsolvers"):
        return []
    from quasistatic_ref.optional.qpsolvers.through_qpsolvers import available_solvers

    return available_solvers()
