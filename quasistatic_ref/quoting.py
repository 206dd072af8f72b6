"""What a sentence repeats of what was given: on one line, clipped, with the nearest known name.

And tables in lines of text.
"""

import difflib
import re
from collections.abc import Iterable, Iterator, Sequence

LONGEST = 200
"""Most characters of anything given that a sentence repeats."""
MOST_NAMES = 50
"""Most names that a sentence lists."""
OTHER_WORDS = {
    "-o": "--out --output",
    "h": "dt time_step timestep",
    "t": "time",
    "steps": "n_steps num_steps nsteps horizon",
    "mu_v": "mu friction static_friction lateral_friction sliding_friction",
    "mu_omega": "mu_w mu_t torsion torsional_friction spinning_friction",
    "K_q": "stiffness kp gains position_gain",
    "backend": "solver",
    "accuracy": "tolerance tol eps",
    "actuated": "joints actuators motors",
    "targets": "control ctrl qpos_des desired waypoints",
    "target": "control ctrl qpos_des desired u",
    "force": "wrench xfrc_applied qfrc_applied external_force tau",
    "wrenches": "wrench xfrc_applied external_force forces force",
    "positions": "q qpos q0 joint_positions initial_positions keyframe",
    "base": "fixed_base freejoint usefixedbase floating_base",
    "pose": "pos position xyz rpy quat origin transform",
    "xyz": "pos position translation origin",
    "rpy": "quat orientation euler rotation",
    "urdf": "mesh file model filename path body",
    "cloud": "points point_cloud",
    "shapes": "geometry geom geoms collision collisions",
    "shape": "geometry geom solid",
    "bodies": "body robots models links",
    "contacts": "contact pairs collision_pairs",
    "pairs": "contacts contact collision_pairs",
    "alpha": "body_a geom1 a",
    "beta": "body_b geom2 b",
    "k": "condim n_contacts max_contacts",
    "record": "log logging",
    "fast": "compiled engine",
    "gravity": "g",
}
"""Our names of fields, and what MuJoCo, Drake, pinocchio, PyBullet and others call the like."""


def one_line(text: str) -> str:
    """Text whose line ends and control characters are escaped: names come from any file."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)


def slash_remedy(text: str) -> str:
    """``"; write paths with /..."`` of a text with backslashes, or with what TOML makes of them."""
    is_of_windows = "\\" in text or not text.isprintable()
    return "; write paths with / in place of backslashes" if is_of_windows else ""


def no_formula(text: str) -> str:
    """A cell of a CSV that no spreadsheet takes for a formula."""
    return f"'{text}" if text.startswith(("=", "+", "-", "@", "\t", "\r")) else text


def clipped(text: str, longest: int = LONGEST) -> str:
    """Text of at most so many characters; a longer one loses its middle."""
    if len(text) <= longest:
        return text
    head = (longest - 3) // 2
    return f"{text[:head]}...{text[head + 3 - longest :]}"


def suggestion(name: str, known: Iterable[str]) -> str:
    """``"; did you mean 'x'? known: ..."`` for an unknown name."""
    names = sorted(known)
    return f"{nearest_name(name, names) or ';'} {known_names(names)}"


def known_names(known: Iterable[str]) -> str:
    """``"known: ..."``, the names sorted, a long list cut."""
    names = sorted(known)
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return f"known: {', '.join(map(clipped, names[:MOST_NAMES])) or 'none'}{more}"


def nearest_name(name: str, known: Iterable[str]) -> str:
    """``"; did you mean 'x'?"`` for an unknown name, or nothing if none is near."""
    if len(name) > LONGEST:  # difflib's time is quadratic
        return ""
    by_lower = {known_name.lower(): known_name for known_name in known}
    word = name.lower()
    meant = [ours for ours in by_lower.values() if word in OTHER_WORDS.get(ours, "").split()]
    near = difflib.get_close_matches(word, by_lower, n=1)
    meant += [by_lower[one] for one in near]
    return f"; did you mean {clipped(meant[0])!r}?" if meant else ""


def short_words(text: str) -> str:
    """The text with very long unbroken words clipped: only quoted input has such words."""
    if len(text) <= LONGEST:
        return text
    return re.sub(rf"\S{{{LONGEST + 1},}}", lambda word: clipped(word[0]), text)


def shown_value(value: object) -> str:
    """The `repr` of a value, on one line and cut to 80 characters."""
    try:
        text = " ".join(repr(value).split())
    except (RecursionError, ValueError):  # nested without end; an integer of too many digits
        return f"of type {type(value).__name__}, too long to show"
    return text if len(text) <= 80 else f"{text[:77]}..."


def listed(names: Sequence[str]) -> str:
    """Names in a sentence: ``a, b and c``."""
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def aligned(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """Rows of a table as lines, the first column to the left, the others to the right."""
    first, *widths = (max(map(len, column)) for column in zip(*rows, strict=True))
    for name, *others in rows:
        right = [cell.rjust(width) for cell, width in zip(others, widths, strict=True)]
        yield "  ".join([name.ljust(first), *right]).rstrip()


def counted(n: int, noun: str) -> str:
    """A number of things, e.g. ``1 contact`` or ``3 bodies``."""
    many = f"{noun[:-1]}ies" if noun.endswith("y") else f"{noun}s"
    return f"{n} {noun if n == 1 else many}"
