"""What README and the pages of docs/ say in numbers, and where each number comes from.

``QUOTED`` has for each page its phrases, with braces in place of the numbers, and a function that
returns what fills the braces: of a committed result, of a run, or of the formula that the page
names. When a result changes, the test lists the phrases as they ought to read. ``OTHERS`` has pages
whose further phrases stand in the tests of their results. Measured numbers of a page that are
neither here nor in tests/chosen_numbers.py fail the test.
"""

import math

from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.claims.registry import BY_NAME
from quasistatic_ref.lab.examples.grasp_against_mu_omega import physical_limit
from quasistatic_ref.lab.grasp import TOP
from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.optional.fast.tracker import ball_tree, tracker, tracker_bound
from quasistatic_ref.tolerances import CLOSED_FORM, ILL_POSED, SLOW, UNSEEN
from tests import quoted_reality as reality
from tests import quoted_sources as of
from tests import quoted_speed as speed
from tests import quoted_vectors as vectors
from tests.lab import test_digits_figure as digits
from tests.lab.study import test_known_issues as known_issues
from tests.quoted import claim, word
from tests.quoted_sources import G, H
from tests.solve import test_options_of_backends as options

SOFT = ("250", "500")
"""Stiffnesses of the sweep that are too small [N/m]."""

QUOTED = {
    "README.md": [
        ("pivots about the points by which the fingers hold it (by {:.1f} degrees while it is "
         "lifted); with torsional friction it does not ({:.1f} degrees)", of.both_turns),
        ("({:.0f} points, as in the paper)", lambda: [claim("structure", "points of the cloud")]),
        ("{:,} contact problems with proved answers in {} families", of.problem_set),
        ("and {} gigabyte of disk: {} of it is Boost, whose libraries pinocchio and coal load, "
         "and the next largest parts are {} (through CVXPY), {} and {}", of.base),
        ("measures {} claims", lambda: [len(BY_NAME)]),
        ("(certified steps meet them to {:.0e})", lambda: [CLOSED_FORM]),
    ],
    "docs/index.md": [
        ("the bunny turns by {:.1f} degrees about the points by which the fingers hold it while it "
         "is lifted, with it by {:.1f} (the largest angle from the closed grip to t = {:g} s)",
         lambda: [*of.both_turns(), TOP]),
    ],
    "docs/changelog.md": [
        ("{} scenarios, among them", lambda: [word(len(scenario_names())).capitalize()]),
        ("vectors of {} layers, {:,} cases",
         lambda: [word(len(LAYERS)), sum(map(of.cases_of, LAYERS))]),
        ("`validate`: {} claims", lambda: [len(BY_NAME)]),
    ],
    "docs/quickstart.md": [
        ("lifts it by {:.0f} mm and holds it", lambda: [1e3 * claim("grasp", "lift [m]")]),
        ("each finger presses with {:.1f} N, the gripper rises at {:.0f} mm/s",
         lambda: [of.pressed(), 40 / 2.2]),
        ("the middle of the fingertips is {:.0f} mm behind the centre of mass, and the two points "
         "of the bunny that the fingers come to press on, one each, are {:.0f} and {:.0f} mm "
         "behind it",
         lambda: of.levers()[:3]),
        ("```text with torsion without torsion {} ...", lambda: [of.demo_lines()]),
        ("With 1 mm the bunny turns by {:.0f} degrees, with 1.75 mm by {:.1f}, with 1.8 mm by "
         "{:.1f}:", lambda: map(of.turned, (1, 1.75, 1.8))),
        ("At most 3 pi / 16 mu_v r = {:.1f} mm by (R15)", lambda: [1e3 * physical_limit()]),
        ("The scene's 3 mm take a patch with a radius of {:.1f} mm",
         lambda: [3 / (3 * math.pi / 16 * 0.6)]),
        ("the origin of the bunny's frame, {:.0f} mm below its centre of mass",
         lambda: [of.levers()[3]]),
        ("a foot stays on the floor until t = {:.2f} s", lambda: [of.foot_on_the_floor()]),
        ("weighted by the load, is 2/3 r where the pressure is even, and 3 pi / 16 r = {:.2f} r",
         lambda: [3 * math.pi / 16]),
        ("During the lift this drag is {:.2f} N, {:.1f} % of the friction that the grip can bear, "
         "2 x 0.6 x {:.1f} N; at most it is {:.1f} %",
         lambda: [of.drag()[0], 100 * of.drag()[2], of.pressed(), 100 * of.drag()[3]]),
        ("Above {:.0f} % a run warns", lambda: [100 * SLOW]),
        ("its angle, {:.2f} degrees,", lambda: [of.since_the_start()]),
    ],
    "docs/lecture.md": [
        ("$\\delta q_a = (h^2K_q\\,\\delta\\bar q_a + m\\phi)/(h^2K_q + m)$ = {:.3f} mm",
         lambda: [1e3 * (0.02**2 * 500 * 0.004 + 0.5 * 0.001) / (0.02**2 * 500 + 0.5)]),
        ("$\\lvert r\\rvert\\theta^2/2$ = 0.06 / 2 x 1e-4 m = {:.0f} µm",
         lambda: [1e6 * math.hypot(0.05, 0.03, 0.02) * 0.01**2 / 2]),
        ("$r(1 - \\cos\\theta)$: {:.2f} mm for theta = 0.1", lambda: [50 * (1 - math.cos(0.1))]),
        ("m v / h = {:.0f} N, lag 1 N / K_q = {:.0f} mm",
         lambda: [0.5 * 0.02 / 0.01, 1e3 * 0.5 * 0.02 / 0.01 / 500]),
    ],
    "docs/tour.md": [
        ("h^2 g = {:.0f} µm *down*", lambda: [1e6 * H**2 * G]),
        ("the point slides by {:.0f} µm and rises by half of that",  # (R8)
         lambda: [1e6 * H**2 * (8 - 0.5 * G) / 1.25]),
        ("the bunny turns by {1:.1f} degrees at most from the closed grip to t = {2:g} s, without "
         "it by {0:.1f}:", lambda: [*of.both_turns(), TOP]),
        ("a foot on the floor until t = {:.2f} s", lambda: [of.foot_on_the_floor()]),
    ],
    "docs/exercises.md": [
        ("h g in all, {:.0f} mm and {:.1f} mm. Right is g/2 = {:.1f} m",
         lambda: [1e3 * H * G, 1e3 * 1e-3 * G, G / 2]),
        ("= {:.2f} mm a step. The tight row is phi + dz = mu_v dx, so it floats at phi = mu_v dx = "
         "{:.3f} mm", lambda: [x := 1e3 * H**2 * (8 - 0.5 * G), x / 2]),
        ("l = mu_omega (2 N / (m g) - 1 / mu_v) = {:.1f} mm", lambda: [20 * (10 / (0.2 * G) - 2)]),
        ("2 and 4 mm hold the bunny ({:.1f} degrees), 1 mm does not ({:.0f} degrees)",
         lambda: map(of.turned, (2, 1))),
        ("the threshold lies between 1.75 mm (the bunny turns by {:.1f} degrees) and 1.80 mm (by "
         "{:.1f})",
         lambda: map(of.turned, (1.75, 1.8))),
        ("is not the {:.0f} mm to the middle of the fingertips: the two points that bear load are "
         "{:.0f} and {:.0f} mm behind the centre of mass", lambda: of.levers()[:3]),
        ("tau_n over the vertical force is {:.0f} mm", lambda: [of.levers()[4]]),
        ("the fingers lift the bunny of 0.2 kg at {:.0f} mm/s, for which the model "
         "needs m v / h = {:.2f} N in addition to the {:.2f} N of the weight",
         lambda: [40 / 2.2, of.drag()[0], 0.2 * G]),
        ("the same points would need {:.2f} mm", lambda: [of.weight_alone()]),
        ("And {} of it is an artifact", lambda: [of.one_in(1 - of.weight_alone() / of.least())]),
        ("here from {:.1f} times the threshold on",  # (R7) and (R8) at 20 degrees, mu_v = 0.5
         lambda: [((c := math.cos(math.radians(20))) + (s := math.sin(math.radians(20))))
                  / (c - (1 + 0.5**2) * s)]),
    ],
    "docs/artifacts.md": [
        ("h = 10 ms: {:.0f} mm a step, a terminal velocity of {:.0f} mm/s",
         lambda: [1e3 * H**2 * G, 1e3 * H * G]),
        ("0.2 kg at 50 mm/s, h = 10 ms: {:.1f} N against {:.2f} N of friction at",
         lambda: [0.2 * 0.05 / H, 0.5 * 0.2 * G]),
        ("A warning is given above {:g}", lambda: [SLOW]),
        ("for the same velocity {:.0f} % less turn",
         lambda: [100 - 100 * 4 / ((4 + 0.1 * 9) / 1.1)]),
        ("50 mm/s, h = 10 ms, $\\mu_v$ = 0.5: {:.2f} mm", lambda: [0.5 * H * 50]),
        ("a block on 25° with $\\mu_v$ = 0.2: {:.2f} mm a step of 10 ms", lambda: [
            1e3 * H**2 * G * (math.sin(a := math.radians(25)) - 0.2 * math.cos(a))]),
        ("{:.0f} % less at 45°", lambda: [100 * (1 - math.sqrt(0.5))]),
        ("0.1 mm, h = 10 ms: {:.0f} N per kilogram", lambda: [1e-4 / H**2]),
        ("r = 50 mm rolling 0.6 mm a step: {:.0f} µm, {:.2f} N per kilogram",
         lambda: [x := 1e6 * 0.05 * 0.012**2 / 2, 1e-6 * x / H**2]),
        ("24 points of equal area: {:.2f} of a uniform load",
         lambda: [claim("flat_patch", "its torque over that of a uniform load [-]")]),
        ("0.1 mm and 1 N of friction: {:.1f} mN m", lambda: [0.1]),
        ("{:.1f}° for each millimetre", lambda: [math.degrees(2 * 0.3 / 20)]),
        ("loads the torsional friction by {:.1f} % more than the weight does",
         lambda: [100 * of.drag()[1]]),
        ("The largest share, {:.3f}, is not of the lift", lambda: [of.drag()[3]]),
        ("the fingers carry the bunny by {:.1f} mm a step", lambda: [40 / 220]),
    ],
    "docs/cones.md": [
        ("At d = 40 mm the pyramid needs {:.1f} N where the product needs {:.1f} N",
         lambda: [of.pinch("pyramid", 0.04), of.pinch("product", 0.04)]),
        ("is mu_omega = {:.1f} mm or {:.1f} mm",
         lambda: [5 * 3 * math.pi / 16, 5 * 2 / 3]),
    ],
    "docs/conventions.md": [
        ("closed forms, right to 1e{:.0f} (apart and in penetration; two capsules to 1e{:.0f})",
         lambda: [of.decade(of.closed_forms()), of.decade(of.two_capsules())]),
    ],
    "docs/distances.md": [
        ("`UNSEEN` is {:.0e} of L", lambda: [UNSEEN]),
        ("a distance {:.0f} times as large beyond the k-th", lambda: [tracker_bound.RATIO]),
        ("Up to {:,} points all are measured", lambda: [ball_tree.SMALL]),
        ("leaves of up to {} points", lambda: [ball_tree.LEAF]),
        ("the next best up to a width of {}", lambda: [tracker_bound.BEAM]),
        ("lasted for fewer than {} steps are made twice as long, up to {} points",
         lambda: [tracker.SHORT, tracker.WIDE]),
    ],
    "docs/exactness.md": [
        ("of `sphere_spin`, and on {:,} random steps", lambda: of.steps_with_equal_bits()[-1:]),
        ("more than 1e{:.0f} times longer", lambda: [math.log10(ILL_POSED)]),
        ("each backend claims at least one answer without a single correct digit; OSQP leaves {} "
         "unsolved, PIQP {}.", lambda: of.unsolved_random_steps("osqp", "piqp")),
    ],
    "docs/release.md": [
        ("equal bits of all backends on {:,} steps", lambda: [sum(of.steps_with_equal_bits())]),
    ],
    "docs/studies.md": [
        ("HiGHS 1.15 solves {} of {} random problems of 13 x 80 in raw units",
         known_issues.highs_solved),
        ("without torsional friction the bunny turns by {0:.0f} degrees at h = 0.01 s and at 0.02 "
         "s, and by {2:.0f} at 0.04 s", lambda: of.sweep_turns(0.0)),
        ("it still turns, by {:.0f} to {:.0f} degrees",
         lambda: [min(turns := of.sweep_turns(1e-3)), max(turns)]),
        ("({:.0f} at h = 0.01 s to t = 2.9 s", lambda: [of.turned(1)]),
        ("from 2 mm on by {:.2f} degrees or less at every h",
         lambda: [max(of.sweep_turns(2e-3, 3e-3, 5e-3, 1e-2, 2e-2))]),
        ("A grip of 500 N/m or less is too light: the bunny turns by {:.0f} degrees and more",
         lambda: [min(map(of.sweep_of("stiffness", "largest rotation [deg]").get, SOFT))]),
        ("At k = 1 and 2 points that were not among the closest sink in by {:.1f} mm",
         lambda: [max(of.sweep_of("closest points", "deepest penetration [um]").values()) / 1e3]),
        ("the cone changes the {:.2f} degrees by less than {:.3f}", lambda: [
            (turns := of.sweep_of("cone", "largest rotation [deg]"))["pyramid"],
            math.ceil(1e3 * (max(turns.values()) - turns["pyramid"])) / 1e3]),
    ],
    "docs/guides/first_scene.md": [
        ("the can turned by nothing and rose by {:.0f} mm",  # less m g / K and the drag m v / h / K
         lambda: [30 - 1e3 * 0.2 * (G + 0.01 / 0.02) / 2000]),
        ("the can's {:.0f} N stretch by {:.0f} mm", lambda: [0.2 * G, 1e3 * 0.2 * G / 2000]),
    ],
    "docs/guides/choose_a_backend.md": [
        ("at which it does [not solve {} of the grasp's steps]",
         lambda: [of.one_in(of.highs_unsolved())]),
        ("{:.0f} to {:.0f} times as fast, depending on the backend", of.native_gains),
    ],
}  # fmt: skip

OTHERS = {
    "docs/speed.md": lambda: speed.HELD,
    "docs/exactness.md": digits.quoted,
    "docs/conventions.md": options.quoted,
    **vectors.HELD,
    "docs/reality.md": reality.held,
}
