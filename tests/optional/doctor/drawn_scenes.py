"""Scenes drawn by a seed, healthy and broken, with what is right of them by hand.

Masses, sizes, friction, springs, h and the number of bystanders are drawn. Of a healthy scene no
finding is right. Of a broken one the finding's name is known, and its numbers where they have a
closed form. All of them are derived here from the laws of statics, not from what a run says.
"""

import numpy as np

from quasistatic_ref import Sphere
from tests.files.urdf.urdf_texts import collision, inertial
from tests.optional.doctor.words import (
    TIP,
    block,
    driven,
    free,
    joint,
    link,
    placed,
    robot,
    scene,
    slides,
    solid,
)


G = 9.81
TIP_RADIUS = 0.01
STIFF = 1e6
"""Of springs across the direction in which a finger presses [N/m]: they give way by micrometres."""
SLAB = "<box size='1 1 0.02'/>"
H = (0.005, 0.01, 0.02)


class Draw:
    """Random numbers of a scene, and of its body what every scene has."""

    def __init__(self, seed):
        self.rng = np.random.default_rng(seed)
        self.edge = self.between(0.04, 0.15)
        self.m = self.edge**3 * self.between(100.0, 3000.0)
        self.mu = self.rng.uniform(0.3, 0.9)
        self.h = float(self.rng.choice(H))

    def between(self, low, high):
        """A number whose logarithm is uniform."""
        return float(np.exp(self.rng.uniform(np.log(low), np.log(high))))

    def cube(self, *xyz):
        """A free cube."""
        return free(block(self.m, (self.edge,) * 3), xyz)

    def standing(self):
        """One that stands on z = 0."""
        return self.cube(0, 0, self.edge / 2)

    def scene(self, bodies, contacts, steps, hand=None, also=(), **more):
        """A scenario with up to two more cubes on the floor, and what is right of it.

        These are the numbers of each finding that is right by hand, and findings that are right,
        too, without a closed form.
        """
        for i in range(self.rng.integers(3)):
            mass = self.between(0.02, 20.0)
            bodies[f"other{i}"] = free(block(mass, (0.1,) * 3), (1, 0.2 * i, 0.05))
            contacts[f"other{i}"] = ("floor", f"other{i}", 0.5, 4)
        run = scene(bodies, contacts, steps, fast=True, **({"h": self.h} | more))
        return run, hand or {}, {*also}


def finger(at, K, targets):
    """A ball on springs K [N/m], very stiff along the axes that K does not name."""
    return driven(slides("xyz", TIP), at, dict.fromkeys("xyz", STIFF) | K, targets)


def plate(K, v=(0, 0), z=0.0, at=-0.01):
    """A slab, its upper side at 0, that goes with v along x and z; its spring along z is K."""
    targets = [{"t": t, "x": v[0] * t, "z": z + v[1] * t} for t in (0.0, 10.0)]
    return driven(slides("xz", SLAB), (0, 0, at), {"x": STIFF, "z": K}, targets)


def gripped(d, N, edge, *way, axis="x", K=None):
    """Fingers on both sides of a body at the origin, whose springs press with N; of a way (t, z, p)
    with p N. If p < 0 they open."""
    deep = N / K if K else d.between(5e-4, 5e-3)
    bodies = {}
    for name, side in (("left", -1), ("right", 1)):
        at = side * (edge / 2 + TIP_RADIUS)
        bodies[f"{name}_{axis}"] = finger(
            (at, 0, 0) if axis == "x" else (0, at, 0),
            {axis: N / deep},
            [{"t": t, axis: -side * p * deep, "z": z} for t, z, p in ((0.0, 0.0, 1.0), *way)],
        )
    return bodies


BOTH = ["left_x/tip", "right_x/tip"]


def wiper(d, rises, *found):
    """A finger that presses with K e and wipes, so that mu v h is `rises` times e."""
    K = d.between(1e3, 1e5)
    e = d.between(1e-4, 1e-3)
    v = rises * e / (d.mu * d.h)
    way = [{"t": t, "x": v * t, "z": -e} for t in (0.0, 10.0)]
    bodies = {"wiper": finger((0, 0, TIP_RADIUS), {"z": K}, way)}
    numbers = {"run_N": K * e * (1 + rises), "slowly_N": K * e}
    contacts = {"c": ("floor", "wiper/tip", d.mu, 1)}
    return d.scene(bodies, contacts, 20, dict.fromkeys(found, numbers))


# ---- healthy


def on_a_spring(d):
    """It sags by m g / K, less than a hundredth of its size, beside the floor, and lies still."""
    sag = min(d.between(1e-5, 2e-3), 0.009 * d.edge)
    bodies = {"palm": plate(d.m * G / sag), "b": d.standing()}
    return d.scene(bodies, {"c": ("palm/tip", "b", d.mu, 4)}, 30)


def carried(d):
    """The drag m v / h that friction bears is at most 2 % of m g."""
    v = d.between(1e-3, 0.02) * G * d.h
    bodies = {"tray": plate(STIFF, (v, 0)), "b": d.standing()}
    return d.scene(bodies, {"c": ("tray/tip", "b", d.mu, 4)}, 20)


def lifted(d):
    """2 mu N is 1.15 to 3 times m g; the drag is at most 2 % of it."""
    N = d.between(1.15, 3.0) * d.m * G / (2 * d.mu)
    v = d.between(1e-3, 0.02) * G * d.h
    bodies = gripped(d, N, d.edge, (10.0, 10 * v, 1.0)) | {"b": d.cube(0, 0, 0)}
    return d.scene(bodies, {"c": (BOTH, "b", d.mu, 1, 0.01)}, 20)


def regrasped(d):
    """Two pairs of fingers, of which each bears the weight alone; one lets go in one step."""
    N = d.between(1.15, 2.0) * d.m * G / (2 * d.mu)
    opens = gripped(d, N, d.edge, (9.5 * d.h, 0.0, 1.0), (10 * d.h, 0.0, -0.4))
    bodies = opens | gripped(d, N, d.edge, axis="y") | {"b": d.cube(0, 0, 0)}
    four = [*BOTH, "left_y/tip", "right_y/tip"]
    return d.scene(bodies, {"c": (four, "b", d.mu, 1, 0.01)}, 20)


def rolled(d):
    """A plate that presses with N and goes by v rolls a ball by v / 2; m v / (2 h) is little."""
    N = d.between(0.5, 3.0) * d.m * G
    K = d.between(1e3, 1e5)
    v = d.between(1e-3, 0.01) * G * d.h
    top = plate(K, (v, 0), -N / K, d.edge + 0.01)
    bodies = {"plate": top, "b": free(solid(d.m, Sphere(d.edge / 2)), (0, 0, d.edge / 2))}
    contacts = {"floor": ("floor", "b", d.mu, 1), "top": ("plate/tip", "b", d.mu, 1)}
    return d.scene(bodies, contacts, 20)


def wiped(d):
    """The layer raises N = K e by K mu v h, (R13), at most 3 % of it."""
    return wiper(d, d.between(1e-3, 0.03))


def set_down_tilted(d):
    """It rocks down by less than 0.05 rad and a twentieth of its size, and lies still."""
    t = d.rng.uniform(0.005, 0.04)
    b = d.cube(0, 0, d.edge / 2 * (np.cos(t) + np.sin(t)))
    b["pose"]["rpy"] = [0, t, 0]
    return d.scene({"b": b}, {"c": ("floor", "b", d.mu, 4)}, 40)


def slope(d, tan):
    """A flat block on a slope along x, and the slope's shape."""
    a = np.arctan(tan)
    n = np.array([-np.sin(a), 0.0, np.cos(a)])
    b = free(block(d.m, (d.edge, d.edge, d.edge / 4)), d.edge / 8 * n)
    b["pose"]["rpy"] = [0, -a, 0]
    return a, {"b": b}, {"slope": {"halfspace": {"normal": n.tolist(), "offset": 0}}}


def on_a_slope(d):
    """In the pyramid friction bears mu N along its axes, and mu N / sqrt(2) between them."""
    _, bodies, shapes = slope(d, d.rng.uniform(0.1, 0.65) * d.mu)
    return d.scene(bodies, {"c": ("slope", "b", d.mu, 4)}, 10, shapes=shapes)


def pile(d, out):
    """Two to four cubes, of which each upper one is `out` half edges beyond the one below it."""
    count = int(d.rng.integers(2, 5)) if out is None else 2
    names = [f"b{i}" for i in range(count)]
    x = 0.0
    bodies, contacts = {}, {"c0": ("floor", "b0", 0.9, 4)}
    for i, name in enumerate(names):
        bodies[name] = d.cube(x, 0, d.edge * (i + 0.5))
        x += d.edge / 2 * (d.rng.uniform(-1, 1) / count if out is None else out)
        if i:
            contacts[f"c{i}"] = (names[i - 1], name, 0.9, 8)
    return bodies, contacts


def stacked(d):
    """n equal cubes, each at most 1/n of its half edge beyond the lower one: of those above cube i
    the centre of mass is at most (n - i) / 2 such ways beyond it, so it is inside its face."""
    return d.scene(*pile(d, None), 8)


def bar(d, times):
    """A bar that two fingers hold off its centre with `times` the force that bears it.

    Each bears W / 2 and W off / 2 if |f| / mu + |t| / mu_omega <= N, or, in the ellipsoid, if the
    root of the sum of their squares is. Without `times`, N is between this root and W / (2 mu),
    which bears the weight without its lever arm.
    """
    m, mu, w = d.between(0.05, 0.8), d.mu, d.between(0.004, 0.018)
    length = d.between(0.1, 0.3)
    off = d.rng.uniform(0.1, 0.35) * length
    c = off + w / mu
    N = m * G * c / (2 * w)  # W (1 / mu + off / w) / 2
    least = m * G / (2 * mu)
    root = least * np.hypot(1.0, mu * off / w)
    N = times * N if times else least + d.rng.uniform(0.0, 0.9) * (root - least)
    size = (0.02, length, 0.02)
    bodies = gripped(d, N, 0.02) | {"b": free(block(m, size), (0, off, 0))}
    inertia = m / 12 * (size[1] ** 2 + size[2] ** 2)
    return (m, c, w, N, inertia), bodies, {"c": (BOTH, "b", mu, 1, w)}


def held_off_its_centre(d):
    """By a margin of 1.15 to 2."""
    _, *parts = bar(d, d.rng.uniform(1.15, 2.0))
    return d.scene(*parts, 8)


# ---- broken


def lacks(force, torque=0.0):
    """What is missing [N, N m]."""
    return {"equilibrium": {"missing_N": force, "missing_Nm": torque}}


def pressed_on_a_wall(d):
    """Wall and finger press with N, and friction bears 2 mu N of m g."""
    N = d.rng.uniform(0.1, 0.9) * d.m * G / (2 * d.mu)
    K = d.between(1e4, 1e6)
    at = (d.edge + TIP_RADIUS, 0, 0)
    tip = finger(at, {"x": K}, [{"t": 0.0, "x": -N / K}])
    wall = {"wall": {"halfspace": {"normal": [1, 0, 0], "offset": 0}}}
    bodies = {"b": d.cube(d.edge / 2, 0, 0), "f": tip}
    contacts = {"wall": ("wall", "b", d.mu, 4), "f": ("f/tip", "b", d.mu, 1)}
    hand = lacks(d.m * G - 2 * d.mu * N)
    also = ["uncertain-forces"]  # of its four corners on the wall
    return d.scene(bodies, contacts, 3, hand, also, shapes=wall)


def weak_grip(d):
    """Two fingers press with N, and friction bears 2 mu N of m g; it slips by less than 2 mm."""
    N = d.rng.uniform(0.1, 0.9) * d.m * G / (2 * d.mu)
    bodies = gripped(d, N, d.edge) | {"b": d.cube(0, 0, 0)}
    hand = lacks(d.m * G - 2 * d.mu * N)
    d.h = min(d.h, 0.01)
    return d.scene(bodies, {"c": (BOTH, "b", d.mu, 1, 0.01)}, 2, hand)


def turns_in_its_grip(d):
    """N bears m g, but not its lever arm. Slip and spin go along a face of the pyramid, so that
    the fingers' place goes down with the acceleration al mu_omega / mu, and the centre with al c,
    c = off + mu_omega / mu. With f and t = mu_omega (N - f / mu) of each finger

        m al c = m g - 2 f,    I al = 2 f off - 2 t = 2 f c - 2 mu_omega N.

    f is between 0 and m g / 2 <= mu N, since al c < g.
    """
    (m, c, w, N, inertia), *parts = bar(d, None)
    al = (m * G * c - 2 * w * N) / (inertia + m * c**2)
    hand = lacks(m * c * al, inertia * al)
    return d.scene(*parts, 1, hand, ["corners"])


def steep(d):
    """m g (sin a - mu cos a); a flat block does not topple."""
    a, bodies, shapes = slope(d, d.rng.uniform(1.1, 2.0) * d.mu)
    hand = lacks(d.m * G * (np.sin(a) - d.mu * np.cos(a)))
    return d.scene(bodies, {"c": ("slope", "b", d.mu, 4)}, 3, hand, shapes=shapes)


def rolls(d):
    """A ball on a slope rolls: m g sin a = (1 + 2/5) m al r, while mu is over 2/7 tan a."""
    a, bodies, shapes = slope(d, d.rng.uniform(0.1, 0.9) * d.mu)
    r = d.edge / 2
    bodies["b"] = free(solid(d.m, Sphere(r)), (-r * np.sin(a), 0, r * np.cos(a)))
    force = 5 / 7 * d.m * G * np.sin(a)
    hand = lacks(force, 0.4 * force * r)
    return d.scene(bodies, {"c": ("slope", "b", d.mu, 1)}, 2, hand, shapes=shapes)


def guided(d):
    """A plate on a hinge at its end lacks m g l / 2, on an upright rail m g, less what the joint's
    friction bears; the floor is far below."""
    size = (d.edge, d.edge, d.edge / 8)
    at = f'<origin xyz="{d.edge / 2} 0 0" rpy="0 0 0"/>'
    shape = collision('<box size="{} {} {}"/>'.format(*size), at)
    moments = (d.m / 12 * d.edge**2,) * 3
    hinge = d.rng.random() < 0.5
    of_joint = ("0 1 0", "revolute") if hinge else ("0 0 1", "prismatic")
    urdf = robot(
        link("post", inertial=""),
        link("bar", shape, inertial(d.m, moments, at)),
        joint("j", "post", "bar", *of_joint),
    )
    load = d.m * G * (d.edge / 2 if hinge else 1.0)
    bears = d.rng.uniform(0.0, 0.9) * load
    body = placed(urdf, (0, 0, 0.5)) | {"joint_friction": {"j": bears}}
    hand = lacks(0.0, load - bears) if hinge else lacks(load - bears)
    return d.scene({"b": body}, {"c": ("floor", "b/bar", d.mu, 1)}, 2, hand)


def overhang(d):
    """The upper of two cubes of edge 2 b turns about the lower one's edge, e beyond which its
    centre is: al = m g e / (I + m (b^2 + e^2)), I = 2/3 m b^2. The edge sticks: friction over
    normal force is 3 e / (5 b) < 0.6. A step turns it by al h^2, and then e is larger."""
    m, b = d.m, d.edge / 2
    e = d.rng.uniform(0.1, 0.9) * b
    inertia = 2 / 3 * m * b**2
    about = inertia + m * (b**2 + e**2)
    turn = m * G * e / about * d.h**2
    al = m * G * (e * np.cos(turn) + b * np.sin(turn)) / about
    return d.scene(*pile(d, 1 + e / b), 1, lacks(m * al * np.hypot(b, e), inertia * al))


def dragged_up(d):
    """A tray that goes up bears m g + m v / h."""
    v = d.between(0.3, 5.0) * G * d.h
    bodies = {"tray": plate(STIFF, (0, v)), "b": d.standing()}
    numbers = {"run_N": d.m * (G + v / d.h), "slowly_N": d.m * G}
    return d.scene(bodies, {"c": ("tray/tip", "b", d.mu, 4)}, 20, {"artifact": numbers})


def layer(d):
    """The layer raises K e by K mu v h, (R13)."""
    return wiper(d, d.between(0.2, 3.0), "artifact")


def between_the_axes(d):
    """Friction of the pyramid, |f1| + |f2| <= mu m g, leaves of a push along (x, y) the most
    even rest: x - mu m g and y if the first is the larger one, else their mean along both. A round
    cone leaves the push's length less mu m g. A flat block does not topple."""
    bears = d.mu * d.m * G
    angle = d.rng.uniform(0.3, np.pi / 4)
    push = d.rng.uniform(1.1, 2.0) * bears * np.array([np.cos(angle), np.sin(angle)])
    rest = push - [bears, 0.0]
    if rest[0] < rest[1]:
        rest[:] = rest.mean()
    size = (d.edge, d.edge, d.edge / 8)
    flat = free(block(d.m, size), (0, 0, d.edge / 16), (*push.tolist(), 0.0))
    hand = lacks(float(np.hypot(*rest)))
    hand["corners"] = {"ellipsoid_N": float(np.hypot(*push)) - bears}
    return d.scene({"b": flat}, {"c": ("floor", "b", d.mu, 4)}, 3, hand)


HEALTHY = (
    on_a_spring,
    carried,
    lifted,
    regrasped,
    rolled,
    wiped,
    set_down_tilted,
    on_a_slope,
    stacked,
    held_off_its_centre,
)
BROKEN = (
    pressed_on_a_wall,
    weak_grip,
    turns_in_its_grip,
    steep,
    guided,
    guided,
    overhang,
    dragged_up,
    layer,
    between_the_axes,
)
SEEDS = 5
"""Of each kind."""
