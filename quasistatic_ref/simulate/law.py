"""The law of friction that steps obey: the model's own, or Coulomb's of ``optional/coulomb``."""

from typing import Final, Literal, get_args

from quasistatic_ref.errors import InputError
from quasistatic_ref.parts import part
from quasistatic_ref.quoting import suggestion

CONVEX: Final = "convex"
COULOMB: Final = "coulomb"
Law = Literal["convex", "coulomb"]
LAWS: tuple[Law, ...] = get_args(Law)


def check_law(law: str, certify: str) -> None:
    """Refuse a law that is unknown, or whose steps cannot be certified as is asked for.

    Raises
    ------
    InputError
        Also if ``optional/coulomb`` is missing.
    """
    if not (isinstance(law, str) and law in LAWS):
        raise InputError(f"is not a choice{suggestion(str(law), LAWS)}", field="law", value=law)
    if law == COULOMB:
        part(COULOMB)  # or its sentence
        if certify != "full":
            problem = (
                f'needs certify = "full", not "{certify}": the iteration ends where exact steps '
                "agree to 12 digits"
            )
            raise InputError(problem, field="law", value=law)
