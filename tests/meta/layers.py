"""Which import crosses which wall between core, optional parts and lab, read from the source."""

import ast

from quasistatic_ref.model.body import FIXED
from quasistatic_ref.model.joints import BASES, JOINTS

# The core, in this order: a folder imports only from folders before it, and from itself.
CORE = (
    ("formats", "errors", "tolerances", "parts", "precision"),
    ("step",),
    ("certify",),
    ("solve",),
    ("shapes",),
    ("model",),
    ("contact",),
    ("simulate",),
    ("scenario",),
)

# What parts ask of each other, and what they bound errors with, which all of them import.
BETWEEN = ("optional/gap",)

# Each folder of `optional` imports the core, and no other folder of `optional`, but below GUARDS.
OPTIONAL = (
    "optional/coulomb",
    "optional/curved",
    "optional/derivatives",
    "optional/doctor",
    "optional/ellipsoid",
    "optional/extensions",
    "optional/fast",
    "optional/forces",
    "optional/guests",
    "optional/qpsolvers",
    "optional/readers",
    "optional/scans",
    "optional/scene_files",
    "optional/show",
)

# The command line and the lab import anything before them, in this order.
LAB = (
    "cli",
    "__main__",
    "lab/grasp",
    "lab/cached_runs",
    "lab/thresholds",
    "lab/json_schema",
    "lab/folders",
    "lab/lock",
    "lab/run_settings",
    "lab/parallel",
    "lab/machine",
    "lab/cluster",
    "lab/processes",
    "lab/page",
    "lab/figures",
    "lab/sweep",
    "lab/scenes",
    "lab/program",
    "lab/vectors",
    "lab/oracle",
    "lab/study",
    "lab/bench",
    "lab/reality",
    "lab/claims",
    "lab/commands",
)

# The only file of core and command line that may name the lab, as a string.
LAB_DOOR = "cli/main.py"

# The only file of core and command line that may name the optional parts, as a string.
PARTS_DOOR = "parts.py"

# The only file that may import nothing of the package: the names of the front door are lazy.
FACE = "__init__.py"

# Where each third-party package may be imported: a folder, or one file.
WALLS = {
    "cvxpy": (
        "step/cones.py",
        "step/extension.py",
        "step/problem.py",
        "solve",
        "optional/ellipsoid",
        "optional/extensions",
        "lab/study/accepted.py",
        "lab/study/compiled_problems.py",
    ),
    "qpsolvers": ("optional/qpsolvers",),
    "pinocchio": ("model", "optional/derivatives/model"),
    "coal": ("shapes", "model", "optional/curved"),
    "matplotlib": ("optional/show/figures", "lab/figures"),
    "meshcat": ("optional/show/figures",),
    "jax": ("optional/derivatives/step_jax.py",),
    "cffi": ("optional/fast",),
    "daqp": ("optional/fast", "lab/study/accepted.py"),
    # Exact and ball arithmetic: the judge, and the vectors that others are judged by. And angles.
    "flint": (
        "precision.py",
        "certify",
        "model/angles.py",
        "optional/coulomb",
        "optional/derivatives/step/barrier.py",
        "optional/ellipsoid",
        "optional/extensions",
        "optional/forces",
        "optional/gap.py",
        "lab/vectors",
    ),
}

# What a folder may not import although it comes before: figures draw what they are given.
CLOSED = dict.fromkeys(
    ("optional/show/figures", "lab/figures"),
    (
        "solve",
        "certify",
        "contact/distance",
        "simulate/simulator",
        "step/data/StepData",
        "step/data/Contacts",
    ),
)

# Kinds answer for themselves: who may ask for the class of a cone, and name a kind of joint.
CONES = {"FrictionCone", "PolyhedralCone", "CurvedCone", "EllipsoidCone"}
OF_CONES = ("step/cones.py", "certify/curved_cone.py", "optional/ellipsoid/cone.py")
OF_JOINTS = {FIXED, *BASES, *JOINTS}
READERS = ("model/joints", "model/body.py", "model/urdf", "scenario", "cli", "lab")

DYNAMIC = ("import_module", "__import__")

# Of parts.py: below these anything but the ground may import an optional part in a function.
GUARDS = {"needing", "if_there"}


def guarded(nodes):
    """The nodes of functions below a GUARDS, which say what to do where a part is missing."""
    inside = set()
    for function in nodes:
        if isinstance(function, ast.FunctionDef):
            for node in ast.walk(function):
                if isinstance(node, ast.With) and any(
                    isinstance(item.context_expr, ast.Call)
                    and ast.unparse(item.context_expr.func) in GUARDS
                    for item in node.items
                ):
                    inside |= set(ast.walk(node))
    return inside


def imports(nodes, package, module):
    """(line, dotted name) of everything imported anywhere in a file, for types too."""
    below_guards = guarded(nodes)
    for node in nodes:
        of_part = isinstance(node, ast.ImportFrom) and f"{package}.optional." in f"{node.module}"
        if of_part and node in below_guards:
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


def folder_of(parts):
    """The folder that a file or a dotted name is in, from its parts below the package."""
    depth = 2 if parts[0] in {"lab", "optional"} else 1
    return "/".join(parts[:depth]).removesuffix(".py")


def rank(folder):
    """Where a folder stands in the order of imports; None if it has no place there."""
    for place, together in enumerate(CORE):
        if folder in together:
            return place
    if folder in BETWEEN:
        return len(CORE)
    if folder in OPTIONAL:
        return len(CORE) + 1
    if folder in LAB:
        return len(CORE) + 2 + LAB.index(folder)
    return None


def crosses(own, other):
    """What is wrong with an import of a folder by another; nothing if it is allowed."""
    if own == other or rank(other) < rank(own) or rank(other) == rank(own) < len(CORE):
        return None
    return "another part" if rank(other) == rank(own) else "a later folder"


def names_of(dotted, nodes):
    """Lines on which a string names a folder of the package."""
    for node in nodes:
        if (
            isinstance(node, ast.Constant)
            and isinstance(node.value, str)
            and (f"quasistatic_ref.{dotted}" in node.value or node.value.startswith(f".{dotted}"))
            and ":`" not in node.value  # a reference of a docstring is no import
        ):
            yield node.lineno


def kinds_asked_for(nodes, name):
    """Lines on which a file asks which cone or which joint something is."""
    for node in nodes:
        asks = isinstance(node, ast.Compare) or (
            isinstance(node, ast.Call) and ast.unparse(node.func) in {"isinstance", "issubclass"}
        )
        names = {n.id for n in ast.walk(node) if isinstance(n, ast.Name)} if asks else set()
        of_cone = names & CONES and not within(name, OF_CONES)
        is_word = isinstance(node, ast.Constant) and node.value in OF_JOINTS
        if of_cone or (is_word and not within(name, READERS)):
            yield node.lineno


def within(inside, places):
    """Whether a file is one of some places, or below one of them."""
    return any(inside == place or inside.startswith(place + "/") for place in places)


def violations(root):
    """Sentences, one for each import that crosses a wall."""
    found = []
    package = root.name
    for path in sorted(root.rglob("*.py")):
        inside = path.relative_to(root)
        name = inside.as_posix()
        parts = inside.parts
        if inside.name == "__init__.py":
            parts = (*parts[:-1], "x")
        own = (
            None if name in {FACE, "lab/__init__.py", "optional/__init__.py"} else folder_of(parts)
        )
        if own is not None and rank(own) is None:
            found.append(f"{name}: {own} is no folder of the package")
            continue
        nodes = list(ast.walk(ast.parse(path.read_text())))
        if parts[0] != "lab" and name != LAB_DOOR:
            found += [f"{name}:{line}: names the lab" for line in names_of("lab", nodes)]
        if parts[0] not in {"lab", "optional"} and name != PARTS_DOOR:
            found += [f"{name}:{line}: names a part" for line in names_of("optional", nodes)]
        found += [f"{name}:{line}: asks for a kind" for line in kinds_asked_for(nodes, name)]
        for line, imported in imports(nodes, package, (package, *inside.with_suffix("").parts)):
            top, *rest = imported.split(".")
            if top == package:
                if not rest or rest[0].startswith("__"):
                    continue
                other = folder_of(rest)
                if rank(other) is None:
                    found.append(f"{name}:{line}: imports {imported}, which is no folder")
                elif own is None:
                    found.append(f"{name}:{line}: imports {imported}, from a later folder")
                elif wrong := crosses(own, other):
                    found.append(f"{name}:{line}: imports {imported}, from {wrong}")
                else:
                    closed = [to for to, shut in CLOSED.items() if within("/".join(rest), shut)]
                    found += [
                        f"{name}:{line}: imports {imported}, which is closed to {to}"
                        for to in closed
                        if within(name, [to])
                    ]
            elif top in WALLS and not within(name, WALLS[top]):
                found.append(f"{name}:{line}: imports {top}")
    return found
