"""Good files from which fuzzing starts."""

from __future__ import annotations

import tempfile
from pathlib import Path

from quasistatic_ref.resources import models_folder
from quasistatic_ref.simulate.scenario import load_scenario
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step import files
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution_files import infeasible_text, solution_text


def scratch() -> tempfile.TemporaryDirectory[str]:
    """A temporary folder, in memory where there is such a place: disks cost 3 ms a file."""
    memory = Path("/dev/shm")
    return tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None)


def small_step() -> StepData:
    """The first step of the spinning sphere: 6 coordinates, one contact of 6 rows."""
    scenario = load_scenario("sphere_spin", ["steps=1"])
    q, force = scenario.system.q_start, scenario.force
    assert force is not None
    return scenario.simulator().step(q, scenario.targets(0.01), force(0.01, q)).step


def step_text() -> str:
    """The same as JSON."""
    return files.step_text(small_step())


def seeds(name: str) -> list[bytes]:
    """Good files of one kind; see ``fuzz_bytes.TARGETS``."""
    sphere, grasp = models_folder() / "sphere_spin", models_folder() / "bunny_grasp"
    if name == "toml":
        return [(sphere / "sphere_spin.toml").read_bytes()]
    if name == "step":
        return [step_text().encode()]
    if name == "solution":
        step = small_step()
        solution = solution_text(step, solve_step(step))
        return [solution.encode(), infeasible_text(step, ["1/2"] * 6).encode()]
    if name == "urdf":
        return [(sphere / "sphere.urdf").read_bytes(), (grasp / "gripper.urdf").read_bytes()]
    if name == "cloud":
        ply = b"ply\nformat ascii 1.0\nelement vertex 1\n" + b"".join(
            b"property float %c\n" % axis for axis in b"xyz"
        )
        little = ply.replace(b"ascii", b"binary_little_endian") + b"end_header\n" + bytes(12)
        texts = (b"1 2 3\n", b"x,y,z\n1,2,3\n", ply + b"end_header\n1 2 3\n", b"v 1 2 3\n")
        return [*(bytes([i]) + text for i, text in enumerate(texts)), b"\2" + little]
    with tempfile.TemporaryDirectory() as folder:
        run = load_scenario("sphere_spin", ["steps=1"]).run(progress=False)
        return [run.save(Path(folder) / "x.npz").read_bytes()]
