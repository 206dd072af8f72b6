"""The numbers that pages state of their figures, computed by the modules that draw them."""

import re

import numpy as np
import pytest

import quasistatic_ref as qr
from docs.drawings import limit_surface_and_twist, metres, slow_step, turn_and_step
from tests.pages import ROOT, flat

DOCS = ROOT / "docs"


def page(name):
    return flat((DOCS / name).read_text("utf-8"))


def test_of_a_lift_at_small_h_the_boundary_layer_adds_more_friction_than_drag():
    """Run less Coulomb's law at h is the layer; Coulomb's law at h less slowly is drag."""
    assert "drag makes a box slip, and the layer of the slip changes more" in page("artifacts.md")
    for h in (2e-3, 10e-3):
        step = slow_step.last_step(h, lifts=True)
        slow = qr.coulomb_step(step.replace(h=slow_step.SLOWLY))
        run, coulomb, held = (
            np.hypot(*solution.wrench[0, :2])
            for solution in (qr.solve_step(step), qr.coulomb_step(step), slow)
        )
        assert run - coulomb > coulomb - held > 0


def test_the_threshold_of_the_grasp_is_weight_pyramid_and_drag():
    round_cone, pyramid, with_drag = turn_and_step.thresholds()
    parts = (round_cone, pyramid - round_cone, with_drag - pyramid)
    words = "{:.2f} mm bear the weight, {:.2f} mm are due to the pyramid, {:.2f} mm to drag"
    assert words.format(*parts) in page("course/the_bunny.md")


@pytest.mark.parametrize(("over", "degrees"), [(1.05, "1.7"), (1.5, "12")])
def test_inertia_turns_the_twist_of_a_slider_unless_rho_is_chi(over, degrees):
    load = over * np.array([np.cos(np.radians(40)), np.sin(np.radians(40))])
    twice = limit_surface_and_twist.twist(load, 2 * limit_surface_and_twist.CHI)
    off = 40 - np.degrees(np.arctan2(twice[1], twice[0]))
    assert f"{off:.2g}" == degrees
    assert f"by {degrees} degrees" in page("course/a_patch_that_slides.md")
    once = limit_surface_and_twist.twist(load, limit_surface_and_twist.CHI)
    assert np.degrees(np.arctan2(once[1], once[0])) == pytest.approx(40, abs=1e-6)


def test_an_optimal_answer_of_clarabel_in_displacements_is_half_a_per_cent_off():
    worst = max(metres.errors(scene, "clarabel")[0] for scene in metres.SCENES)
    assert f"{100 * worst:.1g}" == "0.5"
    assert "has 0.5 % in the figure" in page("exactness.md")


def test_no_picture_is_on_two_slides():
    lectures = [path.read_text("utf-8") for path in sorted(DOCS.glob("slides/*.md"))]
    shown = re.findall(r"!\[[^\]]*\]\(([^)]*)\)", "".join(lectures))
    assert len(shown) == len({*shown}) > 20
    assert {path.name for path in DOCS.glob("slides/figures/*.png")} <= {
        name.rpartition("/")[2] for name in shown
    }
