"""Every reader of files: good files of its kind, how they are made wrong, and what reads them."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quasistatic_ref import (
    Body,
    InputError,
    System,
    load_scenario,
    solve_step,
    step_read,
    trajectory_read,
)
from quasistatic_ref.cli.run import worst_residual
from quasistatic_ref.cli.solution_files import infeasible_text, solution_read, solution_text
from quasistatic_ref.cli.verify import refutation
from quasistatic_ref.formats.files import json_text, toml_read
from quasistatic_ref.formats.resources import models_folder
from quasistatic_ref.lab.folders import vectors_folder
from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.study.file.study_file import solver_study
from quasistatic_ref.lab.study.measuring.many import TABLE
from quasistatic_ref.lab.study.problems.folder import FACTS, MANIFEST, NUMBERS, set_read
from quasistatic_ref.lab.study.problems.for_study import FOLDER, TestSet, study_problems
from quasistatic_ref.lab.study.report.report import study_report
from quasistatic_ref.lab.study.store.pack import packed_store
from quasistatic_ref.lab.study.store.store import STORE
from quasistatic_ref.lab.vectors.check.answers import answers_read
from quasistatic_ref.lab.vectors.check.folder import layer_report
from quasistatic_ref.lab.vectors.check.report import Report
from quasistatic_ref.lab.vectors.files import answers_written, expected_read, inputs_read
from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.model.readers.clouds import point_cloud
from quasistatic_ref.optional.mjcf.mjcf import mjcf_urdf
from quasistatic_ref.simulate.trajectory import certified
from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.step.files import step_text
from tests.errors import texts
from tests.lab.study import made_store
from tests.model.readers.test_mesh_files import COLLADA
from tests.model.urdf.urdf_texts import collision, link, urdf_of_text
from tests.model.urdf.urdf_texts import robot as urdf_of
from tests.optional.mjcf.test_mjcf import ARM, WEDGE
from tests.oracles.spoilt_files import (
    npy_bytes,
    spoilt_bytes,
    spoilt_json,
    spoilt_lines,
    spoilt_npy,
    spoilt_npz,
    spoilt_text,
    spoilt_toml,
    spoilt_xz,
    zip_bytes,
)


@dataclass(frozen=True)
class Reader:
    """What reads one kind of file.

    Parameters
    ----------
    file : str
        Name of the file that it reads.
    good : tuple of bytes
        Files that it accepts.
    form : callable
        How they are made wrong.
    read : callable
        Given the path of the file.
    """

    file: str
    good: tuple[bytes, ...]
    form: Callable[..., bytes]
    read: Callable[[Path], object]


def models(folder):
    urdfs = tuple(
        (models_folder() / f).read_bytes() for f in ("door/door.urdf", "bunny_grasp/gripper.urdf")
    )

    def robot(path):
        system = System([Body("r", path, actuated="all")])
        assert np.isfinite(system.M_u(system.q_start)).all()
        assert np.isfinite(system.kinematics(system.q_start).J).all()

    def mesh(path):
        about = collision(f'<mesh filename="{path.name}" scale="1 1 1"/>')
        System(
            [Body("r", urdf_of_text(folder, urdf_of(link("r", about)), "mesh.urdf"), "floating")]
        )

    binary = bytes(80) + struct.pack("<I", len(texts.TRIANGLES))
    ascii_ = "solid s\n"
    for triangle in texts.TRIANGLES:
        corners = [texts.CORNERS[i] for i in triangle]
        binary += struct.pack("<12fH", 0, 0, 0, *(x for corner in corners for x in corner), 0)
        lines = "".join("vertex {} {} {}\n".format(*corner) for corner in corners)
        ascii_ += f"facet normal 0 0 1\nouter loop\n{lines}endloop\nendfacet\n"
    stl = binary, f"{ascii_}endsolid s\n".encode()
    obj = "".join("v {} {} {}\n".format(*corner) for corner in texts.CORNERS)
    obj += "".join(
        "f {} {} {}\n".format(*(i + 1 for i in triangle)) for triangle in texts.TRIANGLES
    )
    (folder / "wedge.obj").write_text(WEDGE)
    return {
        "MJCF": Reader("m.xml", (ARM.encode(),), spoilt_text, mjcf_urdf),
        "URDF": Reader("r.urdf", urdfs, spoilt_text, robot),
        "mesh, STL": Reader("m.stl", stl, spoilt_text, mesh),
        "mesh, OBJ": Reader("m.obj", (obj.encode(),), spoilt_text, mesh),
        "mesh, DAE": Reader("m.dae", (COLLADA.encode(),), spoilt_text, mesh),
    }


def clouds(_):
    points = np.array(texts.CORNERS)
    text = "".join("{} {} {}\n".format(*corner) for corner in texts.CORNERS).encode()
    coloured = text.replace(b"\n", b" 255\n")
    packed = b"".join(struct.pack("<3fI", *corner, 255) for corner in texts.CORNERS)
    bytes_ = b"".join(struct.pack("<3fB", *corner, 255) for corner in texts.CORNERS)
    ply = (
        texts.PLY.format("ascii").encode() + coloured,
        texts.PLY.format("binary_little_endian").encode() + bytes_,
    )
    pcd = (texts.PCD + "ascii\n").encode() + coloured, (texts.PCD + "binary\n").encode() + packed
    table = b"# cloud\nx,y,z,red\n" + coloured.replace(b" ", b",")
    npz = zip_bytes([("points.npy", npy_bytes(points))]), zip_bytes([("a.npy", npy_bytes(points))])
    kinds = {
        "xyz": ((text,), spoilt_text), "csv": ((table,), spoilt_text), "ply": (ply, spoilt_text),
        "obj": ((text.replace(b"\n", b"\nv ")[:-2],), spoilt_text), "pcd": (pcd, spoilt_text),
        "npy": ((npy_bytes(points), npy_bytes(points.astype("f4"))), spoilt_npy),
        "npz": (npz, spoilt_npz),
    }  # fmt: skip
    return {
        f"cloud, {kind}": Reader(f"c.{kind}", good, form, point_cloud)
        for kind, (good, form) in kinds.items()
    }


def scenes(folder):
    for model, file in (("sphere_spin", "sphere.urdf"), ("bunny_grasp", "gripper.urdf")):
        (folder / file).write_bytes((models_folder() / model / file).read_bytes())
    (folder / "cloud.xyz").write_text("0 0 0.05\n0 0 -0.05\n")
    good = folder / "good.toml"
    good.write_text(texts.SCENE)

    def few_steps(scenario):
        if scenario.steps <= 2:
            assert np.isfinite(scenario.run(progress=False)["q"]).all()

    def scene(path):
        few_steps(load_scenario(path, fast=True))

    def setting(path):
        load_scenario(good, [path.read_bytes().decode(errors="surrogateescape")])

    settings = tuple(text.encode() for text in texts.SETTINGS)
    return {
        "scenario": Reader("scene.toml", (texts.SCENE.encode(),), spoilt_toml, scene),
        "--set": Reader("set.txt", settings, spoilt_text, setting),
    }


def steps(folder):
    scenario = load_scenario("sphere_spin", ["steps=2"])
    run = scenario.run(progress=False)
    trajectory = run.save(folder / "good.npz").read_bytes()
    step = run.step_data(0)
    text = step_text(step).encode()
    solutions = (
        solution_text(solve_step(step, NONE)),
        infeasible_text(step, ["1/2"] * 6),
    )

    def solved(path):
        solution = solve_step(step_read(path), NONE)
        assert np.isfinite(solution.delta_q).all()
        assert np.isfinite(solution.lam).all()
        assert solution.certificate.kind == "exact"

    def extracted(path):
        found = trajectory_read(path)
        assert certified(found)
        worst_residual(found)
        found.step_data(0)

    def verified(path):
        refutation(step, solution_read(path, step))

    return {
        "step": Reader("step.json", (text,), spoilt_json, solved),
        "solution": Reader(
            "solution.json", tuple(s.encode() for s in solutions), spoilt_json, verified
        ),
        "trajectory": Reader("run.npz", (trajectory,), spoilt_npz, extracted),
    }


def answers(folder):
    """Right answers to three cases of each layer: a short one, one in the middle, a long one."""
    found = {}
    for layer in LAYERS:
        inputs = inputs_read(vectors_folder(), layer)
        expected = expected_read(vectors_folder(), layer)
        sizes = sorted((len(str(expected[case.id]["output"])), case.id) for case in inputs)
        chosen = {sizes[at][1] for at in (0, len(sizes) // 3, len(sizes) // 2)}
        cases = [case for case in inputs if case.id in chosen]
        known = {name: expected[name] for name in chosen}
        outputs = {name: known[name]["output"] for name in sorted(chosen)}
        good = answers_written(folder, layer, "spoilt", outputs).read_bytes()

        def compared(path, layer=layer, cases=cases, known=known):
            report = Report(
                "", (layer_report(layer, cases, known, answers_read(path.parent, layer)),)
            )
            json_text(report.record)
            assert all(sentence.isprintable() for sentence in report.sentences)
            if not report.ok:
                raise InputError(report.sentences[0])

        found[f"answers, {layer}"] = Reader(f"{layer}.json", (good,), spoilt_json, compared)
    return found


def stores(folder):
    """Stores, the table of a sweep, and each file of a test set, the others being good."""

    def reported(path):
        markdown_page(study_report(path.parent))

    made_store.write_store(folder / "study", count=3)
    good = (folder / "study" / STORE).read_bytes()
    kept = packed_store(folder / "study", folder / "packed")
    (folder / "sweep").mkdir()
    found = {
        f"study, {STORE}": Reader(f"study/{STORE}", (good,), spoilt_bytes, reported),
        f"study, {kept.name}": Reader(
            f"packed/{kept.name}", (kept.read_bytes(),), spoilt_xz, reported
        ),
        f"sweep, {TABLE}": Reader(
            f"sweep/{TABLE}", (made_store.SWEEP.encode(),), spoilt_text, reported
        ),
    }

    def problems(path):
        set_read(path.parent.parent if path.parent.name == NUMBERS else path.parent)

    study_problems(TestSet(1, {"scenarios": 2}, ("sphere_spin",)), folder, progress=False)
    home = folder / FOLDER
    numbers = f"{NUMBERS}/scenarios.npz"
    for file, form in {MANIFEST: spoilt_json, FACTS: spoilt_lines, numbers: spoilt_npz}.items():
        good = (home / file).read_bytes()
        found[f"test set, {file}"] = Reader(f"{FOLDER}/{file}", (good,), form, problems)
    return found


def studies(_):
    def study(path):
        solver_study(path, toml_read(path))

    return {"study TOML": Reader("study.toml", (texts.SOLVERS.encode(),), spoilt_toml, study)}


FAMILIES = (models, clouds, scenes, steps, answers, stores, studies)
