"""Small URDF texts, and the models of URDFs."""

from quasistatic_ref.files.urdf.file import urdf_tree
from quasistatic_ref.model.tree_model import tree_model


def loaded_urdf(source, base="fixed", actuated=(), package_dirs=()):
    """The model of a URDF."""
    return tree_model(urdf_tree(source, package_dirs), base, actuated)


INERTIAL = (
    '<inertial><origin xyz="0.1 -0.2 0.05" rpy="0.3 0.1 -0.4"/><mass value="2"/>'
    '<inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0.001" ixz="0.002" iyz="-0.003"/></inertial>'
)


def link(name, collisions="", inertial=INERTIAL):
    return f'<link name="{name}">{inertial}{collisions}</link>'


def inertial(mass="2", moments=("0.02", "0.03", "0.04"), origin=""):
    ixx, iyy, izz = moments
    return (
        f'<inertial>{origin}<mass value="{mass}"/><inertia ixx="{ixx}" iyy="{iyy}" izz="{izz}" '
        'ixy="0" ixz="0" iyz="0"/></inertial>'
    )


def collision(shape, origin=""):
    return f"<collision>{origin}<geometry>{shape}</geometry></collision>"


def joint(name, parent, child, kind="revolute", axis="0 0 1", more=""):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<axis xyz="{axis}"/><limit lower="-1" upper="1" effort="1" velocity="1"/>{more}</joint>'
    )


def mimic(of, multiplier=1.0, offset=0.0):
    return f'<mimic joint="{of}" multiplier="{multiplier}" offset="{offset}"/>'


def robot(*elements):
    return f'<robot name="r" version="1.1">{"".join(elements)}</robot>'


def urdf_of_text(folder, text, name="r.urdf"):
    path = folder / name
    path.write_bytes(text.encode())
    return path


CHAIN = robot(
    link("base_link", collision('<box size="0.1 0.2 0.3"/>')),
    link("upper", collision('<sphere radius="0.1"/>', '<origin xyz="0 0.1 0.2" rpy="0.2 0 0"/>')),
    link("lower"),
    link("slider"),
    link("follower"),
    link("tool", collision('<capsule radius="0.02" length="0.1"/>'), inertial=""),
    joint("swing", "base_link", "upper", axis="1 2 -1", more='<origin xyz="0.1 0.2 0.3"/>'),
    joint("spin", "upper", "lower", "continuous", "0 1 0", '<origin rpy="0.3 -0.2 0.5"/>'),
    joint("slide", "lower", "slider", "prismatic", "0.6 0 0.8", '<origin xyz="0 0 0.4"/>'),
    joint(
        "swing_mimic", "slider", "follower", "revolute", "0 1 1",
        '<origin xyz="-0.1 0 0.2" rpy="0 0.4 0"/>' + mimic("swing", -0.7, 0.2),
    ),
    joint("weld", "follower", "tool", "fixed", more='<origin xyz="0.1 0 0" rpy="0 0 1"/>'),
)  # fmt: skip
"""One of each: revolute, continuous, prismatic, mimic, fixed."""

BOX = robot(
    '<link name="box"><inertial><origin xyz="0.01 -0.02 0.03"/><mass value="1.5"/>'
    '<inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0.001" ixz="0" iyz="0"/></inertial>'
    '<collision><geometry><box size="0.2 0.4 0.6"/></geometry></collision></link>'
)
"""One link whose centre of mass is not its origin."""

OBJ = "v 0 0 0\nv {} 0 0\nv 0 0.2 0\nv 0 0 0.3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
"""A tetrahedron as a file, as long as is given along x."""
