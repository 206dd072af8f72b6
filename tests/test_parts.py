"""Optional parts that are missing: one sentence for a word that needs one, all else as it was."""

import sys

import numpy as np
import pytest

import quasistatic_ref
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.errors import InputError
from quasistatic_ref.model.readers.clouds import point_cloud
from quasistatic_ref.parts import if_there, needing
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.shapes.placed_shape import Box, Cylinder
from quasistatic_ref.simulate.trajectory import trajectory_read
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.extension import Extension
from tests.helpers import random_step
from tests.tolerances import ROUNDING


@pytest.fixture
def without(monkeypatch):
    """A function that hides the folder of a part."""

    def hide(folder):
        missing = f"quasistatic_ref.optional.{folder}"
        for name in [name for name in sys.modules if f"{name}.".startswith(f"{missing}.")]:
            monkeypatch.delitem(sys.modules, name)
        monkeypatch.setattr(sys, "meta_path", [Missing(missing), *sys.meta_path])

    return hide


class Missing:
    """A finder of modules to which the folder of a part is missing."""

    def __init__(self, folder):
        self.folder = folder

    def find_spec(self, name, path, target=None):
        """As Python asks for it."""
        if name == self.folder:
            raise ModuleNotFoundError(name=name)


def test_a_missing_part_is_one_sentence_and_a_mistaken_name_is_no_missing_part(without):
    with pytest.raises(ModuleNotFoundError, match=r"optional\.show\.tabel"), needing("tables"):
        from quasistatic_ref.optional.show.tabel import data_frame
    with pytest.raises(ModuleNotFoundError, match=r"optional\.show\.tabel"), if_there():
        from quasistatic_ref.optional.show.tabel import data_frame
    with pytest.raises(ModuleNotFoundError, match="no_package_of_this_name"), if_there():
        import no_package_of_this_name  # noqa: F401 it does not exist
    without("show")
    reached = []
    with if_there():
        from quasistatic_ref.optional.show.table import data_frame

        reached.append(data_frame)
    assert reached == []
    sentence = r"^tables needs quasistatic_ref/optional/show$"
    with pytest.raises(InputError, match=sentence), needing("tables"):
        from quasistatic_ref.optional.show.table import data_frame


@pytest.mark.parametrize(
    ("name", "folder"),
    [("smoothed", "derivatives"), ("coulomb_step", "coulomb")],
)
def test_a_name_of_the_front_door_needs_its_part(without, name, folder):
    without(folder)
    with pytest.raises(InputError, match=f"^{name} needs quasistatic_ref/optional/{folder}$"):
        getattr(quasistatic_ref, name)


def test_a_run_without_doctor_is_recorded_and_written(without, tmp_path, cli):
    scenario = load_scenario("sphere_spin", steps=2)
    whole = scenario.run(progress=False)
    without("doctor")
    run = scenario.run(progress=False)
    unknown = ("quasi_dynamic_number", "largest_drag_share", "largest_boundary_layer")
    header = {name: value for name, value in whole.header.items() if name != "scene"}
    assert run.header == {**header, **dict.fromkeys(unknown), "findings": []}
    assert run.arrays.keys() == whole.arrays.keys()
    cli("run", "sphere_spin", "--set", "steps=2", "--out", tmp_path, "--quiet")
    assert trajectory_read(tmp_path / "sphere_spin.npz").steps == 2


def test_without_pages_data_show_their_fields(without):
    without("show")
    scenario = load_scenario("block_push", steps=1)
    step = random_step(np.random.default_rng(0))
    assert repr(step).startswith("StepData(h=0.01, K_q=array(")
    assert "phi=array(" in repr(step.contacts)
    assert repr(scenario.simulator()).startswith("Simulator(system=<")
    run = scenario.run(progress=False)
    assert repr(run).startswith("Trajectory(header={'format': 'quasistatic-ref/trajectory'")
    assert run._repr_html_() is None
    with pytest.raises(InputError, match=r"^to_pandas needs quasistatic_ref/optional/show$"):
        run.to_pandas()


def test_a_solver_a_word_and_a_kind_of_file_need_their_parts(without, tmp_path):
    step = random_step(np.random.default_rng(0))
    without("qpsolvers")
    with pytest.raises(InputError, match=r"^qpsolvers:osqp needs .*/optional/qpsolvers$"):
        solve_step(step, "qpsolvers:osqp")
    assert solve_step(step, "osqp").certificate.kind == "exact"
    without("forces")
    with pytest.raises(InputError, match=r"^forces needs quasistatic_ref/optional/forces$"):
        _ = solve_step(step).forces
    with pytest.raises(InputError, match=r'^record = "forces" needs .*/optional/forces$'):
        load_scenario("sphere_spin", steps=1, record="forces").run(progress=False)
    without("fast")
    with pytest.raises(InputError, match=r"^fast needs quasistatic_ref/optional/fast$"):
        solve_step(step, fast=True)
    without("extensions")
    with pytest.raises(InputError, match=r"^extension needs quasistatic_ref/optional/extensions$"):
        solve_step(step, extension=Extension(lambda symbols: []))
    without("readers")
    with pytest.raises(InputError, match=r"a \.ply cloud needs .*/optional/readers$"):
        point_cloud(tmp_path / "cloud.ply")


def test_a_contact_of_curved_solids_needs_its_part(without):
    can = ShapeInWorld(Cylinder(0.02, 0.05), np.eye(3), np.zeros(3))
    box = ShapeInWorld(Box(np.full(3, 0.1)), np.eye(3), np.array([0.0, 0.0, 0.2]))
    gap = solid_pair("can", can, box).phi
    assert gap == pytest.approx(0.05, rel=ROUNDING)  # 0.2 - 0.1 - 0.05
    without("curved")
    part = "quasistatic_ref/optional/curved"
    with pytest.raises(InputError, match=f"^can: contact of cylinder and box needs {part}$"):
        solid_pair("can", can, box)
