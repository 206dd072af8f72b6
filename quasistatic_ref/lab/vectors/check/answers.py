"""A folder of answers, read so that one bad file or answer does not hide the others."""

from dataclasses import dataclass, field
from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.files import ANSWERS, fields_after_head
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.text.table_reader import TableReader

TANGENTS = ("body", "world", "mujoco")
QUATERNIONS = ("xyzw", "wxyz")


@dataclass(frozen=True)
class Answers:
    """What one implementation answers to one layer.

    Parameters
    ----------
    outputs : dict
        By the id of the case.
    implementation : str
    tangent, quaternion : str
        As declared.
    present : bool
        Whether there is a file.
    problem : str
        Why the file cannot be read, or which of its entries cannot; empty if nothing is wrong.
    unsupported : set of str
        Ids of cases that the program says it does not do.
    """

    outputs: dict[str, Json] = field(default_factory=dict)
    implementation: str = ""
    tangent: str = "body"
    quaternion: str = "xyzw"
    present: bool = True
    problem: str = ""
    unsupported: frozenset[str] = frozenset()


def answers_read(folder: str | Path, layer: str) -> Answers:
    """The answers of a layer; a fault of their file is stored in them, not raised."""
    path = Path(folder) / f"{layer}.json"
    if not path.exists():
        return Answers(present=False)
    try:
        top = fields_after_head(path, ANSWERS, layer)
        implementation = top.text("implementation")
        tangent = top.text("tangent", "body", choices=TANGENTS)
        quaternion = top.text("quaternion", "xyzw", choices=QUATERNIONS)
        entries = top.sequence("answers")
        top.close()
    except InputError as error:
        return Answers(problem=str(error.in_file(path)))
    outputs: dict[str, Json] = {}
    unsupported: set[str] = set()
    problems = []
    for i, entry in enumerate(entries):
        try:
            one = TableReader(entry, f"answers[{i}]")
            name = one.text("id")
            left_out = one.boolean("unsupported", False)
            output = None if left_out else one.take("output")
            one.close()
            if name in outputs or name in unsupported:
                raise one.error_about("id", "is answered twice", name)
        except InputError as error:
            problems.append(str(error.in_file(path)))
            continue
        if left_out:
            unsupported.add(name)
        else:
            outputs[name] = output
    problem = "; ".join(problems[:1])
    known = frozenset(unsupported)
    return Answers(outputs, implementation, tangent, quaternion, True, problem, known)
