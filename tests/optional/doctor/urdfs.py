"""Texts of URDFs: a ball, a block, and a body on slides."""

AXES = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1", "s": "1 0 0"}


def inertial(m, moments, at=(0, 0, 0)):
    x, y, z = moments
    return (
        f'<inertial><origin xyz="{at[0]} {at[1]} {at[2]}"/><mass value="{m}"/>'
        f'<inertia ixx="{x}" iyy="{y}" izz="{z}" ixy="0" ixz="0" iyz="0"/></inertial>'
    )


def collision(shape, at=(0, 0, 0), name="shape"):
    return (
        f'<collision name="{name}"><origin xyz="{at[0]} {at[1]} {at[2]}"/>'
        f"<geometry>{shape}</geometry></collision>"
    )


def body(*parts):
    """One link."""
    return f'<robot name="r"><link name="link">{"".join(parts)}</link></robot>'


def ball(m, radius):
    moment = 0.4 * m * radius**2
    return body(inertial(m, [moment] * 3), collision(f'<sphere radius="{radius}"/>'))


def block(m, size):
    moments = [m / 12 * (sum(x**2 for x in size) - one**2) for one in size]
    shape = f'<box size="{size[0]} {size[1]} {size[2]}"/>'
    return body(inertial(m, moments), collision(shape))


def slides(axes, shape, down=False):
    """A link `tip` on slides along some axes, in their order; `down` turns z round."""
    links = '<link name="post"/>'
    parent = "post"
    for i, axis in enumerate(axes):
        last = i == len(axes) - 1
        child = "tip" if last else f"l{i}"
        way = "0 0 -1" if down and axis == "z" else AXES[axis]
        links += f'<link name="{child}">{collision(shape) if last else ""}</link>'
        links += (
            f'<joint name="{axis}" type="prismatic"><parent link="{parent}"/>'
            f'<child link="{child}"/><axis xyz="{way}"/>'
            '<limit lower="-1" upper="1" effort="1000" velocity="1"/></joint>'
        )
        parent = child
    return f'<robot name="r">{links}</robot>'
