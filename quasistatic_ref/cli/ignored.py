"""What the model ignores of the files it was given, in one line each."""

from collections import Counter
from collections.abc import Sequence

from quasistatic_ref.model.system import System

ALWAYS = (
    "velocities and accelerations: nothing moves on by itself",
    "visual geometry, and contacts between bodies that no pair names",
    "xacro: macros are not expanded, and a file that holds any is refused",
)
WORDS = {
    "limit": "joint limits: position, effort and velocity",
    "dynamics": "joint damping and friction",
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


def ignored_lines(system: System) -> list[str]:
    """What the model ignores: one line each.

    Elements of one kind are counted, not listed. Links with visual but no collision geometry are
    named, because nothing can touch them.
    """
    lines = list(ALWAYS)
    for body in (body.name for body in system.bodies):
        of = f"{body}: "
        ignored = [entry.removeprefix(of) for entry in system.ignored if entry.startswith(of)]
        counts = Counter(entry.rpartition(".")[2] for entry in ignored)
        lines += [f"{body}: {WORDS.get(tag, f'<{tag}>')} ({n})" for tag, n in counts.items()]
        unseen = _visual_only(system, body, ignored)
        if unseen:
            lines.append(
                f"{body}: links with visual but no collision geometry: {', '.join(unseen)}"
            )
    return lines


def _visual_only(system: System, body: str, ignored: Sequence[str]) -> list[str]:
    solid = {system.links[placed.link] for placed in system.shapes}
    seen = [e[len("link[") : -len("].visual")] for e in ignored if e.endswith("].visual")]
    return [link for link in seen if f"{body}/{link}" not in solid]
