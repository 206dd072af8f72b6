"""A shape is a class of its own, and a row in the table of scenarios: nothing else needs to know.

Added here is a box with a ball about each of its points. On a face its distance is that of the box
less the radius; beyond a corner it is the distance to the corner less the radius.
"""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from matplotlib import pyplot as plt

from quasistatic_ref import Box, ContactError, HalfSpace, Sphere, draw_scene, figures, load_scenario
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.files.scenario.world_solids import SOLIDS, Kind
from quasistatic_ref.optional.curved.faces import kinks
from quasistatic_ref.optional.show.figures import panels
from quasistatic_ref.shapes.rounded import Rounded
from quasistatic_ref.shapes.shape import dimensions
from quasistatic_ref.text.declared import Field
from tests.closeness import assert_relative, assert_within
from tests.contact.still import in_world
from tests.errors.scene import SCENE, changed, scene_written
from tests.made import crossings, solid_pair
from tests.tolerances import ROUNDING, SCENARIO

HALF = np.array([0.2, 0.3, 0.04])
RADIUS = 0.01
SIZES = {"size": (2 * HALF).tolist(), "radius": RADIUS}


@dataclass(frozen=True, eq=False)
class Pad(Rounded):
    """A box with a ball about each of its points."""

    half_extents: np.ndarray
    radius: float

    @property
    def core(self):
        """Of the parent, which knows distances and farthest points by it."""
        return self.half_extents, self.radius

    def words(self):
        """Kind and sizes [m]."""
        return f"pad {dimensions(2 * self.half_extents)}, rounded by {self.radius:g} m"


PAD = Pad(HALF, RADIUS)


@pytest.fixture
def scene(tmp_path, monkeypatch):
    """A ball on a pad whose upper face is at z = 0."""
    size = Field("three numbers", "edges of the box", "m")
    rounding = Field("number", "of the ball", "m", above=0.0)
    row = Kind({"size": size, "radius": rounding}, lambda size, radius: Pad(size / 2, radius))
    monkeypatch.setitem(SOLIDS, "pad", row)
    pad = {"pad": SIZES, "pose": {"xyz": [0.0, 0.0, float(-HALF[2] - RADIUS)]}}
    with_pad = changed(
        SCENE, ("shapes/pad", pad), ("contacts/floor/alpha", "pad"), ("contacts/push", ...)
    )
    return scene_written(tmp_path, with_pad)


@pytest.mark.parametrize("other", [Sphere(0.05), HalfSpace((0, 0, -1.0), 0.05)])
def test_the_distance_of_an_added_shape_is_that_of_its_faces(other):
    # The ball's lowest point, and the plane of the half-space, are 0.05 from their frame.
    gap = 0.02
    above = in_world(other, [0.01, 0.02, HALF[2] + RADIUS + gap + 0.05])
    found = solid_pair("pad", in_world(PAD), above)
    assert_within(found.phi, gap)
    assert_within(found.n, [0, 0, 1])


def test_edges_of_a_polytope_cross_outside_of_its_margin(monkeypatch):
    """A pad below a bar, crossed flat: each of four crossings has the gap of the faces."""
    pad = Pad(np.array([0.1, 0.02, 0.01]), 0.005)
    core = replace(polytope(Box(half_extents=pad.half_extents)), shape=pad, margin=pad.radius)
    for module in ("solids.solid_pair", "crossings"):
        monkeypatch.setattr(
            f"quasistatic_ref.contact.{module}.polytope",
            lambda shape: core if shape is pad else polytope(shape),
        )
    low = in_world(pad)
    for turned in (np.eye(3), np.diag([1.0, -1.0, -1.0])):  # which is alpha, and the other way up
        top = in_world(Box(half_extents=(0.02, 0.1, 0.01)), [0, 0, 0.026], turned)
        for a, b in ((low, top), (top, low)):
            near = solid_pair("pair", a, b)
            found = crossings(a, b, near.alpha, near.beta, near.n)
            gaps = (found.beta - found.alpha) @ near.n
            assert_within(gaps, [0.001] * 4)
            assert_relative(near.phi, 0.001, 1e-12)


def test_an_added_shape_without_faces_is_refused_where_faces_are_needed():
    with pytest.raises(ContactError, match="shape: has no closest points with this solid"):
        solid_pair("pad", in_world(PAD), in_world(Box(np.full(3, 0.05))))
    with pytest.raises(ContactError, match="shape: has no known faces"):
        kinks(PAD)


def test_a_ball_comes_to_rest_on_an_added_shape(scene):
    scenario = load_scenario(scene)
    run = scenario.run()
    # The wrench of the scene is along y and about z: in contact the load is the weight, m g.
    assert_within(run["phi"][0, 0], 0.0)
    assert_relative(run["wrench"][0, 0, 2], 0.3 * 9.81, SCENARIO)


def test_an_added_shape_is_drawn_and_inspected(scene, cli):
    scenario = load_scenario(scene)
    run = scenario.run()
    page, (axes,) = panels(4.6, 4.0)
    draw_scene(axes, figures.moment(scenario, run, 0))
    reached = np.concatenate([patch.get_xy() for patch in axes.patches])
    assert np.ptp(reached[:, 0]) >= 2 * (HALF[0] + RADIUS) - ROUNDING
    plt.close(page)
    assert PAD.words() in cli("inspect", scene).out
