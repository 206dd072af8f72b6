"""Each element of MJCF of which nothing is read is listed as ignored, or refused.

Its attributes and children need no file of their own.
"""

import pytest

from tests.model.urdf.urdf_texts import LISTED, REFUSED
from tests.optional.mjcf.small_files import VERTICES, effect, models, outcome, schema

# Some 600 small files in all; MuJoCo warns of two.
pytestmark = [pytest.mark.usefixtures("in_this_process"), pytest.mark.filterwarnings("ignore")]

LIMITED = '<joint name="k" range="-1 1"/>'
BASE = f"""<mujoco><asset>
<mesh name="m" {VERTICES}/><hfield name="h" nrow="2" ncol="2" size="1 1 1 1"/>
<texture name="x" builtin="flat" type="2d" width="4" height="4"/></asset>
<worldbody><camera name="c"/><body name="b"><joint name="j"/><geom name="g" size="0.1"/>
<site name="s"/><body name="b2">{LIMITED}<geom name="g2" size="0.2"/><site name="s2"/>@</body>
</body></worldbody>
<tendon><fixed name="t" range="-1 1"><joint joint="j" coef="1"/></fixed></tendon>
<actuator><motor name="a" joint="j" ctrlrange="0 1"/></actuator>#</mujoco>"""
"""A file with one of each that others refer to."""
REFERENCES = {
    "site": "s", "joint": "k", "tendon": "t", "actuator": "a", "body": "b", "camera": "c",
    "objtype": "body", "objname": "b", "reftype": "body", "refname": "b2", "geom": "g",
    "geom1": "g", "geom2": "g2", "mesh": "m",
}  # fmt: skip
SENSORS = {
    "rangefinder": 'site="s"',
    "contact": 'geom1="g"',
    "user": 'dim="1"',
    "plugin": 'plugin="mujoco.sensor.touch_grid" objtype="site" objname="s"',
}
ACTUATORS = {
    "orientation": 'joint="n" kp="1"',
    "adhesion": 'body="b" ctrlrange="0 1"',
    "damper": 'joint="j" ctrlrange="0 1"',
    "dcmotor": 'joint="j" motorconst="1" resistance="1"',
    "muscle": 'joint="k"',
    "plugin": 'joint="j" plugin="mujoco.pid"',
}
OF_DEFAULT = {
    "texture": 'random="0.3"', "material": 'rgba="1 0 0 1"', "site": 'group="2"',
    "camera": 'fovy="30"', "light": 'active="false"', "pair": 'condim="4"',
    "equality": 'active="false"', "tendon": 'group="2"',
    "damper": 'ctrlrange="0 1" group="2"', "adhesion": 'ctrlrange="0 1" group="2"',
    "dcmotor": 'motorconst="3" resistance="1"',
}  # fmt: skip
INSIDE = {
    "body.site": '<site name="n"/>',
    "body.camera": '<camera name="n"/>',
    "body.light": '<light name="n"/>',
    "body.plugin": '<plugin plugin="mujoco.elasticity.cable"/>',
    "body.geom.plugin": '<geom type="sdf" mesh="m"><plugin plugin="mujoco.sdf.torus"/></geom>',
}
FLEX = '<flexcomp name="n" type="grid" count="3 3 1" dim="2" mass="1" radius="0.01"/>'
TRILINEAR = '<flexcomp name="n" type="grid" count="3 3 3" dim="3" mass="1" dof="trilinear"/>'
NEXT_TO_WORLDBODY = {
    "body.flexcomp": f"<worldbody>{FLEX}</worldbody>",
    "option": '<option timestep="0.1"/>',
    "size": '<size nuserdata="3"/>',
    "statistic": '<statistic extent="3"/>',
    "compiler.lengthrange": '<compiler><lengthrange accel="3"/></compiler>',
    "visual.global": '<visual><global fovy="30"/></visual>',
    "visual.quality": '<visual><quality shadowsize="8"/></visual>',
    "visual.headlight": '<visual><headlight ambient="1 0 0"/></visual>',
    "visual.map": '<visual><map force="3"/></visual>',
    "visual.scale": '<visual><scale com="3"/></visual>',
    "visual.rgba": '<visual><rgba com="1 0 0 1"/></visual>',
    "extension.plugin": '<extension><plugin plugin="mujoco.pid"/></extension>',
    "asset.mesh.plugin": (
        '<asset><mesh name="n"><plugin plugin="mujoco.sdf.torus"/></mesh></asset>'
    ),
    "asset.hfield": '<asset><hfield name="n" nrow="2" ncol="2" size="1 1 1 1"/></asset>',
    "asset.skin": (
        '<asset><skin name="n" vertex="0 0 0 1 0 0 0 1 0" face="0 1 2"><bone body="b" '
        'bindpos="0 0 0" bindquat="1 0 0 0" vertid="0 1 2" vertweight="1 1 1"/></skin></asset>'
    ),
    "asset.texture": (
        '<asset><texture name="n" builtin="flat" type="2d" width="4" height="4"/></asset>'
    ),
    "asset.material": '<asset><material name="n"/></asset>',
    "deformable.flex": (
        '<deformable><flex name="n" dim="2" body="b b b2" vertex="0 0 0 1 0 0 0 1 0" '
        'element="0 1 2"/></deformable>'
    ),
    "deformable.skin": (
        '<deformable><skin name="n" vertex="0 0 0 1 0 0 0 1 0" face="0 1 2"><bone body="b" '
        'bindpos="0 0 0" bindquat="1 0 0 0" vertid="0 1 2" vertweight="1 1 1"/></skin></deformable>'
    ),
    "contact.pair": '<contact><pair geom1="g" geom2="g2"/></contact>',
    "contact.exclude": '<contact><exclude body1="b" body2="b2"/></contact>',
    "tendon.spatial": (
        '<tendon><spatial name="n"><site site="s"/><site site="s2"/></spatial></tendon>'
    ),
    "tendon.fixed": '<tendon><fixed name="n"><joint joint="j" coef="1"/></fixed></tendon>',
    "equality.connect": '<equality><connect body1="b" body2="b2" anchor="0 0 0"/></equality>',
    "equality.weld": '<equality><weld body1="b" body2="b2"/></equality>',
    "equality.joint": '<equality><joint joint1="j"/></equality>',
    "equality.tendon": '<equality><tendon tendon1="t"/></equality>',
    "equality.flex": f'<worldbody>{FLEX}</worldbody><equality><flex flex="n"/></equality>',
    "equality.flexstrain": (
        f"<worldbody>{TRILINEAR}</worldbody>"
        '<equality><flexstrain flex="n" cell="0 0 0"/></equality>'
    ),
    "custom.numeric": '<custom><numeric name="n" data="1"/></custom>',
    "custom.text": '<custom><text name="n" data="1"/></custom>',
    "custom.tuple": (
        '<custom><tuple name="n"><element objtype="body" objname="b"/></tuple></custom>'
    ),
    "keyframe.key": '<keyframe><key name="n" time="1"/></keyframe>',
}
"""Elements of which nothing is read, in a file in which all else is read."""


OF_BALLS = ("sensor.ballquat", "sensor.ballangvel", "actuator.orientation")
BALL = '<body><joint name="n" type="ball"/><geom size="0.1"/></body></worldbody>'


def whole_elements():
    """Files, each with one element of which nothing is read."""
    found = {name: BASE.replace("@", text).replace("#", "") for name, text in INSIDE.items()}
    elements = dict(NEXT_TO_WORLDBODY)
    for element, names in schema().items():
        section, tag = (*element, "", "")[:2]
        if len(element) != 2:
            continue
        refers = " ".join(f'{name}="{REFERENCES[name]}"' for name in names if name in REFERENCES)
        if section == "sensor":
            elements[f"sensor.{tag}"] = (
                f'<sensor><{tag} name="n" {SENSORS.get(tag, refers)}/></sensor>'
            )
        if section == "actuator":
            text = ACTUATORS.get(tag, 'joint="j"')
            elements[f"actuator.{tag}"] = f'<actuator><{tag} name="n" {text}/></actuator>'
        if section == "default" and tag not in ("mesh", "joint", "geom"):
            text = OF_DEFAULT.get(tag, 'group="2"')
            elements[f"default.{tag}"] = f"<default><{tag} {text}/></default>"
    plain = BASE.replace("@", "")
    found |= {name: plain.replace("#", text) for name, text in elements.items()}
    for name in OF_BALLS:
        found[name] = found[name].replace("</worldbody>", BALL).replace('"k"/>', '"n"/>')
    return found


WHOLE = whole_elements()
NOT_ONE_BODY = ("equality.", "body.flexcomp", "deformable.flex")
"""Those that are refused here; plugins are refused by MuJoCo, which has none unless it is given."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return models(tmp_path_factory.mktemp("models"))


@pytest.mark.parametrize("name", WHOLE)
def test_an_element_of_which_nothing_is_read_is_listed_or_refused(folder, name):
    without = BASE.replace("@", "").replace("#", "")
    if name in OF_BALLS:
        without = without.replace("</worldbody>", BALL)
    assert isinstance(outcome(folder, without, "fixed"), tuple)
    plugin = name.endswith("plugin") and name != "extension.plugin"
    expected = REFUSED if plugin or name.startswith(NOT_ONE_BODY) else LISTED
    assert effect(folder, WHOLE[name], without, name) == expected
    if expected == REFUSED:
        by_mujoco = "MuJoCo refuses it" in str(outcome(folder, WHOLE[name], "fixed"))
        assert by_mujoco == plugin
