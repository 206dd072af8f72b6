"""The front door: every name is there in every order of imports, documented, with an example."""

import ast
import doctest
import inspect
import sys
import tempfile
from importlib import import_module
from itertools import chain
from operator import attrgetter
from typing import get_type_hints

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import figures
from tests.extras import marked_parameters
from tests.pages import PACKAGE, ROOT, fenced
from tests.processes import python

NAMES = [name for name in qr.__all__ if name not in {"__version__", "figures"}]
FIGURES = [f"figures.{name}" for name in figures.__all__]
EXTRAS = {"step_jax": "jax", "save_view": "view"}
"""Names whose examples need an extra."""
ASKED = (
    "System Body Sphere Box Capsule Cylinder HalfSpace PointCloud ContactPair PlacedShape "
    "Simulator rollout solve_step verify standard_form StepProblem StepData Contacts Extra "
    "Extension derivatives load_scenario Trajectory Recorder "
    "QuasistaticError InputError StepNotSolved RunFailed"
)
"""What a scene in Python needs, from building it to catching what goes wrong."""
BEFORE_OR_AFTER = """
import sys, importlib
import cvxpy, pinocchio, coal  # once: what is imported again below is the package alone

for folder in ("simulate", "solve", "cli.main"):  # each before and after the names
    for first, then in ((folder, None), (None, folder)):
        for module in [m for m in sys.modules if m.partition(".")[0] == "quasistatic_ref"]:
            del sys.modules[module]
        qr = importlib.import_module("quasistatic_ref")
        if first: importlib.import_module(f"quasistatic_ref.{first}")
        names = [name for name in qr.__all__ if name not in ("__version__", "figures")]
        values = {name: getattr(qr, name) for name in names}
        if then: importlib.import_module(f"quasistatic_ref.{then}")
        for name, value in values.items():
            home = importlib.import_module(f"quasistatic_ref.{qr._HOME[name]}")
            assert value is getattr(home, name) is getattr(qr, name), (name, folder)
print("good")
"""


USERS = """
import cvxpy as cp
import numpy as np
from numpy.typing import NDArray

import quasistatic_ref as qr

Array = NDArray[np.float64]
ball = qr.Body.of_shape("ball", qr.Sphere(0.05), mass=0.3, xyz=(0, 0, 0.05))
system: qr.System = qr.System([ball])
scenario = qr.load_scenario("block_push", steps=3)
simulator = scenario.simulator()


def controller(t: float, q: Array) -> list[float]:
    return [0.01 * t + 0.1 * q[1]]


def solver(P: Array, q: Array, G: Array, h: Array) -> tuple[Array, Array, str]:
    return np.zeros_like(q), np.zeros_like(h), "failed"


def limit(symbols: qr.Symbols) -> list[cp.Constraint]:
    return [symbols.delta_q[0] <= 1e-5]


run = qr.rollout(simulator, scenario.system.q_start, controller, 3, progress=False)
step = run.step_data(0)
solution = qr.solve_step(step, solver, extension=qr.Extension(limit))
delta_q: Array = solution.delta_q
lost: float = qr.optimality_residuals(qr.standard_form(step), delta_q, solution.lam).worst
slide: Array = qr.derivatives(simulator, [0.0] * 8, [0.1]).along(q_bar_a=[1.0])
contacts = qr.Contacts(["a"], [0.0], [[0, 0, 1]], [[1, 0, 0]], [[0, 1, 0]], [], [0.5], [0], [4])
names: list[str] = [finding.name.upper() for finding in run.findings]
if not (verdict := qr.verify(solution)):
    print(verdict.reason.upper())
q_start: Array = scenario.system.q_start
depth: Array = run.phi.min(axis=0)
point: qr.ClosestPoints = simulator.step(q_start, [0.1]).points
form: qr.StandardForm = qr.standard_form(step)
state: qr.State = scenario.system.at(q_start)
targets: qr.Targets = scenario.targets
run.phy  # type: ignore[attr-defined]  # no array of a trajectory
solution.certificate.kind == "exakt"  # type: ignore[comparison-overlap]  # no kind of proof
qr.solve_step(step, certify="exact")  # type: ignore[arg-type]  # no such word
qr.Simulator(system, [], h=0.01, law="coloumb")  # type: ignore[arg-type]  # misspelt
qr.rollout(simulator, q_start, [], 1, record="all")  # type: ignore[arg-type]  # no such word
solution.delta_qq  # type: ignore[attr-defined]  # misspelt: mypy has to see it
qr.solve_stepp  # type: ignore[attr-defined]  # misspelt: mypy has to see it
"""
"""What users write: the last seven lines are needed errors, so nothing here is of any type."""


def test_the_names_are_those_that_dir_shows():
    assert dir(qr) == sorted(qr.__all__)
    assert set(ASKED.split()) <= set(dir(qr))
    assert len(set(NAMES)) == len(NAMES)


def typed_only(block):
    """Whether a part of a module is for type checkers alone."""
    return isinstance(block, ast.If) and getattr(block.test, "id", "") == "TYPE_CHECKING"


def test_type_checkers_see_the_names_of_the_tables_of_homes():
    seen = {
        (name.name, name.asname, home.module)
        for door in (qr, figures)
        for block in filter(typed_only, ast.parse(inspect.getsource(door)).body)
        for home in block.body
        for name in home.names
    }
    homes = {(name, name, f"quasistatic_ref.{home}") for name, home in qr._HOME.items()}
    drawn = "quasistatic_ref.optional.show.figures."
    homes |= {(name, name, drawn + home) for name, home in figures._HOME.items()}
    alike = "a name stands in its table of homes, and in the re-exports below the table"
    assert seen == homes | {("figures", "figures", "quasistatic_ref")}, alike


def test_arguments_that_type_checkers_see_are_those_that_there_are():
    """Of the classes that make arrays of lists, whose fields are arrays."""
    seen = 0
    for path in PACKAGE.rglob("*.py"):
        if "TYPE_CHECKING:  # what is made of lists" not in (text := path.read_text("utf-8")):
            continue
        place = path.relative_to(ROOT).with_suffix("")
        for node in (node for node in ast.parse(text).body if isinstance(node, ast.ClassDef)):
            blocks = (block.body for block in filter(typed_only, node.body))
            for init in (one for one in chain(*blocks) if isinstance(one, ast.FunctionDef)):
                of_class = inspect.signature(
                    getattr(import_module(".".join(place.parts)), node.name)
                )
                parameters = of_class.parameters.values()
                assert [arg.arg for arg in init.args.args[1:]] == [p.name for p in parameters]
                optional = [p for p in parameters if p.default is not p.empty]
                assert len(init.args.defaults) == len(optional)
                seen += 1
    assert seen >= 4


def test_the_import_of_the_package_loads_no_other_module():
    done = python("-c", "import sys, quasistatic_ref; print(*sys.modules)")
    loaded = set(done.stdout.split())
    assert not loaded & {"numpy", "cvxpy", "pinocchio", "coal"}
    assert {name for name in loaded if name.startswith("quasistatic_ref.")} == set()


@pytest.mark.long
def test_a_user_s_file_has_types(tmp_path):
    example, *_ = fenced((ROOT / "README.md").read_text("utf-8"), "python")
    (tmp_path / "readme.py").write_text(example, "utf-8")
    (tmp_path / "users.py").write_text(USERS, "utf-8")
    python("-m", "mypy", "--strict", "--config-file=", "readme.py", "users.py", cwd=tmp_path)
    (tmp_path / "users.py").write_text(USERS.replace("# type: ignore", "#"), "utf-8")
    call = ("-m", "basedpyright", "--pythonpath", sys.executable, "users.py")
    found = python(*call, cwd=tmp_path, status=1).stdout
    assert 'Cannot access attribute "phy" for class "Trajectory"' in found
    assert "\"Literal['exakt']\" have no overlap" in found


def functions_of(name):
    """What a public name annotates: itself, and the functions of a class and of its bases."""
    named = attrgetter(name)(qr)
    yield named
    for kind in [k for k in getattr(named, "__mro__", ()) if k.__module__.startswith("quasi")]:
        for member in vars(kind).values():
            of_property = getattr(member, "fget", None) or getattr(member, "func", None)
            function = of_property or getattr(member, "__func__", member)
            if inspect.isfunction(function):
                yield function


@pytest.mark.parametrize("name", marked_parameters([*NAMES, *FIGURES], EXTRAS))
def test_every_annotation_of_a_name_can_be_resolved(name):
    for annotated in functions_of(name):
        assert isinstance(get_type_hints(annotated), dict)


def test_a_result_ends_in_a_state_and_steps_have_one_default_of_force():
    assert get_type_hints(qr.StepResult)["end"] is qr.State
    steppers = qr.Simulator.step, qr.Simulator.steps, qr.rollout
    assert [inspect.signature(one).parameters["force"].default for one in steppers] == [None] * 3


@pytest.mark.parametrize("name", marked_parameters([*NAMES, *FIGURES], EXTRAS))
def test_every_name_says_what_it_is_with_an_example_that_runs(name, tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))  # some examples write a file
    said = attrgetter(name)(qr).__doc__
    example = doctest.DocTestParser().get_doctest(said, {"qr": qr, "np": np}, name, None, None)
    assert example.examples, f"{name} has no example: add one to its docstring"
    assert doctest.DocTestRunner().run(example).failed == 0


def test_without_jax_one_sentence_names_the_extra(monkeypatch):
    simulator = qr.load_scenario("block_push").simulator()
    monkeypatch.setitem(sys.modules, "jax", None)
    with pytest.raises(qr.InputError, match=r"pip install 'quasistatic-ref\[jax\]'"):
        qr.step_jax(simulator)


def test_no_name_is_that_of_a_module_which_python_would_put_in_its_place():
    modules = {path.stem for path in PACKAGE.iterdir()}
    assert {"simulate", "step", "errors"} <= modules
    assert not modules & set(NAMES)


@pytest.mark.long
def test_every_name_is_reliable_in_every_order_of_imports():
    assert python("-W", "error", "-c", BEFORE_OR_AFTER).stdout == "good\n"


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="has no attribute 'simulat'"):
        attrgetter("simulat")(qr)
