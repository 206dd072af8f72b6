"""``opinion SCENE.xml``: do the contacts of a MuJoCo scene hold? MuJoCo's answer and the exact one.

Exit status 0 if nothing is found, 1 if something is, 2 if the scene is refused.
"""

import argparse
from collections.abc import Sequence
from math import isfinite
from pathlib import Path

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError, about_file
from quasistatic_ref.parts import needing
from quasistatic_ref.tolerances import CREEP

SETTLE = 2.0
"""Time for which a scene settles by default [s]."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.epilog = "exit status: 0 no finding, 1 a finding, 2 the scene is refused"
    parser.add_argument("scene", type=Path, help="an MJCF file (.xml)")
    parser.add_argument(
        "--settle", type=float, default=SETTLE, metavar="SECONDS",
        help="how long MuJoCo simulates the scene; the last 0.1 s, or the first if it is shorter, "
        f"are looked at (default: {SETTLE:g})",
    )  # fmt: skip
    parser.add_argument("--keyframe", metavar="NAME", help="keyframe in which the scene begins")
    parser.add_argument(
        "--control", action="append", default=[], metavar="ACTUATOR=VALUE",
        help="set the control of an actuator; others are those of the keyframe, or zero",
    )  # fmt: skip
    parser.add_argument(
        "--tolerance", type=float, default=CREEP, metavar="M/S",
        help=f"speed up to which a contact holds [m/s] (default: {CREEP:g})",
    )  # fmt: skip
    shared.add(parser, "--root", "--json")


def run(options: argparse.Namespace) -> int:
    """Print both answers, and what is found."""
    with needing("opinion"):
        from quasistatic_ref.optional.mujoco.compared import WINDOW
        from quasistatic_ref.optional.mujoco.compiler import compiled_model
        from quasistatic_ref.optional.mujoco.mujoco_opinion import mujoco_opinion
        from quasistatic_ref.optional.mujoco.settled import settled
    control = controls(options.control)
    with about_file(options.scene):
        model = compiled_model(options.scene, options.roots)
        before = max(options.settle - WINDOW, min(options.settle, 0.0))
        data = settled(model, before, options.keyframe, control)
        start = settled(model, 0.0, options.keyframe, control)
        opinion = mujoco_opinion(model, data, options.tolerance, start)
    if options.json:
        shared.print_json(opinion.record)
    else:
        print(opinion)
    return int(bool(opinion.findings))


def controls(settings: Sequence[str]) -> dict[str, float]:
    """Controls by the names of their actuators, from ACTUATOR=VALUE.

    Raises
    ------
    InputError
        If one is not of this form, or its value is not finite.
    """
    values = {}
    for setting in settings:
        name, _, value = setting.partition("=")
        try:
            values[name] = float(value)
        except ValueError:
            raise InputError("must be ACTUATOR=VALUE", field="--control", value=setting) from None
        if not isfinite(values[name]):
            raise InputError("must be a finite number", field=f"--control {name}", value=value)
    return values
