"""What README and the pages of docs/ say in numbers, and where each number comes from.

``QUOTED`` has for each page the phrases as they ought to read, with numbers of a committed result,
of a run, or of the code. When a result changes, the test lists the phrases
that no longer stand on their page. (What a page works out of numbers that it gives cannot become
stale, and is not here.) ``OTHERS`` has pages whose phrases stand in the tests of their
results.
"""

import math

from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.claims.registry import BY_NAME
from quasistatic_ref.lab.examples.grasp_against_mu_omega import physical_limit
from quasistatic_ref.lab.grasp import TOP
from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.optional.fast.tracker import ball_tree, tracker, tracker_bound
from quasistatic_ref.tolerances import ILL_POSED, SLOW, UNSEEN
from tests import quoted_reality as reality
from tests import quoted_sources as of
from tests import quoted_speed as speed
from tests import quoted_vectors as vectors
from tests.lab.study import test_known_issues as known_issues
from tests.quoted import claim, word
from tests.quoted_sources import G

SOFT = ("250", "500")
"""Stiffnesses of the sweep that are too small [N/m]."""


QUOTED = {
    "README.md": lambda: [
        "the bunny turns by {1:.1f} degrees during the lift. Without it the bunny turns by "
        "{0:.1f} degrees about".format(*of.both_turns()),
        f"a bunny made of {claim('structure', 'points of the cloud'):.0f} points",
        "{:,} contact problems in {} families".format(*of.problem_set()),
        f"and {of.base()[0]} gigabyte of disk",
        f"measures [{len(BY_NAME)} claims]",
    ],
    "docs/guides/install.md": lambda: [
        "It takes {} gigabyte of disk: {} of it is Boost, whose libraries pinocchio and coal load, "
        "and the next largest parts are {} (through CVXPY), {} and {}".format(*of.base()),
    ],
    "docs/index.md": lambda: [
        "Without torsional friction the bunny turns by {:.1f} degrees about the points at which "
        "the fingers hold it; with torsional friction it turns by {:.1f} degrees. (These are the "
        "largest angles from the closed grip to t = {:g} s.)".format(*of.both_turns(), TOP),
    ],
    "docs/changelog.md": lambda: [
        f"{word(len(scenario_names())).capitalize()} scenarios, among them",
        f"vectors of {word(len(LAYERS))} layers, {sum(map(of.cases_of, LAYERS)):,} cases",
        f"`validate`: {len(BY_NAME)} claims",
    ],
    "docs/quickstart.md": lambda: [
        f"lifts it by {1e3 * claim('grasp', 'lift [m]'):.0f} mm and holds it",
        f"each finger presses with {of.pressed():.1f} N, the gripper rises at {40 / 2.2:.0f} mm/s",
        "the middle of the fingertips is {:.0f} mm behind the centre of mass, and the two "
        "points of the bunny that the fingers come to press on, one each, are {:.0f} and "
        "{:.0f} mm behind it".format(*of.levers()[:3]),
        f"```text with torsion without torsion {of.demo_lines()} ...",
        "With 1 mm the bunny turns by {:.0f} degrees, with 1.75 mm by {:.1f}, with 1.8 mm by "
        "{:.1f}:".format(*map(of.turned, (1, 1.75, 1.8))),
        f"At most 3 pi / 16 mu_v r = {1e3 * physical_limit():.1f} mm by (R15)",
        f"the origin of the bunny's frame, {of.levers()[3]:.0f} mm below its centre of mass",
        f"a foot stays on the floor until t = {of.foot_on_the_floor():.2f} s",
        f"During the lift this drag is {of.drag()[0]:.2f} N, {100 * of.drag()[2]:.1f} % of the "
        f"friction that the grip can bear, 2 x 0.6 x {of.pressed():.1f} N; at most it is "
        f"{100 * of.drag()[3]:.1f} %",
        f"Above {100 * SLOW:.0f} % a run",
        f"its angle, {of.since_the_start():.2f} degrees,",
    ],
    "docs/tour.md": lambda: [
        "the bunny turns by {1:.1f} degrees at most from the closed grip to t = {2:g} s, "
        "without it by {0:.1f}:".format(*of.both_turns(), TOP),
        f"a foot on the floor until t = {of.foot_on_the_floor():.2f} s",
    ],
    "docs/exercises.md": lambda: [
        "2 and 4 mm hold the bunny ({:.1f} degrees), 1 mm does not ({:.0f} degrees)".format(
            *map(of.turned, (2, 1))
        ),
        "the threshold lies between 1.75 mm (the bunny turns by {:.1f} degrees) and 1.80 mm "
        "(by {:.1f})".format(*map(of.turned, (1.75, 1.8))),
        "is not the {:.0f} mm to the middle of the fingertips: the two points that bear load "
        "are {:.0f} and {:.0f} mm behind the centre of mass".format(*of.levers()[:3]),
        f"tau_n over the vertical force is {of.levers()[4]:.0f} mm",
        f"the fingers lift the bunny of 0.2 kg at {40 / 2.2:.0f} mm/s, for which the model "
        f"needs m v / h = {of.drag()[0]:.2f} N in addition to the {0.2 * G:.2f} N of the weight",
        f"the same points would need {of.weight_alone():.2f} mm",
        f"And {of.one_in(1 - of.weight_alone() / of.least())} of it is an artifact",
    ],
    "docs/artifacts.md": lambda: [
        f"it above {SLOW:g}",
        "24 points of equal area: "
        f"{claim('flat_patch', 'its torque over that of a uniform load [-]'):.2f} of a uniform "
        "load",
        f"loads the torsional friction by {100 * of.drag()[1]:.1f} % more than the weight does",
        f"The largest share, {of.drag()[3]:.3f}, is not of the lift",
        f"the fingers carry the bunny by {40 / 220:.1f} mm a step",
    ],
    "docs/conventions.md": lambda: [
        f"closed forms, right to 1e{of.decade(of.closed_forms()):.0f} (apart and in "
        f"penetration; two capsules to 1e{of.decade(of.two_capsules()):.0f})",
    ],
    "docs/distances.md": lambda: [
        f"`UNSEEN` is {UNSEEN:.0e} of L",
        f"a distance {tracker_bound.RATIO:.0f} times as large beyond the k-th",
        f"Up to {ball_tree.SMALL:,} points all are measured",
        f"leaves of up to {ball_tree.LEAF} points",
        f"the next best up to a width of {tracker_bound.BEAM}",
        f"lasted for fewer than {tracker.SHORT} steps are made twice as long, up to "
        f"{tracker.WIDE} points",
    ],
    "docs/exactness.md": lambda: [
        f"more than 1e{math.log10(ILL_POSED):.0f} times longer",
    ],
    "docs/studies.md": lambda: [
        "HiGHS 1.15 solves {} of {} random problems of 13 x 80 in raw units".format(
            *known_issues.highs_solved()
        ),
        "without torsional friction the bunny turns by {0:.0f} degrees at h = 0.01 s and at "
        "0.02 s, and by {2:.0f} at 0.04 s".format(*of.sweep_turns(0.0)),
        f"it still turns, by {min(turns := of.sweep_turns(1e-3)):.0f} to {max(turns):.0f} degrees",
        f"({of.turned(1):.0f} at h = 0.01 s to t = 2.9 s",
        f"from 2 mm on by {max(of.sweep_turns(2e-3, 3e-3, 5e-3, 1e-2, 2e-2)):.2f} degrees or "
        "less at every h",
        "A grip of 500 N/m or less is too light: the bunny turns by "
        f"{min(map(of.sweep_of('stiffness', 'largest rotation [deg]').get, SOFT)):.0f} degrees "
        "and more",
        "At k = 1 and 2 points that were not among the closest sink in by "
        f"{max(of.sweep_of('closest points', 'deepest penetration [um]').values()) / 1e3:.1f} mm",
        "the cone changes the "
        f"{(turns := of.sweep_of('cone', 'largest rotation [deg]'))['pyramid']:.2f} degrees by "
        f"less than {math.ceil(1e3 * (max(turns.values()) - turns['pyramid'])) / 1e3:.3f}",
    ],
    "docs/guides/choose_a_backend.md": lambda: [
        "{:.0f} to {:.0f} times as fast, depending on the backend".format(*of.native_gains()),
    ],
}

OTHERS = {
    "docs/speed.md": speed.held,
    **vectors.HELD,
    "docs/reality.md": reality.held,
}
