"""Each attribute of MJCF is read, listed as ignored, or refused.

Which there are is what MuJoCo's own schema says. Small files hold them one by one; compared with
the file without it, each changes what is loaded, or what is listed, or is refused.
"""

import re

import pytest

from quasistatic_ref.cli.ignored import ALWAYS
from tests.model.urdf.urdf_texts import LISTED, REFUSED, USED
from tests.optional.mjcf.small_files import VERTICES, effect, models, schema
from tests.optional.mjcf.test_ignored_elements import WHOLE

# Some 600 small files in all; MuJoCo warns of two.
pytestmark = [pytest.mark.usefixtures("in_this_process"), pytest.mark.filterwarnings("ignore")]

CLASS = '<default><default class="d"><geom size="0.7"/><joint axis="0 1 1"/><mesh scale="2 3 4"/>'
CLASS += "</default></default>"
BLUE = '<asset><material name="blue" rgba="0 0 1 1"/></asset>'
GEOM = '<geom type="box" size="0.1 0.2 0.3" pos="0 0.1 0.2" euler="10 20 30"/>'
TURNED = '<body euler="10 20 30"><geom size="0.1"/></body>'
OF_MESH = '<body><geom type="mesh" mesh="m"/></body>'


def doc(body, *sections):
    return f"<mujoco>{CLASS}{BLUE}{''.join(sections)}<worldbody>{body}</worldbody></mujoco>"


def mesh(attributes):
    return f"<asset><mesh {attributes}/></asset>"


TEMPLATES = {
    ("compiler",): doc(TURNED, "<compiler @/>"),
    ("asset", "mesh"): doc(OF_MESH, mesh(f'name="m" {VERTICES} @')),
    ("body",): doc('<body><joint/><geom size="0.2"/><body @><geom size="0.1"/></body></body>'),
    ("body", "joint"): doc(f'<body name="b"><joint @/>{GEOM}</body>'),
    ("body", "freejoint"): doc(f"<body><freejoint @/>{GEOM}</body>"),
    ("body", "geom"): doc('<body><geom size="0.1 0.2 0.3" @/></body>'),
}  # fmt: skip
"""Files in which an attribute stands where @ is."""
PLACE = {
    "pos": "1 2 3", "quat": "0.8 0.6 0 0", "axisangle": "1 0 0 40", "euler": "10 20 30",
    "xyaxes": "0 1 0 -1 0 0", "zaxis": "1 1 1",
}  # fmt: skip
VALUES = {
    ("compiler",): {
        "usethread": "false", "saveinertial": "true", "savecanonical": "false", "angle": "radian",
        "savecompiled": "false", "passthrough": "textures", "texturedir": "in", "eulerseq": "zyx",
        "coordinate": "global", "settotalmass": "3", "boundmass": "100", "boundinertia": "9",
    },
    ("asset", "mesh"): {
        "inertia": "shell", "maxhullvert": "4", "scale": "1 2 3", "refpos": "0.1 0.2 0.3",
        "refquat": "0 1 0 0", "normal": "1 0 0 0 1 0 0 0 1 1 0 0", "smoothnormal": "true",
        "texcoord": "0 0 0 1 1 0 1 1", "material": "blue", "face": "0 2 1 0 1 3 0 3 2 1 2 3",
        "class": "d",
    },
    ("body",): PLACE | {
        "gravcomp": "1", "mocap": "true", "user": "1", "name": "named", "childclass": "none",
    },
    ("body", "joint"): {
        "name": "named", "class": "d", "type": "slide", "axis": "1 2 3", "pos": "1 2 3",
        "range": "-10 20", "frictionloss": "0.3", "actuatorfrcrange": "-1 1", "armature": "0.1",
        "actuatorfrclimited": "true", "actuatorgravcomp": "true", "damping": "1", "group": "2",
        "limited": "true", "margin": "0.1", "ref": "0.2", "solimpfriction": "0.8 0.9 0.1",
        "solimplimit": "0.8 0.9 0.1", "solreffriction": "0.1 1", "solreflimit": "0.1 1",
        "springdamper": "0.1 1", "springref": "0.1", "springyield": "0.1", "stiffness": "3",
        "user": "1",
    },
    ("body", "freejoint"): {"align": "true", "group": "2", "name": "named"},
    ("body", "geom"): PLACE | {
        "name": "named", "type": "box", "density": "300", "mass": "3", "shellinertia": "true",
        "rgba": "1 0 0 1", "material": "blue", "group": "4", "contype": "2", "conaffinity": "2",
        "adhesion": "0.1", "castshadow": "false", "condim": "4", "fluidcoef": "1 2 3 4 5",
        "fluidshape": "ellipsoid", "gap": "0.1", "margin": "0.2", "priority": "2", "solmix": "0.3",
        "solimp": "0.8 0.9 0.1", "solref": "0.1 1", "surfacevel": "1 0 0 0 0 0", "user": "1",
    },
}  # fmt: skip
"""A value of each attribute, which the file without it does not have by default."""
IGNORED = {
    ("compiler",): "passthrough savecanonical savecompiled saveinertial texturedir usethread",
    ("asset", "mesh"): "maxhullvert normal smoothnormal texcoord",
    ("body",): "gravcomp user",
    ("body", "joint"): (
        "actuatorfrcrange actuatorgravcomp armature damping group margin ref solimpfriction "
        "solimplimit solreffriction solreflimit springdamper springref springyield stiffness user"
    ),
    ("body", "freejoint"): "group name",
    ("body", "geom"): (
        "adhesion castshadow condim conaffinity contype fluidcoef fluidshape gap margin priority "
        "solimp solmix solref surfacevel user"
    ),
}
"""Which of them are listed."""
NEVER = {
    ("compiler",): "coordinate",
    ("body",): "mocap childclass",
    ("body", "joint"): "actuatorfrclimited limited",
}
"""Which of them are refused: by MuJoCo where they say too little, or contradict the others."""


def inertial(attributes):
    return doc(f"<body><inertial {attributes}/></body>")


def fitted_box(compiler, geom):
    box = f'<body><geom type="box" mesh="m" {geom}/></body>'
    return doc(box, f"<compiler {compiler}/>", mesh(f'name="m" {VERTICES}'))


def doc_with(attach, model='name="k" file="child.xml"', compiler=""):
    other = '<model name="l" file="other.xml"/>'
    body = f'<body><geom size="1"/><frame pos="1 0 0"><attach prefix="p" {attach}/></frame></body>'
    return doc(body, f"<compiler {compiler}/>", f"<asset><model {model}/>{other}</asset>")


ONE = 'mass="1" pos="0 0 0" diaginertia="1 1.5 2"'
FILE = mesh('name="m" file="a.obj"')
RANGE = '<body><joint range="-10 20"/><geom size="0.1"/></body>'
STATIC = f"<body>{GEOM}<body>{GEOM}</body></body>"
HFIELD = '<asset><hfield name="h" nrow="2" ncol="2" size="1 1 1 1"/></asset>'
SLEEP = '<body name="b" {}><joint/><geom size="0.1"/></body>'
PAIRS = {
    "compiler.alignfree": (
        doc(f"<body><freejoint/>{GEOM}</body>", '<compiler alignfree="true"/>'),
        doc(f"<body><freejoint/>{GEOM}</body>"), USED,
    ),
    "compiler.assetdir": (
        doc(OF_MESH, FILE, '<compiler assetdir="in"/>'), doc(OF_MESH, FILE), USED,
    ),
    "compiler.meshdir": (
        doc(OF_MESH, FILE, '<compiler meshdir="in"/>'), doc(OF_MESH, FILE), USED,
    ),
    "compiler.strippath": (
        doc(OF_MESH, mesh('name="m" file="in/a.obj"'), '<compiler strippath="true"/>'),
        doc(OF_MESH, mesh('name="m" file="in/a.obj"')), USED,
    ),
    "compiler.autolimits": (doc(RANGE, '<compiler autolimits="false"/>'), doc(RANGE), REFUSED),
    "compiler.balanceinertia": (
        doc('<body><inertial mass="1" pos="0 0 0" diaginertia="1 1 3"/></body>',
            '<compiler balanceinertia="true"/>'),
        doc('<body><inertial mass="1" pos="0 0 0" diaginertia="1 1 3"/></body>'), USED,
    ),
    "compiler.conflict": (
        doc_with('model="k" body="c"', compiler='conflict="error"'), doc_with('model="k" body="c"'),
        LISTED,
    ),
    "compiler.discardvisual": (
        doc('<body><geom size="1"/><geom size="0.1" contype="0" conaffinity="0"/></body>',
            '<compiler discardvisual="true"/>'),
        doc('<body><geom size="1"/><geom size="0.1" contype="0" conaffinity="0"/></body>'), USED,
    ),
    "compiler.fitaabb": (fitted_box('fitaabb="true"', ""), fitted_box("", ""), USED),
    "compiler.fusestatic": (doc(STATIC, '<compiler fusestatic="true"/>'), doc(STATIC), USED),
    "compiler.inertiafromgeom": (
        doc(f"<body><inertial {ONE}/>{GEOM}</body>", '<compiler inertiafromgeom="true"/>'),
        doc(f"<body><inertial {ONE}/>{GEOM}</body>"), USED,
    ),
    "compiler.inertiagrouprange": (
        doc(f'<body>{GEOM}<geom size="1" group="3"/></body>',
            '<compiler inertiagrouprange="0 2"/>'),
        doc(f'<body>{GEOM}<geom size="1" group="3"/></body>'), USED,
    ),
    "default.class": (
        doc('<body><geom class="d"/></body>').replace('"d"', '"e"', 1),
        doc('<body><geom class="d"/></body>'), REFUSED,
    ),
    "asset.mesh.name": (
        doc(OF_MESH, mesh(f'name="n" {VERTICES}')), doc(OF_MESH, mesh(f'name="m" {VERTICES}')),
        REFUSED,
    ),
    "asset.mesh.file": (
        doc(OF_MESH, mesh('name="m" file="b.obj"')), doc(OF_MESH, FILE), USED,
    ),
    "asset.mesh.content_type": (
        doc(OF_MESH, mesh('name="m" file="a.obj" content_type="model/stl"')), doc(OF_MESH, FILE),
        LISTED,
    ),
    "asset.mesh.vertex": (
        doc(OF_MESH, mesh(f'name="m" {VERTICES}'.replace("0.1", "0.3"))),
        doc(OF_MESH, mesh(f'name="m" {VERTICES}')), USED,
    ),
    "asset.mesh.builtin": (
        doc(OF_MESH, mesh('name="m" builtin="cone" params="8 0.5"')),
        doc(OF_MESH, mesh('name="m" builtin="sphere" params="2"')), USED,
    ),
    "asset.mesh.params": (
        doc(OF_MESH, mesh('name="m" builtin="cone" params="8 0.5"')),
        doc(OF_MESH, mesh('name="m" builtin="cone" params="8 0.4"')), USED,
    ),
    "asset.model.name": (
        doc_with('model="k" body="c"', 'name="m" file="child.xml"'),
        doc_with('model="k" body="c"'), REFUSED,
    ),
    "asset.model.file": (
        doc_with('model="k" body="c"', 'name="k" file="other.xml"'),
        doc_with('model="k" body="c"'), USED,
    ),
    "asset.model.content_type": (
        doc_with('model="k" body="c"', 'name="k" file="child" content_type="text/xml"'),
        doc_with('model="k" body="c"', 'name="k" file="child"'), USED,
    ),
    "body.attach.model": (doc_with('model="l" body="c"'), doc_with('model="k" body="c"'), USED),
    "body.attach.body": (doc_with('model="k" body="d"'), doc_with('model="k" body="c"'), USED),
    "body.attach.frame": (doc_with('model="k" frame="f"'), doc_with('model="k" body="c"'), USED),
    "body.attach.prefix": (
        doc_with('model="k" body="c"').replace('"p"', '"q"'), doc_with('model="k" body="c"'), USED,
    ),
    "body.fuse": (
        doc(STATIC.replace("><body>", '><body fuse="false">'), '<compiler fusestatic="true"/>'),
        doc(STATIC, '<compiler fusestatic="true"/>'), USED,
    ),
    "body.simple": (
        doc(STATIC.replace("><body>", '><body simple="false">')), doc(STATIC), LISTED,
    ),
    "body.sleep": (doc(SLEEP.format('sleep="never"')), doc(SLEEP.format("")), LISTED),
    "body.inertial.mass": (inertial(ONE.replace("1", "3", 1)), inertial(ONE), USED),
    "body.inertial.diaginertia": (inertial(ONE.replace("1.5", "2")), inertial(ONE), USED),
    "body.inertial.fullinertia": (
        inertial('mass="1" pos="0 0 0" fullinertia="1 1.5 2 0.1 0.2 0.1"'), inertial(ONE), USED,
    ),
    "body.inertial.pos": (inertial(ONE.replace("0 0 0", "1 2 3")), inertial(ONE), USED),
    **{
        f"body.inertial.{name}": (inertial(f'{ONE} {name}="{value}"'), inertial(ONE), USED)
        for name, value in PLACE.items() if name != "pos"
    },
    "body.geom.size": (
        doc('<body><geom size="0.1"/></body>'), doc('<body><geom size="0.2"/></body>'), USED,
    ),
    "body.geom.class": (
        doc('<body><geom class="d"/></body>'), doc('<body><geom size="0.2"/></body>'), USED,
    ),
    "body.geom.fromto": (
        doc('<body><geom type="capsule" size="0.1" fromto="0 0 0 0 0 1"/></body>'),
        doc('<body><geom type="capsule" size="0.1" fromto="0 0 0 0 1 0"/></body>'), USED,
    ),
    "body.geom.mesh": (
        doc(OF_MESH, FILE, mesh('name="n" file="b.obj"')).replace('mesh="m"', 'mesh="n"'),
        doc(OF_MESH, FILE, mesh('name="n" file="b.obj"')), USED,
    ),
    "body.geom.fitscale": (fitted_box("", 'fitscale="2"'), fitted_box("", ""), USED),
    "body.geom.hfield": (
        doc(f'<geom type="hfield" hfield="h"/>{STATIC}', HFIELD), doc(STATIC, HFIELD), LISTED,
    ),
    "default.geom.hfield": (
        doc('<geom type="hfield"/>', "<default><geom hfield='h'/></default>", HFIELD),
        doc("", HFIELD), LISTED,
    ),
    "body.geom.friction": (
        doc('<body><geom size="0.1" friction="0.3"/></body>'),
        doc('<body><geom size="0.1" contype="0" conaffinity="0"/></body>'), USED,
    ),
}  # fmt: skip
"""Attributes that need a file of their own: that file, another one, and what differs."""


def attributes():
    """Each attribute of elements that are read in part."""
    found = {}
    for element, values in VALUES.items():
        for name, value in values.items():
            effect = LISTED if name in IGNORED.get(element, "").split() else USED
            if name in NEVER.get(element, "").split():
                effect = REFUSED
            text = TEMPLATES[element]
            without = text.replace("@", "")
            said = f'{name}="{value}"'
            found[".".join((*element, name))] = text.replace("@", said), without, effect
            if name in schema().get(("default", element[-1]), ()):
                default = f"<mujoco><default><{element[-1]} {said}/></default>"
                text = without.replace("<mujoco>", default)
                found[f"default.{element[-1]}.{name}"] = text, without, effect
    for name in ("fitscale", "friction", "fromto", "mesh", "size"):
        text, without, effect = PAIRS[f"body.geom.{name}"]
        said = re.findall(f' {name}="[^"]*"', text)[-1]
        default = f"<mujoco><default><geom{said}/></default>"
        text = text.replace(said, "").replace("<mujoco>", default)
        found[f"default.geom.{name}"] = text, without, effect
    return found | PAIRS


ATTRIBUTES = attributes()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return models(tmp_path_factory.mktemp("models"))


@pytest.mark.parametrize("name", ATTRIBUTES)
def test_an_attribute_is_read_or_listed_or_refused(folder, name):
    text, without, expected = ATTRIBUTES[name]
    assert effect(folder, text, without, name.rpartition(".")[2]) == expected


def test_nothing_that_mujoco_reads_is_left_out():
    """The name of a model, like that of a robot, is no part of it: `inspect` says so always."""
    assert any(line.startswith("names of robots") for line in ALWAYS)
    names = {".".join((*e, a)) for e, attributes in schema().items() for a in attributes}
    inside = [name for name in names if not any(name.startswith(f"{e}.") for e in WHOLE)]
    assert sorted(set(inside) - set(ATTRIBUTES)) == ["model"]
    assert set(ATTRIBUTES) <= names
    elements = {".".join(element) for element in schema()}
    assert set(WHOLE) <= elements
