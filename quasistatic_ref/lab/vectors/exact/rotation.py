"""Rotations and the exponentials of twists, without rounding before the last step.

The rotation of a quaternion q of any length but zero is that of q / |q|; its matrix is rational
in q, so that poses of float64 numbers are exact.
"""

from flint import fmpq

from quasistatic_ref.lab.vectors.exact.algebra import (
    IDENTITY,
    Matrix,
    Vector,
    add,
    along,
    cross,
    dot,
    scaled,
    squared,
)
from quasistatic_ref.lab.vectors.exact.precision import Real, ball, least, root, sign


def rotation(quaternion: Vector) -> Matrix:
    """Matrix of a quaternion [x y z w] of any length."""
    x, y, z, w = quaternion
    two = 2 / squared(quaternion)
    return [
        [1 - two * (y * y + z * z), two * (x * y - z * w), two * (x * z + y * w)],
        [two * (x * y + z * w), 1 - two * (x * x + z * z), two * (y * z - x * w)],
        [two * (x * z - y * w), two * (y * z + x * w), 1 - two * (x * x + y * y)],
    ]


def quaternion_product(a: Vector, b: Vector) -> Vector:
    """Hamilton product of two quaternions [x y z w]: first b, then a."""
    vector = add(cross(a[:3], b[:3]), add(scaled(b[:3], a[3]), scaled(a[:3], b[3])))
    return [*vector, a[3] * b[3] - dot(a[:3], b[:3])]


def axis_rotation(axis: Vector, cosine: Real, sine: Real) -> Matrix:
    """Rotation about a unit vector by an angle: c I + s [axis]x + (1 - c) axis axis'."""
    columns = [
        along(along(scaled(axis, (1 - cosine) * axis[k]), e, cosine), cross(axis, e), sine)
        for k, e in enumerate(IDENTITY)
    ]
    return [list(row) for row in zip(*columns, strict=True)]


def cos_sin(angle: Real) -> tuple[Real, Real]:
    """Cosine and sine of an angle; of zero, exactly."""
    if angle == 0:
        return fmpq(1), fmpq(0)
    sine, cosine = ball(angle).sin_cos()
    return cosine, sine


def exp6(linear: Vector, angular: Vector) -> tuple[Vector, Vector]:
    """Translation and unit quaternion [x y z w] of the screw motion of a twist.

    t = v + (1 - cos a) / a^2 w x v + (1 - sin a / a) / a^2 w x (w x v), with a = |w|.
    """
    square = squared(angular)
    if sign(square) == 0:
        return linear, [fmpq(0), fmpq(0), fmpq(0), fmpq(1)]
    angle = root(square)
    half = ball(angle / 2)
    sinc = half.sinc()
    once = cross(angular, linear)
    # The double product is divided first: the quotient is rational, and a difference like
    # 1 - sinc, which cancels for a small angle, is never divided by a small number.
    twice = scaled(cross(angular, once), 1 / square)
    t = along(along(linear, once, sinc * sinc / 2), twice, 1 - ball(angle).sinc())
    return t, [*scaled(angular, sinc / 2), half.cos()]


def exp3(linear: Vector, angle: Real) -> tuple[Vector, Vector]:
    """The same in the plane: translation (2,), and cosine and sine of the angle."""
    if angle == 0:
        return linear, [fmpq(1), fmpq(0)]
    forward, sideways = ball(angle).sinc(), angle * ball(angle / 2).sinc() ** 2 / 2
    x, y = linear
    return [forward * x - sideways * y, sideways * x + forward * y], list(cos_sin(angle))


def quaternion_of(R: Matrix) -> Vector:
    """Unit quaternion [x y z w] of a rotation, its largest entry positive, the first of equals."""
    (a, b, c), (d, e, f), (g, h, i) = R
    # Four times the square of each entry, and its products with the others.
    table = [
        [1 + a - e - i, b + d, c + g, h - f],
        [b + d, 1 - a + e - i, f + h, c - g],
        [c + g, f + h, 1 - a - e + i, d - b],
        [h - f, c - g, d - b, 1 + a + e + i],
    ]
    row = table[least([-table[k][k] for k in range(4)])]
    length = root(squared(row))
    return [x / length for x in row]
