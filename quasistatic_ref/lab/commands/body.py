"""``body SCAN --mass KG``: a body of a scenario from a point cloud or a mesh."""

import argparse
import sys
from pathlib import Path

from quasistatic_ref.files.clouds import KINDS
from quasistatic_ref.files.mesh_files import MESHES
from quasistatic_ref.parts import needing


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    clouds, meshes = (
        ", ".join(suffix.removeprefix(".").upper() for suffix in kinds) for kinds in (KINDS, MESHES)
    )
    parser.add_argument("scan", type=Path, help=f"a cloud ({clouds}) or a mesh ({meshes})")
    weight = parser.add_mutually_exclusive_group(required=True)
    weight.add_argument("--mass", type=float, metavar="KG", help="mass of the body [kg]")
    words = "density of the body, in place of its mass [kg/m^3]"
    weight.add_argument("--density", type=float, metavar="RHO", help=words)
    words = "unit of the lengths in the file: m (default), cm, mm or in"
    parser.add_argument("--unit", metavar="UNIT", help=words)
    parser.add_argument("--points", type=int, metavar="N", help="keep at most N points (1000)")
    parser.add_argument("--name", help="name of the body (default: the name of the file)")
    parser.add_argument(
        "--out", type=Path, default=Path(), metavar="FOLDER",
        help="folder for NAME.csv and NAME.urdf (default: the current folder)",
    )  # fmt: skip


def run(options: argparse.Namespace) -> int:
    """Write the files, say on standard error what was done, and print a scenario."""
    with needing("body"):
        from quasistatic_ref.optional.scans.body import scanned_body
    made = scanned_body(
        options.scan,
        mass=options.mass,
        density=options.density,
        unit=options.unit,
        name=options.name,
        **({} if options.points is None else {"points": options.points}),
    )
    for file in made.save(options.out):
        print(f"wrote {file}", file=sys.stderr)
    for note in made.notes:
        print(f"{made.name}: {note}", file=sys.stderr)
    print(made.scenario(), end="")
    return 0
