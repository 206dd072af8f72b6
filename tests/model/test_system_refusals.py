"""System: configurations, names and bodies that cannot be, each refused in words."""

import numpy as np
import pytest

from quasistatic_ref import Body, ModelError, System
from tests.cases import cases
from tests.files.urdf.urdf_texts import BOX, CHAIN, inertial, joint, link, robot


def test_a_configuration_of_another_length_is_refused(scene):
    with pytest.raises(ModelError, match=rf"q: must have shape \({scene.n_q},\)"):
        scene.checked(scene.q_start[:-1])
    with pytest.raises(ModelError, match=r"q\[arm/base\]: must be finite"):
        scene.checked(scene.q_start * np.nan)
    with pytest.raises(ModelError, match="q: must be numbers"):
        scene.checked(["zero"] * scene.n_q)
    with pytest.raises(ModelError, match=rf"^q: must have shape \({scene.n_q},\) \(got \(1,\)\)$"):
        scene.integrate(scene.q_start[:1], np.zeros(scene.n_v))
    with pytest.raises(ModelError, match=rf"^delta_q: must have shape \({scene.n_v},\)"):
        scene.integrate(scene.q_start, np.zeros(scene.n_v + 1))


def test_unknown_names_are_answered_with_the_nearest(scene):
    with pytest.raises(ModelError, match="joint: is not a joint; did you mean 'arm/slide'"):
        scene.joint("arm/slid")
    with pytest.raises(ModelError, match="link: is not a link; did you mean 'desk/upper'"):
        scene.link("desk/uper")
    with pytest.raises(ModelError, match="body: is not a body; did you mean 'desk'"):
        scene.mass("dessk")


BAD_BODY = {
    "world": ({"name": "world"}, "body.name: must be a name other than 'world'"),
    "space": ({"name": "a b"}, "body.name: must not contain"),
    "spherical": ({"base": "spherical"}, r"c.base: is not a base; .* \(got 'spherical"),
    "tilted": ({"base": "planar", "rpy": (0.1, 0, 0)}, "c.rpy: moves or turns by z, rx, ry"),
    "bare string": ({"actuated": "swing"}, 'c.actuated: must be "all", "joints"'),
    "unknown joint": ({"actuated": ("swong",)}, "c.actuated: has no such joint; did you mean 'swi"),
    "mimic joint": (
        {"actuated": ("swing_mimic",)},
        "c.actuated: mimics 'swing' and has no coordinate of its own: name 'swing', whose spring "
        "moves both and whose force K_q e they share",
    ),
    "fixed base": ({"actuated": ("base",)}, 'c.actuated: is fixed; set base = "floating"'),
    "twice": ({"actuated": ("swing", "swing")}, "c.actuated: names a joint twice"),
    "rpy": ({"rpy": (0, np.nan, 0)}, "c.rpy: must contain finite numbers only"),
    "unknown position": ({"positions": {"swin": 1}}, "c.positions: has no such joint; did you"),
    "base position": (
        {"base": "floating", "positions": {"base": 1}},
        "c.positions: is positioned by xyz and rpy",
    ),
    "no file": ({"urdf": "nowhere.urdf"}, "nowhere.urdf: no such file"),
}  # fmt: skip


@cases("changes, words", BAD_BODY)
def test_a_body_that_cannot_be_is_refused(changes, words):
    good = {"name": "c", "urdf": CHAIN}
    System([Body(**good)])
    with pytest.raises(ModelError, match=words):
        System([Body(**(good | changes))])


def test_two_bodies_of_one_name_are_refused():
    body = Body("box", BOX)
    with pytest.raises(ModelError, match=r"body\.name: is the name of two bodies; rename one"):
        System([body, body])


def test_a_singular_mass_matrix_is_refused_where_it_is_unactuated():
    mote = inertial("1", ("1", "1", "1")).replace(
        "<inertial>", '<inertial><origin xyz="1e9 0 0"/>'
    )  # its moment about the base, 1e18 + 1, has no room for the 1
    text = robot(link("a", inertial=mote))
    with pytest.raises(ModelError, match="mote: its mass matrix M_u is singular in float64"):
        System([Body("mote", text, "floating")])
    assert System([Body("mote", text, "floating", "all")]).n_u == 0


def test_a_chain_whose_last_link_outweighs_all_is_refused_by_its_joints():
    """About one axis M = [[I1 + I2, I2], [I2, I2]]: of I1 = 1e-5, I2 = 2^40 all four are I2."""
    light, heavy = (inertial("1", (moment,) * 3) for moment in ("1e-5", str(2**40)))
    links = [link("b0"), link("b1", inertial=light), link("b2", inertial=heavy)]
    arm = robot(*links, joint("one", "b0", "b1"), joint("two", "b1", "b2"))
    with pytest.raises(ModelError, match="mass matrix M_u is singular in float64") as caught:
        System([Body("arm", arm)])
    assert caught.value.value == ["arm/one", "arm/two"]
