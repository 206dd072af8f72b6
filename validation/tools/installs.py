"""What each extra is for, as commands that need it; ``check_installs.py`` runs them."""

import re

from validation.tools.scripts import ROOT

CHECKOUT = "checkout:"
"""In front of commands whose programs or pages are in the checkout and not in the wheel."""

MODELS = ROOT / "models"
OWN = tuple(
    sorted(
        path.stem for path in MODELS.glob("*/*.toml") if "package://" not in path.read_text("utf-8")
    )
)
"""Scenarios whose robots come along."""

SHELL = re.compile(r"^```(?:sh|bash|console)\n(.*?)^```", re.MULTILINE | re.DOTALL)
EXAMPLES = ROOT / "docs" / "examples"


def shell_lines(markdown: str) -> tuple[str, ...]:
    """Every command line in the fenced shell blocks of a text, without prompts and comments."""
    lines = [line for block in SHELL.findall(markdown) for line in block.splitlines()]
    stripped = [line.removeprefix("$ ").partition(" #")[0].strip() for line in lines]
    return tuple(line for line in stripped if line and not line.startswith("#"))


WALK = (ROOT / "docs" / "guides" / "first_scene.md").read_text("utf-8")
"""From a URDF to a picture: the page of which a newcomer types every command."""
WALK_FILES = {
    path.name: path.read_text("utf-8")
    for pattern in ("first_scene/*", "opinion/*", "derivatives/*")
    for path in sorted(EXAMPLES.glob(pattern))
}
"""Its files, and those that other pages give to be downloaded."""

ROBOTS = (
    "quasistatic-ref run panda_push --set steps=20 --json",
    "quasistatic-ref run allegro_turn --set steps=5 --json",
)
VIEW = ("quasistatic-ref run two_finger_pinch --set steps=20 --view",)
TARGETS = (
    "python -c \"import quasistatic_ref as qr; qr.joint_targets(qr.load_scenario('arm_push'), "
    "'arm/tip', [{'t': 1.0, 'xyz': (0, 0.05, 0), 'relative': True}])\"",
    f"quasistatic-ref targets {MODELS}/arm_push/arm_push.toml --link arm/tip "
    f"--poses {MODELS}/arm_push/poses/line.toml",
)
ENGINES = (
    "quasistatic-ref validate mujoco_rows",
    "quasistatic-ref opinion block.xml --tolerance 0.01 --out opinion",
)
FAST = (
    'python -c "import os, sys; '
    "os.environ['QUASISTATIC_REF_CC'] = sys.executable + ' -m ziglang cc'; "
    'from quasistatic_ref.optional.fast.compiled.library import why_not; sys.exit(why_not())"',
    "quasistatic-ref run sphere_spin --set steps=20 --json",
)
"""With the compiler that comes along, also where the system has one."""
PARQUET = ("quasistatic-ref study problems export --to parquet --out problems",)
PANDAS = (
    'python -c "from quasistatic_ref import load_scenario as load; '
    "print(load('sphere_spin', steps=5).run(progress=False).to_pandas())\"",
)
JAX = ("quasistatic-ref figures plan_a_push --numbers",)
STUDY = (
    "quasistatic-ref study run default --quick --out study",
    "quasistatic-ref study report study --out report",
    "quasistatic-ref study pack study",
    "quasistatic-ref study merge study --out merged",
    "quasistatic-ref study ask capped_wedge/0.1/0 qpsolvers:daqp",
    "quasistatic-ref study problems list",
    "quasistatic-ref study problems export study/problems --to parquet --out qpbenchmark",
    "quasistatic-ref study problems check",
    "quasistatic-ref study problems export --to npz --families limits --every 20 --out problems",
    "quasistatic-ref study run sequences --quick --out sequences",
)

COMMANDS = {
    "base": (
        "quasistatic-ref --help",
        "quasistatic-ref demo --out demo --json",
        "python readme.py",
        *shell_lines(WALK),
        *(f"quasistatic-ref run {name} --json" for name in OWN if name != "bunny_grasp"),
        "quasistatic-ref run bunny_grasp --set contacts.grip.mu_omega=0 --set steps=20 --json",
        "quasistatic-ref run sphere_spin --set steps=5 --out short --backend osqp --json",
        "quasistatic-ref run sphere_spin --set steps=5 --out short --cone ellipsoid",
        "quasistatic-ref account results/stack.npz --html account.html --figure account.png",
        "quasistatic-ref extract results/stack.npz --step 5 -o step.json",
        "quasistatic-ref solve step.json -o solution.json",
        "quasistatic-ref verify step.json solution.json",
        "quasistatic-ref inspect bunny_grasp",
        f"quasistatic-ref body {MODELS}/bunny_grasp/bunny.obj --mass 0.2 --out bunny",
        "quasistatic-ref backends",
        "quasistatic-ref completion bash",
        "quasistatic-ref schema",
        "quasistatic-ref vectors own --layer qp --out answers",
        "quasistatic-ref vectors check answers",
        "quasistatic-ref vectors report answers --implementation 'own answers' --out badge.svg",
        "quasistatic-ref vectors pack --out archive",
        "quasistatic-ref vectors challenge --layer rows --cases 12 "
        "--command 'python -m quasistatic_ref.lab.program' --out counterexamples",
        "quasistatic-ref serve sphere_spin",
        "quasistatic-ref compare stack results/stack.npz",
        "quasistatic-ref validate incline_sliding",
        "quasistatic-ref figures block_on_a_table door --numbers",
        "quasistatic-ref bench --quick",
    ),
    "robots": ROBOTS,
    "targets": TARGETS,
    "view": VIEW,
    "fast": FAST,
    "engines": ENGINES,
    "drake": ("quasistatic-ref validate drake",),
    "pandas": PANDAS,
    "parquet": PARQUET,
    "diff": ("python diffcp_agrees.py",),
    "jax": JAX,
    "study": STUDY,
    "notebooks": (
        "checkout:python -m validation.tools.notebooks door robot_push --out {out}/notebooks",
    ),
    "docs": ("checkout:python -m sphinx -W -n -q -j 2 -d {out}/docs/trees docs {out}/docs/site",),
    "test": (
        "checkout:python -m pytest -q -p no:cacheprovider tests/meta tests/equations",
        "checkout:ruff check .",
    ),
    "all": (*ROBOTS, *TARGETS, *VIEW, *FAST, *ENGINES, *PARQUET, *PANDAS, *JAX),
}
"""Extra -> command lines; ``{out}`` is the empty folder."""

ACTIONS = {
    "ask", "challenge", "check", "export", "list", "merge", "own", "pack", "problems", "report",
    "run",
}  # fmt: skip
"""Words that name a command below ``study`` or ``vectors``."""
MARKED = ("fast", "jax", "robots", "all")
"""Extras that tests need, by the marker ``extra``."""

REFUSED = {
    "base": {
        "quasistatic-ref run panda_push": "quasistatic-ref[robots]",
        "quasistatic-ref run sphere_spin --set steps=5 --out short --view": "quasistatic-ref[view]",
        "quasistatic-ref run sphere_spin --backend proxqp": "quasistatic-ref[study]",
        "quasistatic-ref study problems export --to parquet": "quasistatic-ref[parquet]",
        "quasistatic-ref figures robot_push": "quasistatic-ref[robots]",
        "quasistatic-ref figures plan_a_push": "quasistatic-ref[jax]",
        "quasistatic-ref validate mujoco_rows": "quasistatic-ref[engines]",
        "quasistatic-ref validate drake": "quasistatic-ref[drake]",
        "checkout:python -m validation.tools.notebooks": "quasistatic-ref[notebooks]",
        PANDAS[0]: "quasistatic-ref[pandas]",
    }
}
"""Extra -> command that needs another one -> what its sentence must name."""
