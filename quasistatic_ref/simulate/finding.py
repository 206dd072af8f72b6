"""What is wrong with a scene, or doubtful in a run, in the words of physics."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from quasistatic_ref.errors import InputError, check_kind
from quasistatic_ref.parts import is_there, part
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.text.plain import Plain


@dataclass(frozen=True, eq=False)
class Finding(Plain):
    """One finding: what is wrong with a scene or doubtful in a run, and what to do.

    Runs and scenarios have them; their constructor checks nothing.

    Parameters
    ----------
    name : str
        Of its kind, a word of the page: ``"free-fall"``.
    grave : bool
        Whether the run is not what was meant; ``--strict`` fails on such a finding only.
    remedy, cause : str
        What to do, if anything, and why, with bodies and contacts.
    numbers : mapping of str to float
        What was measured [any unit], by names that end in their unit: ``{"depth_mm": 10.0}``.
    of : str
        What it is about, such as a body or a table of contacts.

    Examples
    --------
    >>> ball = qr.Body.of_shape("ball", qr.Sphere(0.05), mass=0.3, xyz=(0, 0, 1))
    >>> system = qr.System([ball])
    >>> run = qr.rollout(qr.Simulator(system, [], h=0.01, K_q=1.0), system.q_start, [], 3,
    ...                  progress=False)
    >>> [finding.name for finding in run.findings]
    ['unsupported-body']
    """

    name: str
    grave: bool
    remedy: str
    cause: str
    numbers: Mapping[str, float]
    of: str = ""

    def __post_init__(self) -> None:
        numbers = {name: float(number) for name, number in self.numbers.items()}
        object.__setattr__(self, "numbers", numbers)

    @property
    def severity(self) -> str:
        """``"grave"`` or ``"note"``."""
        return severity(self.grave)

    @property
    def sentence(self) -> str:
        """The cause, then the remedy, where there is one."""
        return f"{self.cause}; {self.remedy}" if self.remedy else self.cause

    def __str__(self) -> str:
        return f"{self.severity}: {self.sentence} [{self.name}]"


def check_finding_name(name: str) -> None:
    """Refuse a name that no finding has: InputError. Without ``optional/doctor`` any will do."""
    check_kind(name, str, "ignore", "a list of names")
    if not is_there("finding_names"):
        return
    known: frozenset[str] = part("finding_names")
    if name not in known:
        raise InputError(
            f"is no finding{suggestion(name, sorted(known))}", field="ignore", value=name
        )


def severity(grave: bool) -> str:
    """The severity of a finding, ``"grave"`` or ``"note"``."""
    return "grave" if grave else "note"


MOST_NOTES = 3
"""Notes that are printed whole."""


def told(findings: Sequence[Finding], ignored: Sequence[Finding]) -> Iterator[str]:
    """The lines in which findings are printed: grave ones, three notes, and names of the others.

    Parameters
    ----------
    findings, ignored : sequence of Finding
        What was found, and what of it the user has asked not to hear.
    """
    notes = [finding for finding in findings if not finding.grave]
    yield from (str(finding) for finding in findings if finding not in notes[MOST_NOTES:])
    if notes[MOST_NOTES:]:
        yield f"and {len(notes) - MOST_NOTES} more: {_named(notes[MOST_NOTES:])}"
    if ignored:
        yield f"ignored: {_named(ignored)}"


def _named(findings: Sequence[Finding]) -> str:
    """The names of findings, each with the body, pair or joint that it is about."""
    return ", ".join(f"{one.name} ({one.of})" if one.of else one.name for one in findings)
