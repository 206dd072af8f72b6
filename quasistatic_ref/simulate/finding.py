"""What is wrong with a scene, or doubtful in a run, in the words of physics."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.table_reader import TableReader


@dataclass(frozen=True, eq=False)
class Finding(Plain):
    """One finding; docs/findings.md has each, with its cause and its remedy.

    Parameters
    ----------
    name : str
        Of its kind, such as ``"free fall"``.
    grave : bool
        Whether the run is not what was meant; ``--strict`` fails on such a finding only.
    remedy, cause : str
        What to do, and why, with bodies and contacts.
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
    ['unsupported body']
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
    def sentence(self) -> str:
        """The remedy, then the cause."""
        return f"{self.remedy}: {self.cause}"

    def __str__(self) -> str:
        return self.sentence


def finding_table(finding: Finding) -> dict[str, Any]:
    """A finding as it stands in files: ``name``, ``grave``, ``sentence``, ``remedy``, ``numbers``.

    Parameters
    ----------
    finding : Finding
    """
    return {
        "name": finding.name,
        "grave": finding.grave,
        "sentence": finding.sentence,
        "remedy": finding.remedy,
        "numbers": dict(finding.numbers),
    }


def finding_read(table: object, where: str) -> Finding:
    """A finding as it stands in the header of a trajectory.

    Raises
    ------
    InputError
        If a field is missing, unknown or of another type.
    """
    fields = TableReader(table, where)
    numbers = fields.table("numbers")
    remedy = fields.text("remedy")
    finding = Finding(
        name=fields.text("name"),
        grave=fields.boolean("grave"),
        remedy=remedy,
        cause=fields.text("sentence").removeprefix(f"{remedy}: "),
        numbers={name: numbers.number(name) for name in numbers.names_left()},
    )
    fields.close()
    return finding
