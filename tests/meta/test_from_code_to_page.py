"""What exists in code stands on its page, in its extra and in its table."""

import ast
import re
import tomllib

import numpy as np
import yaml

import quasistatic_ref as qr
from quasistatic_ref.cli import main
from quasistatic_ref.files.mesh_files import MESHES
from quasistatic_ref.lab.claims import registry
from quasistatic_ref.lab.program.rows import cone_table
from quasistatic_ref.optional.qp_files.load import READERS
from quasistatic_ref.solve.backends import BACKENDS
from quasistatic_ref.step.cones import CONES, ELLIPSOID, cone
from tests.meta.remedies import assert_none
from tests.optional.doctor.mistake_scenes import GRAVE
from tests.oracles.cones import COUNTS
from tests.pages import PACKAGE, ROOT
from tests.tolerances import ROUNDING
from validation.check_solution import cone_rows

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]
LEAVES = main._actions(main.command_parser(main.COMMANDS))
"""Every command without commands below it."""


def text(name):
    """A file of the repository."""
    return (ROOT / name).read_text("utf-8")


def texts(*patterns):
    """All files of the repository with such paths, in one text."""
    return "\n".join(path.read_text("utf-8") for one in patterns for path in ROOT.glob(one))


def named(pattern, name):
    """What a pattern is in a file of the repository, at the beginnings of lines if it says so."""
    return re.findall(pattern, text(name), re.MULTILINE)


def words_of(cells):
    """The words of some texts."""
    return re.findall(r"\w+", " ".join(cells))


def names_of_findings(folder):
    """The names that code gives to findings: words in the first argument, or of a helper."""
    for path in (PACKAGE / "optional" / folder).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and ast.unparse(node.func).lower().endswith("finding"):
                words = (n.value for n in ast.walk(node.args[0]) if isinstance(n, ast.Constant))
                yield from filter(lambda word: isinstance(word, str), words)


def modules_of_claims():
    """The modules of lab/claims in which claims are made."""
    folder = PACKAGE / "lab" / "claims"
    for path in folder.rglob("*.py"):
        if re.search(r"^\w+ = Claim\(|\bClaim\(\n", path.read_text("utf-8"), re.MULTILINE):
            yield ".".join(path.relative_to(folder).with_suffix("").parts)


def of_findings_and_cones():
    """Rows: names that code has, names elsewhere, what is said of one missing there, or spare."""
    yield (
        names_of_findings("doctor"),
        GRAVE,
        'The finding "{}" has no row: add | `{}` | ... to docs/findings.md, and a scene to '
        "tests/optional/doctor/cases/findings.toml",
        'docs/findings.md tells of the finding "{}", which no code gives: remove its row',
    )
    file = "docs/guides/does_my_contact_hold.md"
    table = text(file).partition("| finding | when |\n|---|---|\n")[2].partition("\n\n")[0]
    yield (
        names_of_findings("mujoco"),
        words_of(row.split("|")[1] for row in table.splitlines()),
        f'The finding "{{}}" of a state has no row: add it to {file}',
        f'{file} tells of the finding "{{}}", which no code gives: remove its row',
    )
    file = "docs/cones.md"
    yield (
        CONES,
        named(r"^\| `([\w-]+)`.* \|$", file),
        f"The cone {{}} is not in the table of {file}: add a row",
        f"{file} has a row for {{}}, which is no cone of step/cones.py: remove it",
    )
    for file, row, others in (
        ("docs/guides/file_formats.md", '`"{}"`', set()),
        ("validation/vectors/README.md", "\n| {} |", {ELLIPSOID}),
    ):
        found = [name for name in CONES if row.format(name) in text(file)]
        yield {*CONES} - others, found, f"The cone {{}} is not in {file}: add it to the cones"
    yield (
        CONES,
        [re.sub(r"-\d+$", "-K", name) for name in COUNTS],
        "How many multipliers the cone {} has is not tested: add it to COUNTS in "
        "tests/oracles/cones.py",
        "COUNTS in tests/oracles/cones.py has {}, which is no cone: remove it",
    )


def packages(lines):
    """The names of packages that an extra asks for."""
    return {re.match(r"[\w.-]+", line)[0] for line in lines}


def of_extras():
    """The same of packages."""
    for extra in ("test", "study"):
        yield (
            [backend.to_install for backend in BACKENDS.values()],
            packages(PROJECT["dependencies"] + EXTRAS[extra]),
            f"The backend of {{}} is tested nowhere without it: add it to the extra {extra} of "
            "pyproject.toml",
        )
    file = "quasistatic_ref/lab/study/solvers.toml"
    solvers = tomllib.loads(text(file))
    yield BACKENDS, solvers, f"The backend {{}} has no table: add [{{}}] to {file}"
    yield (
        solvers.keys() - BACKENDS.keys(),
        [name for name, table in solvers.items() if "doors" in table],
        f"{file} has no doors of {{}}, with which no step is solved: add doors",
        f"{file} has doors of {{}}, which is a backend of steps: remove doors",
    )
    yield (
        EXTRAS,
        words_of(named(r"^\| ((?:`\w+`(?:, )?)+) \|", "docs/quickstart.md")),
        "The extra {} is not in the table of docs/quickstart.md: add a row",
    )
    for_use = EXTRAS.keys() - {"all", "compared", "diff", "test", "docs"}
    yield (
        for_use,
        words_of(EXTRAS["all"]),
        "The extra {} is not in all: add it to all in pyproject.toml, or to the five that are not",
    )
    tested = [name for name in for_use if packages(EXTRAS[name]) <= packages(EXTRAS["test"])]
    calls = re.findall(r"\bextra\((.*)\)", texts("tests/**/*.py"))
    yield (
        for_use,
        tested + re.findall(r'"(\w+)"', " ".join(calls)),
        "Nothing tests the extra {}: add its packages to the extra test of pyproject.toml, or "
        'pytest.mark.extra("{}") to the tests that need it',
    )


def of_formats():
    """The same of extensions of files."""
    file = "tests/errors/test_spoilt_files.py"
    yield (
        MESHES,
        named(r'^    "\w+(\.\w+)": mesh_read', file),
        f"No good {{}} is spoilt: add a row to READERS of {file}, and the file to `good`",
        f"{file} reads {{}}, which is not among MESHES of files/mesh_files.py: add it",
    )
    file = "docs/guides/file_formats.md"
    meshes = named(r"^Meshes are (.*)\.$", file)
    yield MESHES, re.findall(r"\.\w+", *meshes), f"{{}} is not among the meshes of {file}: add it"
    file = "docs/exact_qp.md"
    rows = " ".join(named(r"^\| (`\..*?) \|", file))
    yield READERS, re.findall(r"\.\w+", rows), f"{{}} is not in the table of {file}: add a row"
    tests = texts("tests/optional/qp_files/*.py", "tests/exact/qp/*.py")
    yield (
        READERS,
        [suffix for suffix in READERS if suffix in tests.lower()],
        "No test reads a {}: add one to tests/optional/qp_files",
    )


def of_names_and_commands():
    """The same of what users write."""
    yield (
        {*qr.__all__, *(f"figures.{name}" for name in qr.figures.__all__)}
        - {"__version__", "figures"},
        named(r"~quasistatic_ref\.([\w.]+)", "docs/api/index.md"),
        "{} is public and on no page: add ~quasistatic_ref.{} to docs/api/index.md",
        "docs/api/index.md shows {}, which is not public: remove it",
    )
    pages = texts("README.md", "docs/*.md", "docs/guides/*.md")
    commands = [leaf.prog for leaf in LEAVES]
    yield (
        commands,
        [command for command in commands if command in pages],
        "No page says `{}`: add it to the page of docs/ on what it is for",
    )
    yield (
        main.COMMANDS,
        re.findall(r'[(\[]"([\w-]+)"', texts("tests/**/test_*.py")),
        'No test calls cli("{}", ...): add a file to tests/cli',
    )
    yield (
        [f"{word} of {leaf}" for (word, leaf), given in of_tests().items() if not given],
        (),
        "No test gives the option {}: let one call cli with it, beside those of the command",
    )
    options = {
        f"{leaf.prog} {action.option_strings[-1]}": action.help
        for leaf in LEAVES
        for action in leaf._actions
        if action.option_strings
    }
    yield (
        options,
        [name for name, says in options.items() if says],
        "{} has no line in --help, nor on the page of options: add help=... where it is declared",
    )


def of_tests():
    """Whether a file of tests has an option and its command; one of several that share its help."""
    files = [path.read_text("utf-8") for path in ROOT.glob("tests/**/test_*.py")]
    commands = {}
    for leaf in LEAVES:
        for action in leaf._actions:
            if action.option_strings and action.dest != "help":
                key = action.option_strings[-1], action.help
                commands.setdefault(key, []).append(leaf.prog.split()[-1])
    given = {}
    for (word, _), names in commands.items():
        option = re.compile(rf"{word}(?![\w-])")
        command = re.compile(rf"""["' ]({"|".join(names)})["' ]""")
        given[word, names[0]] = any(option.search(one) and command.search(one) for one in files)
    return given


def of_proofs():
    """The same of claims and theorems."""
    yield (
        modules_of_claims(),
        [module for modules in registry.MODULES.values() for module in modules],
        "The claims of {} are in no section: add it to MODULES in lab/claims/registry.py",
        "MODULES in lab/claims/registry.py has {}, which has no claim: remove it",
    )
    command = "run `quasistatic-ref validate NAME --out validation/results`"
    yield (
        registry.BY_NAME,
        named(r"^### (\w+): holds$", "validation/results/claims.md"),
        f"The claim {{}} does not hold in validation/results/claims.md: {command}",
        f"validation/results/claims.md has the claim {{}}, which is none: {command}",
    )
    source = "validation/formal/theorems.v"
    theorems = named(r"^(?:Theorem|Corollary) (\w+)", source)
    yield (
        theorems,
        named(r"^Print Assumptions (\w+)\.$", source),
        f"The theorem {{}} is not asked for its axioms: add Print Assumptions {{}}. to {source}",
        f"{source} asks for the axioms of {{}}, which is none of its theorems",
    )
    page = named(r"`(\w+)`", "docs/exactness.md")
    yield theorems, page, f"The theorem {{}} of {source} is not in docs/exactness.md: name it"


def test_findings_and_cones_are_on_their_pages_and_in_their_tables():
    assert_none(of_findings_and_cones())


def test_formats_of_files_are_on_their_pages_and_tested():
    assert_none(of_formats())


def test_extras_are_whole_and_on_their_pages():
    assert_none(of_extras())


def test_names_commands_and_options_are_on_pages_and_tested():
    assert_none(of_names_and_commands())


def test_claims_and_theorems_are_registered_and_hold():
    assert_none(of_proofs())


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


def test_the_version_is_the_same_wherever_it_is_said():
    citation = yaml.safe_load(text("CITATION.cff"))
    assert PROJECT["version"] == citation["version"] == qr.__version__
