"""Small MJCF files: what becomes of a word that one says more than another."""

import re
from functools import cache

import mujoco

from quasistatic_ref import ModelError
from quasistatic_ref.model.urdf.urdf_file import urdf_file
from quasistatic_ref.optional.mjcf.mjcf import mjcf_urdf
from tests.model.urdf.urdf_texts import LISTED, OBJ, REFUSED, USED, urdf_of_text


@cache
def schema():
    """The attributes of each element, by its tags below <mujoco>, as MuJoCo prints them."""
    found = {}
    path = ()
    for line in mujoco.mj_printSchema(False, False).splitlines():
        element = re.match(r"( *)(\S+) \(.\)(.*)", line)
        if element:
            tag = element[2].replace("(world)body", "body")
            path = (*path[: len(element[1]) // 3], tag)
            found[path[1:]] = element[3].split()
        elif path:
            found[path[1:]] += line.split()
    return found


CHILD = """<mujoco><option timestep="0.1"/><worldbody><body name="c"><geom size="{}"/></body>
<body name="e"><geom size="0.2"/></body><frame name="f"><body name="d"><geom size="0.3"/></body>
</frame></worldbody></mujoco>"""
VERTICES = 'vertex="0 0 0 0.1 0 0 0 0.2 0 0 0 0.3"'


def models(path):
    """A folder with the meshes and models that the files name."""
    (path / "in").mkdir()
    for name, size in {"a.obj": 0.1, "b.obj": 0.4, "in/a.obj": 0.7}.items():
        urdf_of_text(path, OBJ.format(size), name)
    for name, size in {"child.xml": 0.1, "child": 0.1, "other.xml": 0.4}.items():
        urdf_of_text(path, CHILD.format(size), name)
    return path


@cache
def outcome(folder, text, base):
    """What is loaded of a file, and what is listed as ignored; or the sentence that refuses it."""
    try:
        urdf = mjcf_urdf(urdf_of_text(folder, text, "model.xml"), base)
    except ModelError as error:
        return str(error)
    loaded = re.sub('<ignored name="[^"]*" />', "", urdf)
    return loaded, set(urdf_file(urdf).ignored)


def effect(folder, text, without, name):
    """Whether what `text` says more, an attribute or element of a name, has which effect."""
    base = "floating" if "freejoint" in text else "fixed"
    found = outcome(folder, text, base)
    plain = outcome(folder, without, base)
    if isinstance(found, str):
        return REFUSED if found != plain else "unnoticed"
    if isinstance(plain, str) or found[0] != plain[0]:
        return USED
    named = any(f".{entry}".endswith(f".{name}") for entry in found[1])
    return LISTED if named or found[1] != plain[1] else "unnoticed"
