"""Parts can be taken away, with their tests; the grasp keeps its bits, and a word says its part."""

import re
import shlex
import shutil
import sys
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from importlib import import_module
from itertools import combinations
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest

from quasistatic_ref import (
    Body,
    Box,
    Cylinder,
    Extension,
    InputError,
    load_scenario,
    load_trajectory,
    save_trajectory,
    solve_step,
)
from quasistatic_ref.parts import is_there, needing
from quasistatic_ref.step.cones import cone
from tests.contact.still import in_world
from tests.helpers import random_step
from tests.made import loaded_mesh, solid_pair
from tests.pages import PACKAGE, ROOT
from tests.processes import python

MODELS = ROOT / "models"
PARTS = sorted(path.parent.name for path in PACKAGE.glob("optional/*/__init__.py"))
GRASP = "bunny_grasp"
STEPS = 10


@pytest.fixture(scope="module")
def copied(tmp_path_factory):
    """A folder with the package as a wheel has it, but for ``lab/``."""
    folder = tmp_path_factory.mktemp("copied")
    ignored = shutil.ignore_patterns("__pycache__", "lab")
    package = shutil.copytree(PACKAGE, folder / "quasistatic_ref", ignore=ignored)
    shutil.copytree(MODELS, package / "models")
    return folder


def arrays_of(path):
    """The bits of all arrays of a trajectory."""
    with np.load(path) as file:
        return {name: file[name].tobytes() for name in file.files if name != "header"}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Those of the first steps of the grasp."""
    run = load_scenario(GRASP, steps=STEPS).run()
    return arrays_of(save_trajectory(tmp_path_factory.mktemp("whole") / "run.npz", run))


def in_turn(names):
    """Seven selections of names: of any two names, each is once there without the other.

    That is so as none of the 35 ways to take part in three of seven is within another.
    """
    ways = [*combinations(range(7), 3)]
    assert len(names) <= len(ways)
    return [[name for name, way in zip(names, ways, strict=False) if k in way] for k in range(7)]


GONE = [[""], *(pytest.param(names, marks=pytest.mark.long) for names in in_turn(PARTS))]


@pytest.mark.parametrize("gone", GONE, ids=lambda gone: " ".join(gone) or "all parts")
def test_the_grasp_has_the_same_bits_where_parts_are_deleted(copied, whole, gone):
    with ExitStack() as missing:
        for name in gone:
            missing.enter_context(deleted(copied / "quasistatic_ref" / "optional" / name))
        python("-m", "quasistatic_ref", "run", GRASP, "--set", f"steps={STEPS}", cwd=copied)
    assert arrays_of(copied / "results" / f"{GRASP}.npz") == whole


@contextmanager
def deleted(folder):
    """A folder is not there for a while."""
    with TemporaryDirectory() as elsewhere:
        kept = shutil.move(folder, Path(elsewhere) / "kept")
        try:
            yield
        finally:
            shutil.move(kept, folder)


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    """A copy of the package and of its tests, next to links to all else."""
    folder = tmp_path_factory.mktemp("checkout")
    for path in ROOT.iterdir():
        if path in (PACKAGE, ROOT / "tests"):
            ignored = shutil.ignore_patterns("__pycache__")
            shutil.copytree(path, folder / path.name, ignore=ignored)
        elif not path.name.startswith(".git"):
            (folder / path.name).symlink_to(path)
    return folder


OF_LAB = [f"lab/{name}" for name in ("bench", "claims", "reality", "study", "vectors")]
EACH = [*(f"optional/{name}" for name in PARTS), *OF_LAB]
FOLDERS = [EACH, *in_turn(EACH)]
WITH = {"lab/vectors": "lab/program"}
"""A folder of the lab, and the one that leaves with it."""
SKIPPED = re.compile(r"^SKIPPED \[\d+\] tests/(\w+/[\w/]+)(?:\.py)?:", re.MULTILINE)
OF_CORE_AND_PARTS = {
    "analytic/test_blocks",
    "analytic/test_closed_forms",
    "analytic/test_grasp",
    "certify/test_check_solution",
    "certify/test_optimum",
    "certify/test_groups",
    "contact/solids/test_solid_pair",
    "errors/test_python_mistakes",
    "errors/test_spoilt_files",
    "files/test_mesh_files",
    "model/joints/test_ball",
    "model/test_named",
    "properties/test_forgeries",
    "shapes/test_a_shape_added",
    "solve/test_any_solver",
    "solve/test_defaults",
    "solve/test_interruptible",
    "solve/test_known_issues",
    "solve/test_solver",
    "solve/test_step_problem",
    "step/test_plain_data",
}
"""Tests of the core that ask a part, too, and leave with it. The list only shrinks."""


@pytest.mark.long
@pytest.mark.parametrize("folders", FOLDERS, ids=lambda folders: " ".join(folders)[:20])
def test_other_tests_are_collected_where_parts_are_deleted_with_theirs(checkout, folders):
    with ExitStack() as gone:
        for name in [*folders, *(WITH[name] for name in folders if name in WITH)]:
            for place in ("quasistatic_ref", "tests"):
                if (folder := checkout / place / name).is_dir():
                    gone.enter_context(deleted(folder))
        quiet = "--collect-only", "-qq", "-rs", "-p", "no:cacheprovider", "--assert=plain"
        said = python("-m", "pytest", *quiet, "tests", cwd=checkout).stdout
    left_out = set(SKIPPED.findall(said))
    of_core = {name for name in left_out if name.split("/")[0] not in ("lab", "meta", "optional")}
    assert of_core - OF_CORE_AND_PARTS == set()


@pytest.fixture
def without(monkeypatch):
    """A function that hides the folder of a part, or of all parts."""

    def hide(folder):
        missing = f"quasistatic_ref.{folder.replace('/', '.')}"

        def find_spec(name, path, target=None):
            if name == missing:
                raise ModuleNotFoundError(name=name)

        for name in [name for name in sys.modules if f"{name}.".startswith(f"{missing}.")]:
            monkeypatch.delitem(sys.modules, name)
        finder = SimpleNamespace(find_spec=find_spec)
        monkeypatch.setattr(sys, "meta_path", [finder, *sys.meta_path])
        cone.cache_clear()  # it may have the ellipsoid from an earlier test

    return hide


OPTIONS = {
    'law = "coulomb"': ("coulomb", ["--law", "coulomb"]),
    'distances = "coal"': ("curved", ["--set", "distances=coal"]),
    "strict": ("doctor", ["--strict"]),
    'cone = "ellipsoid"': ("ellipsoid", ["--cone", "ellipsoid"]),
    "fast": ("daqp", ["--fast"]),
    'record = "forces"': ("forces", ["--set", "record=forces"]),
    "qpsolvers:clarabel": ("qpsolvers", ["--backend", "qpsolvers:clarabel"]),
    "a .ply cloud": ("mesh_formats", ["--set", "bodies.bunny.cloud={folder}/bunny.ply"]),
    "view": ("show", ["--view"]),
}
"""Words of ``run``, and of each the part that it needs, and the options, in some folder."""


@pytest.mark.parametrize("word", OPTIONS)
@pytest.mark.parametrize("every", [False, True], ids=["a part", "all parts"])
def test_a_word_is_refused_in_a_sentence_that_names_its_part(without, word, every, tmp_path, cli):
    part, options = OPTIONS[word]
    gone = "optional" if every else f"optional/{part}"
    without(gone)
    (tmp_path / "bunny.ply").touch()
    in_folder = [shlex.quote(option.format(folder=tmp_path)) for option in options]
    command = ["run", GRASP, "--set", "steps=1", "--out", tmp_path, *in_folder]
    assert f"{word} needs quasistatic_ref/{gone}\n" in cli(*command, status=2).err


STEP = random_step(0)
NAMES = {
    "Body.of_pinocchio": ("pinocchio_models", lambda: Body.of_pinocchio("r", pin.Model())),
    "forces": ("forces", lambda: solve_step(STEP).forces),
    "a .stl mesh": ("mesh_formats", lambda: loaded_mesh(Path("m.stl"))),
    "contact of cylinder and box": (
        "curved",
        lambda: solid_pair(
            "can", in_world(Cylinder(0.02, 0.05)), in_world(Box(np.full(3, 0.1)), (0.0, 0.0, 0.2))
        ),
    ),
    "a function as backend": ("extensions", lambda: solve_step(STEP, max)),
    "extension": (
        "extensions",
        lambda: solve_step(STEP, extension=Extension(lambda symbols: [])),
    ),
}
"""Names of Python, and of each the part that it needs."""


@pytest.mark.parametrize("name", NAMES)
def test_a_name_of_python_needs_its_part(without, name):
    part, use = NAMES[name]
    without(f"optional/{part}")
    with pytest.raises(InputError, match=f"(^|: ){name} needs quasistatic_ref/optional/{part}$"):
        use()


def test_a_missing_part_is_one_sentence_and_a_mistaken_name_is_no_missing_part(without):
    with pytest.raises(ModuleNotFoundError, match=r"optional\.show\.tabel"), needing("tables"):
        import_module("quasistatic_ref.optional.show.tabel")
    with pytest.raises(ModuleNotFoundError, match="no_package_of_this_name"), needing("tables"):
        import_module("no_package_of_this_name")
    assert is_there("page_text")
    without("optional/show")
    assert not is_there("page_text")


def test_a_run_without_doctor_is_recorded_and_written(without, tmp_path, cli):
    scenario = load_scenario("sphere_spin", steps=2)
    whole = scenario.run()
    without("optional/doctor")
    run = scenario.run()
    unknown = ("quasi_dynamic_number", "largest_boundary_layer")
    nothing = {**dict.fromkeys(unknown), "findings": ()}
    assert run.header == replace(whole.header, **nothing)
    assert run.arrays.keys() == whole.arrays.keys()
    cli("run", "sphere_spin", "--set", "steps=2", "--out", tmp_path, "--quiet")
    assert load_trajectory(tmp_path / "sphere_spin.npz").steps == 2


def test_without_pages_data_show_their_fields(without):
    without("optional/show")
    scenario = load_scenario("block_push", steps=1)
    assert repr(STEP).startswith("StepData(h=0.01, K_q=array(")
    assert "phi=array(" in repr(STEP.contacts)
    assert repr(scenario.simulator()).startswith("<Simulator of <System of pusher, block: n_a = 1")
    run = scenario.run()
    assert repr(run).startswith("Trajectory(header=Header(h=0.01, ")
    assert run._repr_html_() is None
    with pytest.raises(InputError, match=r"^to_pandas needs quasistatic_ref/optional/show$"):
        run.to_pandas()
