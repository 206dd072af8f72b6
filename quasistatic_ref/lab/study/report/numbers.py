"""How filters, numbers and options stand in a report of a study."""

from collections.abc import Mapping, Sequence


def filter_words(where: Mapping[str, object], more: str = "") -> str:
    """A filter as text: ``setting = high, warm = false``."""
    words = [f"{name} = {_word(value)}" for name, value in where.items()]
    return ", ".join(words) + more if words else "all rows" + more


def _word(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def percent(value: float) -> str:
    """A share, to a tenth.

    Parameters
    ----------
    value : float [%]
    """
    return f"{value:.1f}"


def digits(value: float) -> str:
    """Correct digits, to a tenth.

    Parameters
    ----------
    value : float [-]
    """
    return f"{value:.1f}"


def milliseconds(seconds: float) -> str:
    """A time in milliseconds, to three figures.

    Parameters
    ----------
    seconds : float [s]
    """
    return f"{1e3 * seconds:.3g}"


def options_words(options: Mapping[str, object], without: Sequence[str] = ()) -> str:
    """Options as a solver's user writes them: ``eps_abs=1e-09, eps_rel=0``."""
    words = [f"{k}={v:g}" if isinstance(v, float) else f"{k}={v}" for k, v in options.items()
             if k not in without]  # fmt: skip
    return ", ".join(words) or "none"
