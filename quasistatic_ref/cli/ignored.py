"""What the model ignores of the files it was given, in one line each."""

import re
from collections import Counter
from collections.abc import Collection, Sequence

from quasistatic_ref.model.mechanism import Mechanism
from quasistatic_ref.model.system import System

ALWAYS = (
    "velocities and accelerations: nothing moves on by itself",
    "visual geometry, and contacts between bodies that no pair names",
    "xacro: macros are not expanded, and a file that holds any is refused",
    "names of robots and materials: a body is called what its scenario calls it",
)
LIMITS = "joint limits: position, effort and velocity"
NOT_STOPPED = "joint limits: effort and velocity"
WORDS = {
    "limit": LIMITS,
    "joint.limit.bounds": "bounds of joints that turn without end",
    "joint.dynamics.damping": "joint damping",
    "joint.dynamics.friction": "joint friction",
    "link.collision.friction": "friction of contacts: the scenario has it",
    "axis": "axes of fixed joints, which cannot move",
    "safety_controller": "safety controllers",
    "calibration": "joint calibration",
    "mimic": "mimics of fixed joints, which cannot move",
    "visual": "visual geometry",
    "collision_checking": "collision_checking: shapes are taken as <collision> says",
    "transmission": "transmissions",
    "gazebo": "what is meant for Gazebo",
    "material": "materials",
    "sensor": "sensors",
}


def ignored_lines(
    system: System, rubbed: Collection[str] = (), stopped: Collection[str] = ()
) -> list[str]:
    """What the model ignores: one line each.

    Elements of one kind are counted, not listed. Links with visual but no collision geometry are
    named, because nothing can touch them.

    Parameters
    ----------
    system : System
    rubbed : collection of str
        Names of bodies whose joints have the friction that their files say.
    stopped : collection of str
        Names of bodies whose joints stop at the limits that their files say.
    """
    moving = [joint.name for joint in system.joints] + [joint.name for joint in system.mimics]
    lines = list(ALWAYS)
    for body in (body.name for body in system.bodies):
        of = f"{body}: "
        ignored = [entry.removeprefix(of) for entry in system.ignored if entry.startswith(of)]
        if body in rubbed:
            used = {f"joint[{name.removeprefix(f'{body}/')}].dynamics.friction" for name in moving}
            ignored = [entry for entry in ignored if entry not in used]
        counts = Counter(_words(entry) for entry in ignored)
        if body in stopped and LIMITS in counts:
            counts[NOT_STOPPED] = counts.pop(LIMITS)
        lines += [f"{body}: {words} ({n})" for words, n in counts.items()]
        unseen = _visual_only(system, body, ignored)
        if unseen:
            lines.append(
                f"{body}: links with visual but no collision geometry: {', '.join(unseen)}"
            )
    return lines


def unknown_elements(system: Mechanism) -> str:
    """Elements of its URDFs that no part of the model knows, and how often: one line, or none."""
    entries = system.ignored if isinstance(system, System) else ()
    kinds = Counter(_words(entry.partition(": ")[2]) for entry in entries)
    unknown = [f"{kind} ({n})" for kind, n in kinds.items() if kind.startswith("<")]
    return f"ignored: {', '.join(unknown)}; inspect lists all" if unknown else ""


def _words(entry: str) -> str:
    """The kind of an ignored entry: ``joint[hip].armature`` becomes <joint.armature>."""
    kind = re.sub(r"\[[^\]]*\]|^robot\.", "", entry)
    last = kind.rpartition(".")[2]
    return WORDS.get(kind) or WORDS.get(last) or f"<{kind}>"


def _visual_only(system: System, body: str, ignored: Sequence[str]) -> list[str]:
    solid = {system.links[placed.link] for placed in system.shapes}
    seen = [e[len("link[") : -len("].visual")] for e in ignored if e.endswith("].visual")]
    return [link for link in seen if f"{body}/{link}" not in solid]
