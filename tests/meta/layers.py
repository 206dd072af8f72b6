"""The walls of the house as a function of the source: which import crosses which."""

import ast
from pathlib import Path

# A room imports only from rooms before it, and from itself: the core first, then the lab.
ROOMS = (
    "plain",
    "quoting",
    "errors",
    "tolerances",
    "progress",
    "fields",
    "files",
    "resources",
    "declared",
    "schema",
    "npz",
    "compiled",
    "step",
    "certify",
    "solve",
    "model",
    "contact",
    "simulate",
    "fast",
    "figures",
    "cli",
    "__main__",
    "lab/grasp",
    "lab/runs",
    "lab/measures",
    "lab/page",
    "lab/figures",
    "lab/scenes",
    "lab/vectors",
    "lab/study",
    "lab/reality",
    "lab/validate",
    "lab/examples",
    "lab/commands",
)

# The only file of the core that may name the lab, as a string: it imports one of its commands.
DOOR = "cli/main.py"

# The only file that may name compiled code, as a string: it gives nothing where there is no
# compiler. Whatever else is in the house comes to it through that door.
COMPILED, COMPILED_DOOR = "fast", "compiled.py"

# Where each third-party package may be imported: a room, or one file.
WALLS = {
    "cvxpy": ("step/problem.py", "solve"),
    # A QP assembled by hand, to check ours: it must not go through our own way to a solver.
    # And the loop that people write first, to compare its time.
    "qpsolvers": ("solve", "lab/validate/engines/by_hand.py", "lab/study/bench/by_hand.py"),
    "pinocchio": ("model",),
    "coal": ("model", "contact"),
    "matplotlib": ("figures", "lab/figures"),
    "meshcat": ("figures",),
    "jax": ("simulate/step_jax.py",),
    # Exact and ball arithmetic: the judge, and the vectors that others are judged by.
    "flint": ("certify", "lab/vectors"),
}

# What a room may not import although it comes before: figures draw what they are given, examples
# need no claim.
CLOSED = dict.fromkeys(
    ("figures", "lab/figures"),
    (
        "solve",
        "certify",
        "contact",
        "simulate/simulator",
        "step/data/StepData",
        "step/data/Contacts",
    ),
) | {"lab/examples": ("lab/validate",)}

DYNAMIC = ("import_module", "__import__")


def under_type_checking(tree):
    """The nodes that run only for a type checker."""
    inside = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING"):
            for statement in node.body:
                inside |= set(ast.walk(statement))
    return inside


def imports(tree, package, module):
    """(line, dotted name) of everything imported anywhere in a file, functions included."""
    skipped = under_type_checking(tree)
    for node in ast.walk(tree):
        if node in skipped:
            continue
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield node.lineno, alias.name
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                base = ".".join([*module[: len(module) - node.level], *filter(None, [base])])
            for alias in node.names:
                yield node.lineno, f"{base}.{alias.name}"
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith(DYNAMIC):
            for argument in node.args[:1]:
                if isinstance(argument, ast.Constant):
                    yield node.lineno, str(argument.value)


def room_of(parts):
    """The room that a file or a dotted name is in, from its parts below the package."""
    if parts[0] == "lab":
        return "/".join(parts[:2]).removesuffix(".py")
    return parts[0].removesuffix(".py")


def names_of(room, tree):
    """Lines on which a string names a room."""
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Constant)
            and isinstance(node.value, str)
            and (f"quasistatic_ref.{room}" in node.value or node.value.startswith(f".{room}"))
        ):
            yield node.lineno


def closed_to(room, parts):
    """Whether a room may not import a name, from the name's parts below the package."""
    path = "/".join(parts) + "/"
    return any(path.startswith(place + "/") for place in CLOSED.get(room, ()))


def violations(root: Path, rooms=ROOMS, walls=WALLS):
    """Sentences, one for each import that crosses a wall."""
    found = []
    package = root.name
    for path in sorted(root.rglob("*.py")):
        inside = path.relative_to(root)
        if inside.parts == ("__init__.py",):
            own = None  # the lazy face: it may import no room at all
        else:
            own = room_of(inside.parts)
            if own == "lab/__init__":
                own = None
            elif own not in rooms:
                found.append(f"{inside}: {own} is not a room of the house")
                continue
        module = (package, *inside.with_suffix("").parts)
        tree = ast.parse(path.read_text())
        if inside.parts[0] != "lab" and inside.as_posix() != DOOR:
            found += [f"{inside}:{line}: names the lab" for line in names_of("lab", tree)]
        if own != COMPILED and inside.as_posix() != COMPILED_DOOR:
            found += [f"{inside}:{line}: names {COMPILED}" for line in names_of(COMPILED, tree)]
        for line, name in imports(tree, package, module):
            top, *rest = name.split(".")
            if top == package:
                if not rest or rest[0].startswith("__"):
                    continue
                room = room_of(rest)
                if room == COMPILED and own != COMPILED:
                    found.append(f"{inside}:{line}: imports {name}, past {COMPILED_DOOR}")
                elif room not in rooms:
                    found.append(f"{inside}:{line}: imports {name}, which is no room")
                elif own is None or rooms.index(room) > rooms.index(own):
                    found.append(f"{inside}:{line}: imports {name} from a later room")
                elif closed_to(own, rest):
                    found.append(f"{inside}:{line}: imports {name}, which is closed to {own}")
            elif top in walls and not any(
                inside.as_posix() == place or own == place for place in walls[top]
            ):
                found.append(f"{inside}:{line}: imports {top}")
    return found
