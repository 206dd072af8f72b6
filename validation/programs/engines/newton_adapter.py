"""Newton on the CPU: phenomena by any of its solvers, in float32."""

from importlib.metadata import version
from typing import Any

import newton
import numpy as np
import warp as wp
from door import Unsupported, answer, run

NAME = f"newton {version('newton')} (warp {version('warp-lang')}, CPU)"


def model_of(scene: Any, setting: Any) -> tuple[Any, dict[str, int]]:
    """The scene, and the number of each body that moves."""
    gravity = tuple(scene["gravity"])
    builder = newton.ModelBuilder(gravity=gravity)
    if setting["solver"] == "MuJoCo":
        newton.solvers.SolverMuJoCo.register_custom_attributes(builder)
    material = {"mu": scene["mu_v"], "mu_torsional": scene["mu_omega"], "mu_rolling": 0.0}
    given = {**material, **setting.get("shape", {})}
    config = {"cfg": builder.ShapeConfig(density=0.0, **given)}
    if "attributes" in setting:
        config["custom_attributes"] = setting["attributes"]
    if scene["floor"]:
        builder.add_shape_plane(width=0.0, length=0.0, **config)  # without an end
    numbers = {}
    for body in scene["bodies"]:
        at = wp.transform(wp.vec3(*body["xyz"]), wp.quat_identity())
        inertia = wp.mat33(*np.diag(body["inertia"]).ravel().tolist())
        has = {"xform": at, "mass": body["mass"], "inertia": inertia, "lock_inertia": True}
        placed = {"body": -1, "xform": at}
        if body["joint"] == "free":
            numbers[body["name"]] = builder.add_body(**has)
        elif body["joint"] == "rail_x":
            numbers[body["name"]] = link = builder.add_link(**has)
            joint = builder.add_joint_prismatic(-1, link, parent_xform=at, axis=(1.0, 0.0, 0.0))
            builder.add_articulation([joint])
        if body["name"] in numbers:
            placed = {"body": numbers[body["name"]]}
        for shape in body["shapes"]:
            inside = wp.transform(wp.vec3(*shape["xyz"]), wp.quat_identity())
            where = {"xform": placed.get("xform", wp.transform_identity()) * inside, **config}
            if shape["kind"] == "sphere":
                builder.add_shape_sphere(placed["body"], radius=shape["radius"], **where)
            else:
                hx, hy, hz = np.array(shape["size"]) / 2
                builder.add_shape_box(placed["body"], hx=hx, hy=hy, hz=hz, **where)
    if setting["solver"] == "VBD":
        builder.color()
    return builder.finalize(device="cpu"), numbers


def phenomena(scene: Any, setting: Any) -> Any:
    """A scene by a solver, one step between detections of contacts."""
    name = f"Solver{setting['solver']}"
    if not hasattr(newton.solvers, name):
        raise Unsupported(f"there is no {name}")
    model, numbers = model_of(scene, setting)
    solver = getattr(newton.solvers, name)(model, **setting.get("options", {}))
    states = [model.state(), model.state()]
    newton.eval_fk(model, model.joint_q, model.joint_qd, states[0])
    control = model.control()
    pipeline = newton.CollisionPipeline(model)
    contacts = pipeline.contacts()

    def step(loads: Any) -> None:
        wrenches = np.zeros((model.body_count, 6), dtype=np.float32)
        for body, number in numbers.items():
            wrenches[number] = loads[body].ravel()
        states[0].clear_forces()
        states[0].body_f.assign(wrenches)
        pipeline.collide(states[0], contacts)
        solver.step(states[0], states[1], control, contacts, setting["h"])
        states.reverse()

    def pose(body: str) -> Any:
        if body not in numbers:
            return [0.0] * 6 + [1.0]
        return states[0].body_q.numpy()[numbers[body]]

    return run(scene, setting["h"], step, pose)


if __name__ == "__main__":
    wp.config.quiet = True
    answer(NAME, phenomena)
