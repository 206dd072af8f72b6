"""Every field of a scenario, said once: the loader, the JSON Schema and the reference page read it.

Rules about several fields, such as that rows = 6 needs mu_omega, are checked by the loader.
"""

from numpy.typing import ArrayLike

from quasistatic_ref.files.scenario.world_solids import SOLIDS
from quasistatic_ref.model.body import BASE_WORDS
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.simulate.distance_source import DISTANCES
from quasistatic_ref.simulate.law import LAWS
from quasistatic_ref.simulate.limits import Limits
from quasistatic_ref.simulate.record.header import RECORDS
from quasistatic_ref.simulate.settings import Settings
from quasistatic_ref.simulate.simulator import GRAVITY
from quasistatic_ref.solve.backends import CERTIFY
from quasistatic_ref.step.cones import CONES
from quasistatic_ref.text.declared import Field, Tables, head
from quasistatic_ref.text.table_reader import TableReader

FORMAT = "quasistatic-ref/scenario"
VERSION = 1
MOST_STEPS = 10_000_000
TOP = "the top of the file"
SOLVER = "[solver]"
LIMITS = "[limits]"
FINDINGS = "[findings]"
BODY = "[bodies.NAME]"
CONTACT = "[contacts.NAME]"
WRENCH = "[[bodies.NAME.wrenches]]"
SHAPE = "[shapes.NAME]"
POSE = "pose"
WAYPOINT = "[[bodies.NAME.targets]]"
SUPPORT = "[bodies.NAME.support]"
WITHIN = "k"
ORIGIN = (0.0, 0.0, 0.0)
NUMBER = {"type": "number"}
TEXT = {"type": "string"}
LIST = {"type": "array", "items": NUMBER}
MATRIX = {"type": "array", "items": LIST}
_TURN = "roll, pitch, yaw: R = Rz(yaw) Ry(pitch) Rx(roll)"
_SIDE = {"anyOf": [TEXT, {"type": "array", "items": TEXT, "minItems": 1}]}
_NAMES = (
    "a link (body/link), one of its shapes (body/NAME of the URDF's collision), a body, a shape, "
    "a list of these, or a pattern of links (hand/*)"
)
_STIFF = {"anyOf": [{"type": "number", "minimum": 0, "exclusiveMinimum": True}, LIST, MATRIX]}
URDF = "urdf"
"""In place of a table: what the URDF says."""
TARGET = {"anyOf": [NUMBER, {"$ref": f"#/definitions/{POSE}"}]}

TABLES = Tables({
    TOP: {
        **head(FORMAT, VERSION),
        "h": Field("number", "time step", "s", above=0.0),
        "steps": Field("integer", "how many", least=0, most=MOST_STEPS),
        "gravity": Field("three numbers", "free fall in the world frame", "m/s^2", GRAVITY),
        "cone": Field(
            "text", f"friction cone of every contact: {', '.join(CONES)} (K even, from 4 on)",
            default=Settings.cone,
            schema={"pattern": rf"^({'|'.join(CONES)})$".replace("-K", "-[0-9]+")},
        ),
        "law": Field(
            "text", "whether sliding contacts rise, as in the model, or not (coulomb)",
            default=Settings.law, choices=LAWS,
        ),
        "distances": Field(
            "text",
            "closed forms, or coal's distances of points of clouds to boxes, spheres, capsules and "
            "half-spaces",
            default=Settings.distances, choices=DISTANCES,
        ),
        "fast": Field(
            "boolean", "whether the backend is daqp where none is named: the same certified bits, "
            "sooner",
            default=False,
        ),
        "record": Field(
            "text",
            "what a trajectory holds; light leaves the quadratic programs out, forces has the "
            "forces of single contacts in their place",
            default=RECORDS[0], choices=RECORDS,
        ),
        "solver": Field("table", "the backend, and what is proved", default={}, of=SOLVER),
        "limits": Field("table", "where a run ends early", default={}, of=LIMITS),
        "findings": Field("table", "what is not said", default={}, of=FINDINGS),
        "roots": Field(
            "list of words", "folders from which robots are read besides their own, and in which "
            "package:// is looked for; --root FOLDER names them", default=[],
        ),
        "bodies": Field("tables by name", "what moves", of=BODY, schema={"minProperties": 1}),
        "shapes": Field("tables by name", "solids that stand still", default={}, of=SHAPE),
        "contacts": Field("tables by name", "who may touch whom", default={}, of=CONTACT),
    },
    SOLVER: {
        "backend": Field("text", "name of a solver; quasistatic-ref backends", default=None),
        "accuracy": Field(
            "number", "of the backend, in natural units", "-", Settings.accuracy, above=0.0,
        ),
        "certify": Field("text", "what is proved", default=Settings.certify, choices=CERTIFY),
    },
    LIMITS: {
        "penetration": Field(
            "number", "deepest penetration that a step is taken from", "m", Limits.penetration,
            above=0.0,
        ),
        "reach": Field(
            "number", "farthest that a link may come from the origin", "m", Limits.reach, above=0.0,
        ),
    },
    FINDINGS: {
        "ignore": Field("list of words", "names of findings that are not said", default=[]),
    },
    BODY: {
        "urdf": Field("text", "file in the scenario's folder, or package://NAME/PATH of a robot",
                      schema={"pattern": r"\S"}),
        "base": Field("text", "how the root link moves", default="fixed", choices=BASE_WORDS),
        "actuated": Field(
            'names of joints, "joints" or "all"',
            'joints that have targets; "base" is the base, which "all" takes and "joints" does not',
            default=[],
            schema={"anyOf": [{"enum": ["all", "joints"]}, {"type": "array", "items": TEXT}]},
        ),
        "pose": Field("table", "where the root link is, or starts", default={}, of=POSE),
        "positions": Field(
            "table of numbers", "where joints start, 0 for those not named", "m, rad", {},
            schema={"type": "object", "additionalProperties": NUMBER},
        ),
        "package_dirs": Field(
            "list of words", "roots of this body alone", default=[],
        ),
        "K_q": Field(
            "table by joint, or of the whole body",
            "stiffness of each actuated joint, or of all: a number, a list (diagonal) or a matrix",
            "N/m, N m/rad", None,
            schema={"anyOf": [_STIFF, {"type": "object", "additionalProperties": _STIFF}]},
        ),
        "targets": Field("list of tables", "waypoints, linear in time, held at both ends",
                         default=[], of=WAYPOINT),
        "cloud": Field(
            "text",
            "file of points in the root link's frame, meant by the body's name in contacts; a "
            "repeated point counts once",
            "m", None,
            schema={"pattern": r"\S"},
        ),
        "gravity_compensated": Field(
            "boolean", "whether the robot carries its own weight at actuated joints", default=True,
        ),
        "wrenches": Field("list of tables", "external forces and torques", default=[], of=WRENCH),
        "joint_friction": Field(
            'table by joint, or "urdf"',
            "force at which a joint slides: a number, of a planar base three; \"urdf\" takes "
            "<dynamics friction> of the file",
            "N, N m", None,
            schema={"anyOf": [
                {"enum": [URDF]},
                {"type": "object", "additionalProperties": {"anyOf": [NUMBER, LIST]}},
            ]},
        ),
        "joint_limits": Field(
            'table by joint, or "urdf"',
            "least and greatest position of a joint, its stops, -inf and inf where there is none; "
            "\"urdf\" takes those of the file",
            "m, rad", None,
            schema={"anyOf": [
                {"enum": [URDF]},
                {"type": "object", "additionalProperties": LIST},
            ]},
        ),
        "support": Field(
            "table", "friction of a planar base on its floor", default=None, of=SUPPORT,
        ),
    },
    POSE: {
        "xyz": Field("three numbers", "origin in the world", "m", ORIGIN),
        "rpy": Field("three numbers", _TURN, "rad", (0.0, 0.0, 0.0)),
    },
    WAYPOINT: {"t": Field("number", "time; next to it any joints and their values", "s")},
    WRENCH: {
        "t": Field("number", "time; held before the first one and after the last", "s"),
        "force": Field(
            "three numbers", "at the centre of mass of the root link, world frame", "N",
            (0.0, 0.0, 0.0),
        ),
        "torque": Field("three numbers", "about it, world frame", "N m", (0.0, 0.0, 0.0)),
    },
    SHAPE: {
        "pose": Field("table", "where it stands", default={}, of=POSE),
        **{kind: Field("table", f"solid: {kind}", default=None, of=kind) for kind in SOLIDS},
    },
    **{kind: dict(solid.fields) for kind, solid in SOLIDS.items()},
    CONTACT: {
        "alpha": Field("name or names", _NAMES, schema=_SIDE),
        "beta": Field("name or names", "the same; normals point towards it", schema=_SIDE),
        "mu_v": Field("number", "tangential friction", "-", least=0.0),
        "mu_omega": Field("number", "torsional friction; needed with rows = 6", "m", None,
                          least=0.0),
        "rows": Field("integer", "rows of a contact; 4 goes without mu_omega", default=6,
                      choices=(4, 6)),
        "k": Field(
            "whole number from 1, or table",
            "how many of the closest points are kept; or how near they are at the start, "
            '{ within = "5 mm" }',
            default=1,
            schema={"anyOf": [{"type": "integer", "minimum": 1}, {"$ref": "#/definitions/k"}]},
        ),
        "hull": Field("boolean", "whether a mesh that is not convex counts as its hull",
                      default=False),
    },
    WITHIN: {
        "within": Field(
            "text", "how much farther than the nearest one at most: a number, and m, cm, mm or um",
        ),
    },
    SUPPORT: {
        "mu_v": Field("number", "tangential friction", "-", least=0.0),
        "mu_omega": Field("number", "torsional friction, of a patch by (R15)", "m", 0.0, least=0.0),
    },
})  # fmt: skip
"""The fields of each kind of table, in the order of the reference page."""

fields_of = TABLES.fields


def pose(table: TableReader, xyz: ArrayLike = ORIGIN) -> tuple[Array, Array]:
    """Origin [m] and roll, pitch, yaw [rad] of a table of these two, each of shape (3,)."""
    read = fields_of(table, POSE)
    origin = read("xyz", xyz)
    rpy = read("rpy")
    table.close()
    return origin, rpy
