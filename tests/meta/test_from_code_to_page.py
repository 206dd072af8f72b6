"""What exists in code stands on its page, in its extra and in its table."""

import ast
import re
import tomllib

import numpy as np

import quasistatic_ref as qr
from quasistatic_ref.cli.main import COMMANDS, command_parser
from quasistatic_ref.cli.main import _actions as leaves
from quasistatic_ref.lab.claims import registry
from quasistatic_ref.lab.program.rows import cone_table
from quasistatic_ref.solve.backends import BACKENDS
from quasistatic_ref.step.cones import CONES, ELLIPSOID, cone
from tests.meta.remedies import assert_alike, assert_among
from tests.optional.doctor.mistake_scenes import GRAVE
from tests.oracles.cones import COUNTS
from tests.pages import PACKAGE, ROOT
from tests.tolerances import ROUNDING
from validation.check_solution import cone_rows


def text(name):
    """A file of the repository."""
    return (ROOT / name).read_text("utf-8")


CALLS = {"Finding", "_finding", "finding"}


def names_of_findings(folder):
    """The names that code gives to findings: words in the first argument, or of a helper."""
    for path in (PACKAGE / "optional" / folder).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in {
                "Finding",
                "_finding",
                "finding",
            }:
                words = (n.value for n in ast.walk(node.args[0]) if isinstance(n, ast.Constant))
                yield from filter(lambda word: isinstance(word, str), words)


def test_every_finding_is_on_its_page():
    assert_alike(
        names_of_findings("doctor"),
        GRAVE,
        'The finding "{}" has no row: add | `{}` | ... to docs/findings.md, and a scene to '
        "tests/optional/doctor/cases/findings.toml",
        'docs/findings.md tells of the finding "{}", which no code gives: remove its row',
    )
    file = "docs/guides/does_my_contact_hold.md"
    table = text(file).partition("| finding | when |\n|---|---|\n")[2].partition("\n\n")[0]
    rows_of_states = [row.split("|")[1] for row in table.splitlines()]
    assert_alike(
        names_of_findings("mujoco"),
        re.findall(r"\w+", " ".join(rows_of_states)),
        f'The finding "{{}}" of a state has no row: add it to {file}',
        f'{file} tells of the finding "{{}}", which no code gives: remove its row',
    )


def test_every_cone_is_on_its_pages_and_in_its_tables():
    file = "docs/cones.md"
    rows = re.findall(r"^\| `([\w-]+)`.* \|$", text(file), re.MULTILINE)
    assert_alike(
        CONES,
        rows,
        f"The cone {{}} is not in the table of {file}: add a row",
        f"{file} has a row for {{}}, which is no cone of step/cones.py: remove it",
    )
    for file, row in {
        "docs/guides/file_formats.md": '`"{}"`',
        "validation/vectors/README.md": "\n| {} |",
    }.items():
        polyhedral = {name for name in CONES if name != ELLIPSOID or "formats" in file}
        found = [name for name in polyhedral if row.format(name) in text(file)]
        assert_among(polyhedral, found, f"The cone {{}} is not in {file}: add it to the cones")
    tested = {re.sub(r"-\d+$", "-K", name) for name in COUNTS}
    assert_alike(
        CONES,
        tested,
        "How many multipliers the cone {} has is not tested: add it to COUNTS in "
        "tests/oracles/cones.py",
        "COUNTS in tests/oracles/cones.py has {}, which is no cone: remove it",
    )


def test_the_plain_program_and_the_checker_have_the_rows_of_every_cone():
    """By value: two tables of the same number of rows can be two cones."""
    for name in (name.replace("K", "6") for name in CONES):
        if not cone(name).polyhedral:
            continue
        matrix = cone(name).matrix  # of gap, slip_1, slip_2, spin
        for file, known, columns in (
            ("quasistatic_ref/lab/program/rows.py", cone_table, [1, 2, 3]),
            ("validation/check_solution.py", cone_rows, [1, 2, 0, 3]),
        ):
            try:
                rows = np.array(known(name, 6), dtype=float)
            except ValueError as error:
                raise AssertionError(f"{file} lacks the cone {name}: add its rows") from error
            other = f"{file} has other rows of the cone {name} than quasistatic_ref/step/cones.py"
            assert rows.shape == matrix[:, columns].shape, other
            assert abs(rows - matrix[:, columns]).max() < ROUNDING, other


def test_every_backend_is_in_its_extras_and_its_table():
    project = tomllib.loads(text("pyproject.toml"))["project"]
    extras = project["optional-dependencies"]
    required = project["dependencies"]
    for extra in ("test", "study"):
        listed = {re.split(r"[<>=; ]", line)[0] for line in (*required, *extras[extra])}
        assert_among(
            [backend.to_install for backend in BACKENDS.values()],
            listed,
            f"The backend of {{}} is tested nowhere without it: add it to the extra {extra} of "
            "pyproject.toml",
        )
    file = "quasistatic_ref/lab/study/solvers.toml"
    solvers = tomllib.loads(text(file))
    assert_among(BACKENDS, solvers, f"The backend {{}} has no table: add [{{}}] to {file}")
    assert_alike(
        solvers.keys() - BACKENDS.keys(),
        [name for name, table in solvers.items() if "doors" in table],
        f"{file} has no doors of {{}}, with which no step is solved: add doors",
        f"{file} has doors of {{}}, which is a backend of steps: remove doors",
    )


def test_every_public_name_is_in_the_api():
    assert_alike(
        {*qr.__all__, *(f"figures.{name}" for name in qr.figures.__all__)}
        - {"__version__", "figures"},
        re.findall(r"~quasistatic_ref\.([\w.]+)", text("docs/api/index.md")),
        "{} is public and on no page: add ~quasistatic_ref.{} to docs/api/index.md",
        "docs/api/index.md shows {}, which is not public: remove it",
    )


def test_every_claim_is_registered():
    folder = PACKAGE / "lab" / "claims"
    modules = {
        ".".join(path.relative_to(folder).with_suffix("").parts)
        for path in folder.rglob("*.py")
        if re.search(r"^\w+ = Claim\(|\bClaim\(\n", path.read_text("utf-8"), re.MULTILINE)
    }
    assert_alike(
        modules,
        [module for modules in registry.MODULES.values() for module in modules],
        "The claims of {} are in no section: add it to MODULES in lab/claims/registry.py",
        "MODULES in lab/claims/registry.py has {}, which has no claim: remove it",
    )


def test_every_command_is_on_a_page_that_people_write():
    pages = [ROOT / "README.md", *ROOT.glob("docs/*.md"), *ROOT.glob("docs/guides/*.md")]
    every = "\n".join(page.read_text("utf-8") for page in pages)
    assert_among(
        [leaf.prog for leaf in leaves(command_parser(COMMANDS)) if leaf.prog not in every],
        (),
        "No page says `{}`: add it to the page of docs/ on what it is for",
    )


def test_every_command_is_called_by_a_test():
    tests = [path.read_text("utf-8") for path in ROOT.glob("tests/**/test_*.py")]
    called = [
        name for name in COMMANDS if any(re.search(rf'[(\[]"{name}"', test) for test in tests)
    ]
    assert_among(COMMANDS, called, 'No test calls cli("{}", ...): add a file to tests/cli')


def test_every_option_says_what_it_does_in_help_and_so_on_the_page_of_options():
    silent = [
        f"{leaf.prog} {action.option_strings[-1]}"
        for leaf in leaves(command_parser(COMMANDS))
        for action in leaf._actions
        if action.option_strings and not action.help
    ]
    assert_among(silent, (), "{} has no line in --help: add help=... where it is declared")
