"""Whether a solver's own status claims that a problem has no solution."""

import re

_RAISED = re.compile(r"\w*(Error|Exception|Warning)\b")
_HEDGED = ("inaccurate", "almost", "or_unbounded")


def says_infeasible(status: str) -> bool:
    """Whether a status claims, without reserve, that there is no solution.

    Every problem of a study is strictly convex: "unbounded" and "dual infeasible" are never true,
    and counted with the claims of infeasibility. What an exception says is no claim.

    Parameters
    ----------
    status : str

    Examples
    --------
    >>> from quasistatic_ref.lab.study.calling.infeasibility import says_infeasible
    >>> says_infeasible("PROXQP_PRIMAL_INFEASIBLE"), says_infeasible("infeasible_inaccurate")
    (True, False)
    """
    words = status.lower()
    if _RAISED.match(status) or any(word in words for word in _HEDGED):
        return False
    return "infeasible" in words or "unbounded" in words
