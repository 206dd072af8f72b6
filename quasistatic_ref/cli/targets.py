"""``targets SCENE.toml --link LINK --poses POSES.toml``: waypoints of joints for a scenario."""

import argparse
import re
import sys
import tomllib
from collections.abc import Mapping
from pathlib import Path

from quasistatic_ref.errors import InputError, ScenarioError, about_file
from quasistatic_ref.formats.files import text_written, toml_read
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.parts import needing
from quasistatic_ref.scenario.scenario import load_scenario


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument("scenario", type=Path, help="a scenario file (.toml)")
    parser.add_argument("--link", required=True, help="which link is to move, as panda/panda_hand")
    parser.add_argument(
        "--poses",
        type=Path,
        required=True,
        help="a TOML file of tables [[poses]]: t, xyz, rpy, and relative = true for ways from "
        "where the link starts",
    )
    parser.add_argument(
        "--spacing", type=float, metavar="M", help="longest way between two waypoints [m]"
    )
    parser.add_argument(
        "--out",
        type=Path,
        metavar="FILE",
        help="write a copy of the scenario, in its folder, with these targets in place of those of "
        "the link's body; standard output otherwise",
    )


def run(options: argparse.Namespace) -> int:
    """Print the waypoints, or write the scenario with them.

    Raises
    ------
    InputError
        If the scenario would be written in another folder.
    """
    scenario = load_scenario(options.scenario)
    with about_file(options.poses):
        top = TableReader(toml_read(options.poses), error=ScenarioError)
        poses = top.sequence("poses")
        top.close()
        with needing("targets"):
            from quasistatic_ref.optional.targets.joint_targets import joint_targets
        found = joint_targets(
            scenario,
            options.link,
            poses,
            **({} if options.spacing is None else {"spacing": options.spacing}),
        )
    body = scenario.system.links[scenario.system.link(options.link)].partition("/")[0]
    text = "\n".join(_waypoint(body, values) for values in found)
    if options.out is None:
        sys.stdout.write(text)
        return 0
    if options.out.resolve().parent != options.scenario.resolve().parent:
        problem = "must be in the scenario's folder, where its files are"
        raise InputError(problem, field="--out", value=str(options.out))
    whole = with_targets(options.scenario.read_text(encoding="utf-8"), body, text)
    print(f"wrote {text_written(options.out, whole)}")
    load_scenario(options.out)
    return 0


def _waypoint(body: str, values: Mapping[str, float]) -> str:
    lines = [f"{name} = {value!r}" for name, value in values.items()]
    return "\n".join([f"[[bodies.{body}.targets]]", *lines, ""])


def with_targets(scenario: str, body: str, targets: str) -> str:
    """A scenario's text with the tables `targets` in place of those of a body.

    Raises
    ------
    InputError
        If the targets stand there in another form, which this does not edit.
    """
    heading = rf"\[\[bodies\.{re.escape(body)}\.targets\]\]"
    others = re.sub(rf"(?ms)^{heading}.*?(?=^\[|\Z)", "", scenario)
    if "targets" in tomllib.loads(others)["bodies"][body]:
        problem = f"of {body} are not tables [[bodies.{body}.targets]]; remove them from the file"
        raise InputError(problem, field="targets")
    return f"{others.rstrip()}\n\n{targets}"
