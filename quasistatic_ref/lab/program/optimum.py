"""Layer 5: min 1/2 x'Hx - g'x subject to A x >= b, or to second-order cones.

With H = LL' and u = L'x - L^-1 g this is the point u of least length with M u >= d, and that is
one non-negative least-squares problem (Lawson & Hanson, Solving Least Squares Problems, ch. 23).
Its passive set then gives the answer once more, from the equations of the active rows alone.
"""

import numpy as np

ACTIVE = 1e-14
"""A gradient below this, in a problem scaled to one, is rounding."""
NOTHING = 1e-7
"""A residual below this counts as zero: the rows contradict each other. Else it is 1 / |u|."""


def least_squares(E, f, limit=1e-15):
    """The y of least |E y - f|, by Householder's method with column pivoting.

    Columns that depend on others get 0.
    """
    R = E.copy()
    r = f.copy()
    order = np.arange(E.shape[1])
    rank = 0
    for k in range(min(E.shape)):
        size = np.linalg.norm(R[k:, k:], axis=0)
        best = k + int(np.argmax(size))
        if size.max() <= limit * abs(R[0, 0]) * (k > 0):
            break
        R[:, [k, best]] = R[:, [best, k]]
        order[[k, best]] = order[[best, k]]
        v = R[k:, k].copy()
        v[0] += np.copysign(np.linalg.norm(v), v[0])
        v *= np.sqrt(2 / (v @ v))
        R[k:] -= np.outer(v, v @ R[k:])
        r[k:] -= v * (v @ r[k:])
        rank = k + 1
    y = np.zeros(E.shape[1])
    y[order[:rank]] = np.linalg.solve(np.triu(R[:rank, :rank]), r[:rank])
    return y


def nonnegative_least_squares(E, f):
    """The y >= 0 of least |E y - f|, and its passive set."""
    y = np.zeros(E.shape[1])
    passive = []
    limit = 20 * E.shape[1] + 100
    for _ in range(limit):
        gradient = E.T @ (f - E @ y)
        gradient[passive] = -np.inf
        entering = int(np.argmax(gradient)) if len(gradient) else 0
        if not len(gradient) or gradient[entering] <= ACTIVE:
            break
        passive.append(entering)
        while True:
            z = least_squares(E[:, passive], f)
            if passive[-1] == entering and z[-1] <= 0:  # it was rounding after all
                passive.pop()
                return y, passive
            if np.all(z > 0):
                break
            old = y[passive]
            falling = np.flatnonzero(z <= 0)
            way = old[falling] - z[falling]  # none where both are 0
            ratio = np.divide(old[falling], way, out=np.zeros(len(falling)), where=way > 0)
            t = ratio.min()
            y[passive] = old + t * (z - old)
            gone = [passive[falling[i]] for i in np.flatnonzero(ratio <= t)]
            y[gone] = 0.0
            passive = [i for i in passive if i not in gone]
        y[passive] = z
    return y, passive


def equality_answer(H, g, A, b):
    """(x, lam) of min 1/2 x'Hx - g'x s.t. Ax = b with independent rows, refined twice."""
    L = np.linalg.cholesky(H)
    Q, R = np.linalg.qr(np.linalg.solve(L, A.T))

    def kkt_solution(r, s):
        u = np.linalg.solve(L, r)
        v = np.linalg.solve(R.T, s - A @ np.linalg.solve(L.T, u)) if len(s) else np.zeros(0)
        return np.linalg.solve(L.T, u + Q @ v), np.linalg.solve(R, v) if len(s) else v

    x, lam = kkt_solution(g, b)
    for _ in range(2):
        dx, dlam = kkt_solution(g + A.T @ lam - H @ x, b - A @ x)
        x = x + dx
        lam = lam + dlam
    return x, lam


def optimum(H, g, A, b):
    """(x, lam) of min 1/2 x'Hx - g'x s.t. Ax >= b; without solution (None, Farkas vector)."""
    m = len(b)
    L = np.linalg.cholesky(H)
    if not m:
        return equality_answer(H, g, A, b)
    M = np.linalg.solve(L, A.T).T
    d = b - A @ np.linalg.solve(L.T, np.linalg.solve(L, g))
    size = np.linalg.norm(M, axis=1)
    size[size == 0] = 1.0
    scale = np.max(d / size, initial=0.0) or 1.0
    E = np.vstack([(M / size[:, None]).T, d / size / scale])
    f = np.zeros(len(E))
    f[-1] = 1.0
    y, passive = nonnegative_least_squares(E, f)
    # More rows than unknowns bear load only where nothing satisfies them.
    if np.linalg.norm(E @ y - f) < NOTHING or len(passive) > len(g):
        return None, y / size / np.max(y / size)
    x, part = equality_answer(H, g, A[passive], b[passive])
    lam = np.zeros(m)
    lam[passive] = np.maximum(part, 0.0)
    return x, lam


def solution(A, b, x, lam):
    """Output of layer 5: delta_q, lam, A_lam and slack."""
    return {"delta_q": x, "lam": lam, "A_lam": A.T @ lam, "slack": A @ x - b}


def qp_answer(H, g, A, b, method=optimum):
    """Output of layer 5 for linear rows: the optimum, or the Farkas vector."""
    x, lam = method(H, g, A, b)
    if x is None:
        return {"farkas": lam}
    return solution(A, b, x, lam)


def conic_answer(H, g, blocks):
    """The output of a case with cones: tangent planes until they hold, then Newton's method."""
    n = len(g)
    F = np.array([F for F, _ in blocks]).reshape(-1, 4, len(g))
    f = np.array([f for _, f in blocks]).reshape(-1, 4)
    start = np.array([[1, s * a, s * b, s * c] for s in (1, -1) for a, b, c in np.eye(3)])
    cuts = [(j, w) for j in range(len(f)) for w in start]
    for _ in range(60):
        A = np.array([w @ F[j] for j, w in cuts]).reshape(-1, n)
        x, lam = optimum(H, g, A, np.array([-w @ f[j] for j, w in cuts]))
        z = F @ x + f
        r = np.linalg.norm(z[:, 1:], axis=1)
        outside = np.flatnonzero(r - z[:, 0] > 1e-9 * (np.abs(z).max(initial=0) + 1e-300))
        if not len(outside):
            break
        kept = [cut for cut, value in zip(cuts, lam, strict=True) if value > 0]
        cuts = kept + [(j, w) for j in range(len(f)) for w in start]
        cuts += [(j, np.append(1, -z[j, 1:] / r[j])) for j in outside]
    impulse = np.zeros((len(f), 4))
    for (j, w), value in zip(cuts, lam, strict=True):
        impulse[j] += value * w
    x, impulse = newton(H, g, F, f, x, impulse)
    return solution(F.reshape(-1, n), -f.ravel(), x, impulse.ravel())


def newton(H, g, F, f, x, impulse):
    """KKT equations of the cones that bear load, at their tip (z = 0) or on their side."""
    bears = impulse[:, 0] > 1e-9 * impulse[:, 0].max(initial=0.0)
    inner = impulse[:, 0] - np.linalg.norm(impulse[:, 1:], axis=1)
    # A cone that does not move is at its tip, whatever cuts bear its load; it may be, if it
    # hardly does.
    moves = np.abs(F @ np.linalg.solve(H, g) + f).max(initial=0.0)
    near = np.where(inner > 1e-6 * impulse[:, 0], 1e-6, 1e-9) * moves
    at_tip = np.abs(F @ x + f).max(axis=1, initial=0.0) <= near
    tips = np.flatnonzero(bears & at_tip)
    sides = np.flatnonzero(bears & ~at_tip)
    mu = impulse[sides, 0].copy()
    for _ in range(12):
        z = F @ x + f
        W = H.copy()
        C = [np.zeros((0, len(g)))]
        for j, value in zip(sides, mu, strict=True):
            r = np.linalg.norm(z[j, 1:])
            e = z[j, 1:] / r
            T = F[j, 1:]
            W += value / r * T.T @ (np.eye(3) - np.outer(e, e)) @ T
            C.append((F[j, 0] - e @ T)[None])
        C += [F[j] for j in tips]
        C = np.vstack(C)
        c = np.concatenate([z[sides, 0] - np.linalg.norm(z[sides, 1:], axis=1), z[tips].ravel()])
        K = np.block([[W, -C.T], [C, np.zeros((len(C), len(C)))]])
        answer = np.linalg.lstsq(K, np.concatenate([g - H @ x, -c]), rcond=1e-13)[0]
        x = x + answer[: len(g)]
        multipliers = answer[len(g) :]
        mu = multipliers[: len(sides)]
    new = np.zeros_like(impulse)
    z = F @ x + f
    for j, value in zip(sides, mu, strict=True):
        new[j] = value * np.append(1, -z[j, 1:] / np.linalg.norm(z[j, 1:]))
    new[tips] = multipliers[len(sides) :].reshape(-1, 4)
    return x, new


def qp(case):
    """Layer 5: the output of a case, a quadratic program with rows or cones."""
    H = np.array(case["H"])
    g = np.array(case["g"])
    if "second_order" in case:
        blocks = [(np.array(c["F"]), np.array(c["f"])) for c in case["second_order"]]
        return conic_answer(H, g, blocks)
    return qp_answer(H, g, np.array(case["A"]).reshape(-1, len(g)), np.array(case["b"]))
