"""Which of Eqs. (9)-(12) holds for a step and its solution, decided without any rounding.

Run ``python check_solution.py STEP.json SOLUTION.json``. This one file needs Python alone, and
shares no code with the package whose answers it judges. Exit status: 0 if everything holds, 1 if
something fails, 2 if a file cannot be read, or cannot be judged here.

``python check_solution.py ANSWER.json`` judges a file of ``exact_qp``, which holds its program:
minimise 1/2 x'Px + q'x subject to G x <= h, A x = b and lb <= x <= ub, with at most 100 unknowns.
It claims an optimum, or proves that there is none: rows contradict each other, or the cost falls
without end along a direction, or P is not convex.

``python check_solution.py PROGRAM.qps optima.jsonl`` judges a line of a table of public programs,
and the answer that stands beside the table, SET/NAME.json: fractions x and multipliers are put into
the decimals of the file. Nothing is solved. Not judged are whether x or multipliers are the only
ones, and programs where more than 100 unknowns are coupled by P.

All numbers of the other files are float64, hence fractions, and fractions they stay. A step is the
problem  min 1/2 x'Hx - g'x  subject to  A x >= b,  where x is delta_q. A solution names rows W, its
``active``. Eq. (9) and A_W x = b_W are one linear system, which determines x and lam. The file is
right if these satisfy Eqs. (10)-(12), and if its numbers are theirs, rounded once, and zero is 0.0.
Not judged are multipliers_unique and differentiable where a row touches that bears nothing, nor
that an answer without a direction has no other optimum.
"""

import hashlib
import json
import sys
from fractions import Fraction
from math import lcm
from operator import add

SQUARE = ((1, 0), (0, 1), (-1, 0), (0, -1))
PI = 314159265358979323846264338327950288419716939937510582097494  # times 10^59
ONE = 2**256  # the unit of sums in fixed point
MOST = 100  # unknowns of a quadratic program that take seconds, not minutes


def need(condition, sentence):
    """Stop with a sentence where a file holds what cannot be judged here."""
    if not condition:
        raise ValueError(sentence)


def read(value, like, name):
    """A field: a table of {fields}, a list of [what], numbers of a (shape), a type or a choice."""
    if isinstance(like, dict):
        need(isinstance(value, dict), f"{name} is no table of fields")
        for key in [*like, *value]:
            need(key in like and key in value, f"{name}.{key} is missing, or unknown")
        return {key: read(value[key], kind, f"{name}.{key}") for key, kind in like.items()}
    if isinstance(like, list | tuple) and like:
        size, each = (None, *like) if isinstance(like, list) else (like[0], like[1:])
        right = isinstance(value, list) and size in (None, len(value))
        need(right, f"{name} is no list of the right length: {value!r}")
        return [read(entry, each, name) for entry in value]
    if like == ():
        finite = type(value) in (int, float) and abs(value) <= sys.float_info.max
        need(finite, f"{name} is no finite number: {value!r}")
        return float(value) + 0.0 if name.startswith("step") else float(value)  # -0.0 as 0.0
    one_of = [(type(v), v) for v in like] if isinstance(like, set) else [(like, value)]
    words = like if isinstance(like, set) else f"a {like.__name__}"
    need((type(value), value) in one_of, f"{name} must be {words}, and is {value!r}")
    return value


def once(pairs):
    """A table in JSON, none of whose fields is there twice."""
    need(len(dict(pairs)) == len(pairs), f"a field is there twice: {[key for key, _ in pairs]}")
    return dict(pairs)


def table(path):
    """The table in a JSON file; one longer than 64 MiB is cut there, and then no JSON."""
    with open(path, encoding="utf-8-sig") as file:
        value = json.loads(file.read(2**26), object_pairs_hook=once)
    need(isinstance(value, dict), f"{path} is no table of fields")
    return value


def symmetric(S, name):
    """A matrix that is symmetric but for rounding: the lower triangle counts."""
    n, most = range(len(S)), max((abs(v) for row in S for v in row), default=0.0)
    same = all(abs(S[i][j] - S[j][i]) <= 1e-12 * most for i in n for j in n)
    need(same, f"{name} is not symmetric")
    return [[S[max(i, j)][min(i, j)] for j in n] for i in n]


def step_read(record):
    """The step, with its fields in the order in which they are hashed."""
    record = {"cone": "pyramid", "extra": {"names": [], "A": [], "b": []}} | record
    n_a, n_u, extra = (record.get(name) for name in ("n_a", "n_u", "extra"))
    need(type(n_a) is type(n_u) is int, f"n_a or n_u is no whole number: {n_a!r}, {n_u!r}")
    n_v, m = n_a + n_u, len(read(read(extra, dict, "extra").get("names"), [str], "extra.names"))
    axes = dict.fromkeys(("n", "d1", "d2"), (3,))
    contact = {"name": str, "phi": (), **axes, "J": (4, n_v), "mu_v": (), "mu_omega": ()}
    like = {"format": {"quasistatic-ref/step"}, "version": {1}, "cone": str, "h": ()}
    like |= {"n_a": int, "n_u": int, "K_q": (n_a, n_a), "M_u": (n_u, n_u)}
    like |= {"tau_a": (n_a,), "tau_u": (n_u,), "delta_q_bar_a": (n_a,)}
    like |= {"contacts": [contact | {"rows": {4, 6}}]}
    like |= {"extra": {"names": [str], "A": (m, n_v), "b": (m,)}}
    cost = "H" in extra or "g" in extra  # 1/2 x'Hx - g'x; what is left out is zero
    if cost:
        like["extra"] |= {"H": (n_v, n_v), "g": (n_v,)}
        record["extra"] = {"H": [[0.0] * n_v] * n_v, "g": [0.0] * n_v} | extra
    step = read(record, like, "step")
    need(step["h"] > 0, "h is not positive")
    for name in ("K_q", "M_u"):
        step[name] = symmetric(step[name], name)
        need(definite(fractions(step[name])), f"{name} is not positive definite")
    if cost:
        H = step["extra"]["H"] = symmetric(step["extra"]["H"], "extra.H")
        need(all(row[i] >= 0 for i, row in enumerate(H)), "extra.H has a negative diagonal entry")
    elif not m:
        del step["extra"]
    for contact in step["contacts"]:
        need(min(contact["mu_v"], contact["mu_omega"]) >= 0, "mu_v or mu_omega is negative")
        d1, d2, n = frame = [fractions(contact[axis]) for axis in ("d1", "d2", "n")]
        off = max(abs(dot(u, v) - (u is v)) for u in frame for v in frame)
        volume = sum(n[i] * (d1[i - 2] * d2[i - 1] - d1[i - 1] * d2[i - 2]) for i in range(3))
        need(off <= 1e-9 and volume > 0, "d1, d2, n are no right-handed orthonormal frame")
    return step


def solution_read(record):
    """The solution, of kind exact, or a proof that there is none."""
    head = {"format": {"quasistatic-ref/solution"}, "version": {2}, "cone": str}
    head |= {"step_sha256": str, "status": {"optimal", "infeasible"}}
    if record.get("status") == "infeasible":
        return read(record, head | {"farkas": [str]}, "solution")
    claims = record.get("certificate", {})
    exact = isinstance(claims, dict) and claims.get("kind") == "exact"
    need(exact, "only certificates of kind exact are judged here")
    least = ("smallest_inactive_slack", "smallest_active_multiplier")
    kinds = {name: {None} if claims.get(name, 0) is None else () for name in least}
    kinds |= {"kind": str, "active": [[int]], "error_bound": ()}
    kinds |= {"multipliers_unique": bool, "differentiable": bool}
    numbers = {"delta_q": [()], "lam": [[()]], "lam_extra": [()], "wrench": [[()]]}
    return read(record, head | numbers | {"certificate": kinds}, "solution")


def minus_zero(value):
    """Whether a number is -0.0, or any in nested lists and tables."""
    value = list(value.values()) if isinstance(value, dict) else value
    return any(map(minus_zero, value)) if isinstance(value, list) else repr(value) == "-0.0"


def fractions(values):
    """A number, or each in nested lists, as a fraction."""
    return [fractions(v) for v in values] if isinstance(values, list) else Fraction(values)


def rounded(x):
    """The float64 nearest to a fraction, ties to even."""
    try:
        return x.numerator / x.denominator + 0.0
    except OverflowError:
        return float("inf") if x > 0 else float("-inf")


def whole(values):
    """Fractions as whole numbers over one unit, and that unit."""
    unit = lcm(*(v.denominator for v in values))
    return [v.numerator * (unit // v.denominator) for v in values], unit


def along(M, v):
    """The product M v."""
    v, of_v = whole(v)
    rows = [whole(row) for row in M]
    return [Fraction(sum(x * y for x, y in zip(row, v, strict=True)), u * of_v) for row, u in rows]


def dot(u, v):
    """The scalar product u'v."""
    return along([u], v)[0]


def eliminated(S, right):
    """Rows [S, right] of a symmetric S from the diagonal on, upper triangular (Bareiss).

    They are whole numbers, and each pivot is a leading minor of S in one unit. Where one is zero,
    the rows end with it: S is no matrix that needs swaps if it is definite, or [H A'; A 0] with H
    definite.
    """
    n = len(S)
    numbers, unit = whole([v for i, row in enumerate(S) for v in (*row[i:], right[i])])
    at = [i * (n + 1) - i * (i - 1) // 2 for i in range(n + 1)]
    rows, last = [numbers[at[i] : at[i + 1]] for i in range(n)], 1
    for k in range(n):
        pivot, *first = rows[k]
        if not pivot:
            return rows[: k + 1], unit
        for i, lead in enumerate(first[:-1]):
            row = zip(rows[k + 1 + i], first[i:], strict=True)
            rows[k + 1 + i] = [(pivot * v - lead * w) // last for v, w in row]
        last = pivot
    return rows, unit


def definite(S, share=1e-14):
    """Whether each pivot of elimination is above a share of its entry on the diagonal."""
    (rows, unit), last = eliminated(S, [Fraction(0)] * len(S)), 1
    for k, (pivot, *_) in enumerate(rows):
        if pivot <= max(Fraction(share) * S[k][k] * unit * last, 0):
            return False
        last = pivot
    return True


def solved(H, g, A, b):
    """The x and y of H x + A'y = g and A x = b, H being definite; None if rows depend."""
    n, zero = len(H), [Fraction(0)] * len(A)
    upper = [[*row, *(a[i] for a in A)] for i, row in enumerate(H)]
    rows, _ = eliminated(upper + [[*a, *zero] for a in A], g + b)
    if not all(row[0] for row in rows):
        return None
    D, x = rows[-1][0] if rows else 1, []  # D x is whole
    for pivot, *others, last in reversed(rows):
        x.insert(0, (D * last - sum(v * w for v, w in zip(others, x, strict=True))) // pivot)
    x = [Fraction(v, D) for v in x]
    return x[:n], x[n:]


def turn(k, K):
    """The float64 numbers nearest to cos and sin of k/K of a turn, by their series."""
    angle = 2 * PI * ONE * k // (K * 10**59)
    term, sums = ONE, [0, 0, 0, 0]
    for i in range(100):
        sums[i % 4] += term
        term = term * angle // (ONE * (i + 1))
    both = (sums[0] - sums[2], sums[1] - sums[3])
    return [rounded(Fraction(v, ONE)) if abs(v) > 2**128 else 0.0 for v in both]


def cone_rows(cone, rows):
    """(p, q, 1, r) of each row p mu_v J_1 + q mu_v J_2 + J_n + r mu_omega J_w of a contact."""
    K = next((K for K in range(4, 1025, 2) if cone == f"facets-{K}"), None)
    need(cone != "ellipsoid", "the cone is the ellipsoid, and only cones with rows are judged here")
    need(K or cone in ("pyramid", "product", "frictionless"), f"the cone {cone!r} is unknown")
    sides = [turn(k, K) for k in range(K)] if K else SQUARE
    spins = (1, -1) if rows == 6 else ()
    if cone == "frictionless":
        return [[0, 0, 1, 0]]
    if cone == "product":
        return [[*side, 1, spin] for spin in spins or (0,) for side in sides]
    return [[*side, 1, 0] for side in sides] + [[0, 0, 1, spin] for spin in spins]  # Eqs. (5)-(7)


def problem(step):
    """H, g, A and b of Eqs. (13) and (8), and of each contact its rows' (p, q, 1, r), times mu."""
    h, n_a, n_u = fractions(step["h"]), step["n_a"], step["n_u"]
    K_q, M_u = fractions(step["K_q"]), fractions(step["M_u"])
    H = [[h * v for v in row] + [Fraction(0)] * n_u for row in K_q]
    H += [[Fraction(0)] * n_a + [v / h for v in row] for row in M_u]
    tau_k = along(K_q, fractions(step["delta_q_bar_a"]))  # Eq. (1)
    tau_a = [v + w for v, w in zip(tau_k, fractions(step["tau_a"]), strict=True)]
    g = [h * tau for tau in tau_a + fractions(step["tau_u"])]
    A, b, weights = [], [], []
    for contact in step["contacts"]:
        J = list(zip(*fractions(contact["J"]), strict=True))  # its columns
        axes = [fractions(contact[axis]) for axis in ("d1", "d2", "n")]
        in_frame = [[*along(axes, column[:3]), column[3]] for column in J]  # (J_1, J_2, J_n, J_w)
        mu = fractions([contact["mu_v"], contact["mu_v"], 1, contact["mu_omega"]])
        rows = fractions(cone_rows(step["cone"], contact["rows"]))
        weights.append([[m * v for m, v in zip(mu, row, strict=True)] for row in rows])
        A += [along(in_frame, row) for row in weights[-1]]  # Eq. (8)
        b += [-fractions(contact["phi"])] * len(rows)
    extra = step.get("extra", {"A": [], "b": []})
    if "H" in extra:  # a user's cost 1/2 x'Hx - g'x
        H = [list(map(add, *rows)) for rows in zip(H, fractions(extra["H"]), strict=True)]
        g = list(map(add, g, fractions(extra["g"])))
    return H, g, A + fractions(extra["A"]), b + fractions(extra["b"]), weights


def infeasible(A, b, y):
    """Whether y proves that no x has A x >= b: y >= 0, A'y = 0 and b'y > 0."""
    need(all(set(v) <= set("0123456789/") for v in y), "farkas has no fractions, or negative ones")
    y = fractions(y)
    return not any(dot(column, y) for column in zip(*A, strict=True)) and dot(b, y) > 0


def verdicts(step, solution):
    """Each claim of a solution, and whether it holds."""
    text = json.dumps(step, ensure_ascii=False) + "\n"
    same = solution["step_sha256"] == hashlib.sha256(text.encode()).hexdigest()
    yield "of this step", same and solution["cone"] == step["cone"]
    H, g, A, b, weights = problem(step)
    need(definite(H), "H is not positive definite: the cost of extra is not convex")
    if solution["status"] == "infeasible":
        yield "Eq. (10) has no solution", infeasible(A, b, solution["farkas"])
        return
    yield "zero is written 0.0", not minus_zero(solution)
    claims = solution["certificate"]
    counts = [len(rows) for rows in weights] + [len(A) - sum(map(len, weights))]
    W = [sum(counts[:j]) + i for j, i in claims["active"] if 0 <= i < counts[j] and j >= 0]
    solution_on_W = solved(H, g, [A[w] for w in W], [b[w] for w in W])  # Eqs. (9) and (12)
    ordered = len(W) == len(claims["active"]) and sorted(set(W)) == W
    yield "active names independent rows, in order", ordered and solution_on_W is not None
    x, lam_W = solution_on_W[0], [-y for y in solution_on_W[1]]
    slack = [v - w for v, w in zip(along(A, x), b, strict=True)]
    lam = [read(c, (k,), "lam") for c, k in zip(solution["lam"], counts[:-1], strict=True)]
    every = [v for c in lam for v in c] + read(solution["lam_extra"], (counts[-1],), "lam_extra")
    right, idle = [rounded(v) for v in lam_W], [i for i in range(len(A)) if i not in W]
    yield "Eq. (9), delta_q", solution["delta_q"] == [rounded(v) for v in x]
    yield "Eq. (9), lam", [every[w] for w in W] == right
    yield "Eq. (10)", all(v >= 0 for v in slack)
    yield "Eq. (11), positive on active", all(v > 0 for v in lam_W)
    yield "Eq. (12), zero elsewhere", not any(every[i] for i in idle)
    forces = [
        [rounded(dot(column, impulses) / Fraction(step["h"])) for column in zip(*rows, strict=True)]
        for rows, impulses in zip(weights, fractions(lam), strict=True)
    ]
    yield "wrench", solution["wrench"] == forces
    flags = claims["multipliers_unique"], claims["differentiable"]
    true = flags == (True, True) or any(slack[i] == 0 for i in idle)  # then flags are not judged
    least = min((rounded(v) for v in slack if v), default=None) if flags[1] else 0.0
    true &= claims["smallest_inactive_slack"] == least and claims["error_bound"] == 0.0
    true &= claims["smallest_active_multiplier"] == min(right, default=None)
    yield "certificate", true


def number(value, name):
    """A finite number, or a text of one that float64 does not hold, as a fraction."""
    if isinstance(value, str):
        need(value and set(value) <= set("-0123456789/"), f"{name} is no fraction: {value!r}")
        return Fraction(value)
    return Fraction(read(value, (), name))


def matrix(value, shape, name):
    """A list of numbers, or of as many lists of them, as fractions."""
    right = isinstance(value, list) and len(value) == shape[0]
    need(right, f"{name} is no list of the right length")
    if len(shape) == 1:
        return [number(v, name) for v in value]
    return [matrix(row, shape[1:], name) for row in value]


def program_read(record):
    """A quadratic program with its answer; limits of null are infinite."""
    sizes = {name: len(read(record.get(name), list, name)) for name in ("q", "h", "b")}
    n, k, e = sizes.values()
    need(0 < n <= MOST, f"a program of {n} unknowns; at most {MOST} are judged here")
    head = {"format": {"quasistatic-ref/qp"}, "version": {2}, "status": str}
    arrays = dict.fromkeys(("P", "q", "G", "h", "A", "b", "lb", "ub"), list)
    kinds = {"infeasible": {"farkas": dict}, "not convex": {"direction": [str]}}
    kinds["unbounded"] = {"x": [str], "direction": [str]}
    kinds["optimal"] = {"x": (n,), "z": (k,), "y": (e,), "z_box": (n,), "obj": (), "obj_error": ()}
    kinds["optimal"] |= {"active": [str], "multipliers_unique": bool}
    kinds["optimal"] |= {"least_norm": [str], "direction": [str]}
    need(record.get("status") in kinds, f"status must be one of {[*kinds]}")
    qp = {name: value for name, value in record.items() if name in arrays or name == "constant"}
    others = {name: value for name, value in record.items() if name not in qp}
    need(arrays.keys() | {"constant"} == qp.keys(), "an array of the program is missing")
    qp |= read(others, head | kinds[record["status"]], "answer")
    for name, shape in {"P": (n, n), "q": (n,), "G": (k, n), "A": (e, n), "b": (e,)}.items():
        qp[name] = matrix(qp[name], shape, name)
    qp["constant"] = number(qp["constant"], "constant")
    return qp


def program_rows(qp):
    """The (a, side, sign) of each a x <= side by name; those of equations have sign 0."""
    n = len(qp["q"])
    eye = [[Fraction(i == j) for j in range(n)] for i in range(n)]
    sides = {"A": (qp["A"], qp["b"], 0), "G": (qp["G"], qp["h"], 1)}
    sides |= {"lb": (eye, qp["lb"], -1), "ub": (eye, qp["ub"], 1)}
    rows = {}
    for field, (lines, limits, sign) in sides.items():
        need(len(lines) == len(limits), f"{field} has another number of rows than limits")
        for i, (a, limit) in enumerate(zip(lines, limits, strict=True)):
            if limit is not None:
                rows[f"{field}[{i}]"] = (
                    a,
                    Fraction(limit if field == "A" else number(limit, f"{field}[{i}]")),
                    sign,
                )
    for i in range(n):
        low, high = (rows.get(f"{field}[{i}]") for field in ("lb", "ub"))
        if low and high and low[1] == high[1]:  # an equation
            rows[f"lb[{i}]"] = (*rows.pop(f"ub[{i}]")[:2], 0)
    return rows


def solutions(M, right, n):
    """A solution of M z = right and a basis of those of M z = 0, n unknowns; None if none."""
    rows = [whole([*row, v])[0] for row, v in zip(M, right, strict=True)]
    pivots, last = [], 1
    for j in range(n):  # as Bareiss, above and below
        k = len(pivots)
        found = next((i for i in range(k, len(rows)) if rows[i][j]), None)
        if found is None:
            continue
        rows[k], rows[found] = rows[found], rows[k]
        head = rows[k]
        for i, row in enumerate(rows):
            if i != k:
                rows[i] = [
                    (head[j] * v - row[j] * w) // last for v, w in zip(row, head, strict=True)
                ]
        last = head[j]
        pivots.append(j)
    if any(row[-1] for row in rows[len(pivots) :]):
        return None
    z, basis = [Fraction(0)] * n, []
    for row, j in zip(rows, pivots, strict=False):
        z[j] = Fraction(row[-1], last)
    for j in (j for j in range(n) if j not in pivots):
        basis.append([Fraction(k == j) for k in range(n)])
        for row, k in zip(rows, pivots, strict=False):
            basis[-1][k] = Fraction(-row[j], last)
    return z, basis


def semidefinite(S):
    """Whether a symmetric S is positive semidefinite, by elimination from its diagonal."""
    S = [*S]
    while S:
        k = next((k for k, row in enumerate(S) if row[k]), None)
        if k is None:
            return not any(map(any, S))
        (head, pivot), rest = (S[k], S[k][k]), [i for i in range(len(S)) if i != k]
        if pivot < 0:
            return False
        S = [[S[i][j] - S[i][k] * head[j] / pivot for j in rest] for i in rest]
    return True


def convex(P, rows):
    """Whether P is positive semidefinite where all equations hold."""
    n = len(P)
    equations = [a for a, _, sign in rows.values() if not sign]
    _, Z = solutions(equations, [Fraction(0)] * len(equations), n)
    return semidefinite([[dot(u, along(P, v)) for v in Z] for u in Z])


def balanced(P, q, W, L):
    """The x and y of P x + q + W'y = 0 where rows W and L hold, x of least norm; None if none.

    And the multipliers of L that hold x against the directions v of other points: P v + W'm = 0.
    """
    n, k = len(q), len(W)
    M = [[*row, *(a[i] for a, _, _ in W)] for i, row in enumerate(P)]
    M += [[*a, *[Fraction(0)] * k] for a, _, _ in W + L]
    found = solutions(M, [-v for v in q] + [side for _, side, _ in W + L], n + k)
    _, loose = solutions(M[: n + k], [Fraction(0)] * (n + k), n + k)
    if found is None or not all(any(v[:n]) for v in loose):  # W is dependent
        return None
    z, free = found
    squares = [[dot(u[:n], v[:n]) for v in free] for u in free]
    w, _ = solutions(squares, [-dot(u[:n], z[:n]) for u in free], len(free))
    z = [v + sum(t * u[i] for t, u in zip(w, free, strict=True)) for i, v in enumerate(z)]
    x = z[:n]
    held = solutions(
        [[dot(a, u[:n]) for a, _, _ in L] for u in loose], [-dot(x, u[:n]) for u in loose], len(L)
    )
    return None if held is None or held[1] else (x, z[n:], held[0])


def program_verdicts(qp):
    """Each claim of an answer to a quadratic program, and whether it holds."""
    rows, n = program_rows(qp), len(qp["q"])
    P = [[(qp["P"][i][j] + qp["P"][j][i]) / 2 for j in range(n)] for i in range(n)]
    q, status = qp["q"], qp["status"]
    if status == "infeasible":
        yield "there is no solution", contradicted(qp["farkas"], rows, n)
        return
    if status != "optimal":
        way = [number(v, "direction") for v in qp["direction"]]
        need(len(way) == n, "direction has another length than q")
        cost, slopes = dot(way, along(P, way)), along([a for a, _, _ in rows.values()], way)
        signed = [(v, sign) for v, (_, _, sign) in zip(slopes, rows.values(), strict=True)]
        if status == "not convex":
            yield "equations leave the direction", not any(v for v, sign in signed if not sign)
            yield "it costs less than nothing", cost < 0
            return
        x = [number(v, "x") for v in qp["x"]]
        need(len(x) == n, "x has another length than q")
        yield "x is feasible", feasible(rows, x)
        yield "no row ends the direction", all(v * s <= 0 if s else v == 0 for v, s in signed)
        yield "the cost falls without end", cost <= 0 and dot(along(P, x), way) + dot(q, way) < 0
        return
    yield "P is convex where something can move", convex(P, rows)
    W, L = (
        [rows[name] for name in qp[field] if name in rows] for field in ("active", "least_norm")
    )
    names = qp["active"] + qp["least_norm"]
    each_once = len(W) + len(L) == len(names) == len(set(names))
    found = (
        definite(P, 0)
        and not L
        and solved(P, [-v for v in q], [a for a, _, _ in W], [side for _, side, _ in W])
    )
    found = (*found, []) if found else balanced(P, q, W, L)
    yield "active names independent rows", each_once and found is not None
    x, y_W, y_L = found
    yield "x", qp["x"] == [rounded(v) for v in x]
    signs = [
        y * sign >= 0 if sign else True for y, (_, _, sign) in zip(y_W + y_L, W + L, strict=True)
    ]
    yield "signs of multipliers", all(signs)
    yield "rows", feasible(rows, x)
    right = {"z": [0.0] * len(qp["z"]), "y": [0.0] * len(qp["y"]), "z_box": [0.0] * n}
    for name, y in zip(qp["active"], y_W, strict=True):
        field, i = name[:-1].split("[")
        right[{"G": "z", "A": "y"}.get(field, "z_box")][int(i)] = rounded(y)
    yield "multipliers", all(qp[name] == values for name, values in right.items())
    value = dot(x, along(P, x)) / 2 + dot(q, x) + qp["constant"]
    yield "obj", abs(value - Fraction(qp["obj"])) <= Fraction(qp["obj_error"])
    idle = [dot(a, x) - side for name, (a, side, _) in rows.items() if name not in qp["active"]]
    yield "multipliers_unique", qp["multipliers_unique"] or 0 in idle  # false: not judged
    if qp["direction"]:  # without one: whether there is another optimum is not judged
        way = [number(v, "direction") for v in qp["direction"]]
        need(len(way) == n, "direction has another length than q")
        bear = {name for name, y in zip(qp["active"], y_W, strict=True) if y}
        pull = along(P, way)
        free = any(way) and dot(way, pull) == 0 and dot(q, way) + dot(x, pull) == 0
        for name, (a, side, sign) in rows.items():
            slope = dot(a, way)
            if slope and (name in bear or not sign or (dot(a, x) == side and slope * sign > 0)):
                free = False
        yield "direction", free


def feasible(rows, x):
    """Whether x satisfies all rows."""
    off = zip(along([a for a, _, _ in rows.values()], x), rows.values(), strict=True)
    return all((v - side) * sign <= 0 if sign else v == side for v, (_, side, sign) in off)


def contradicted(factors, rows, n):
    """Whether rows times the factors of a proof add up to 0 <= something negative."""
    total, limit = [Fraction(0)] * n, Fraction(0)
    for name, text in factors.items():
        need(name in rows, f"farkas names {name}, which is no limit of the program")
        v, (a, side, sign) = number(text, "farkas"), rows[name]
        if v < 0 and sign:
            return False
        way = -v if name.startswith("lb") else v
        total, limit = [t + way * w for t, w in zip(total, a, strict=True)], limit + way * side
    return not any(total) and limit < 0


def decimal(text):
    """A number as it is written; None of an infinite one."""
    infinite = text.lower().lstrip("+-").startswith("inf")
    return None if infinite else Fraction(text.upper().replace("D", "E"))


def blanks(line):
    """The fields of a line, which blanks part."""
    return line.split()


def places(line):
    """The fields of a line by where they stand: names may have blanks."""
    ends = ((1, 3), (4, 12), (14, 22), (24, 36), (39, 47), (49, 61))
    return [field for a, b in ends if (field := line[a:b].strip())]


class Qps:
    """The decimals of a QPS file: of each row {column: entry}, its kind, side and range."""

    def __init__(self, text, fields_of):
        self.kind, self.side, self.range, self.low, self.high = {}, {}, {}, {}, {}
        self.row, self.columns, self.P = {}, [], {}
        first, section = {}, ""
        for line in text.splitlines():
            if not line.strip() or line[0] == "*":
                continue
            if not line[0].isspace():
                section = line.split()[0].upper()
                need(section not in ("MAX", "OBJSENSE"), f"{section} is not judged here")
                continue
            fields = fields_of(line)
            if section == "ROWS":
                self.kind[fields[1]], self.row[fields[1]] = fields[0].upper(), {}
            elif section == "BOUNDS":
                free = fields[0].upper() in ("FR", "MI", "PL")
                named = len(fields) == (3 if free else 4)
                head = fields[1] if named else ""
                if first.setdefault(section, head) == head:
                    self.bound(fields[0].upper(), fields[1 + named], None if free else fields[-1])
            else:
                named = len(fields) % 2
                head = fields[0] if named else ""
                for name, value in zip(fields[named::2], fields[named + 1 :: 2], strict=True):
                    self.entry(section, head, name, decimal(value), first)

    def entry(self, section, head, name, v, first):
        """One pair of a name and a number."""
        if section == "COLUMNS":
            if head not in self.low:
                self.columns.append(head)
                self.low[head], self.high[head] = Fraction(0), None
            self.row[name][head] = self.row[name].get(head, 0) + v
        elif section in ("RHS", "RANGES"):
            if first.setdefault(section, head) == head:
                {"RHS": self.side, "RANGES": self.range}[section][name] = v
        else:
            need(section in ("QUADOBJ", "QSECTION", "QMATRIX"), f"{section} is not known here")
            need(head in self.low and name in self.low, f"{head}, {name} are no columns")
            pairs = {(head, name)} if section == "QMATRIX" else {(head, name), (name, head)}
            for pair in pairs:
                self.P[pair] = self.P.get(pair, 0) + v

    def bound(self, kind, name, text):
        """One bound of a column."""
        need(name in self.low, f"{name} is no column")
        need(kind in ("LO", "UP", "FX", "FR", "MI", "PL"), f"the bound {kind} is not known here")
        v = None if text is None else decimal(text)
        if kind in ("LO", "FX", "FR", "MI"):
            self.low[name] = v
        if kind in ("UP", "FX", "FR", "PL"):
            self.high[name] = v
        negative = kind == "UP" and v is not None and v < 0 and self.low[name] == 0
        need(not negative, f"{name} has an upper bound below 0, of which readers differ")

    def limits(self):
        """By its name in the table, each limit: a row, a side, and 1 for <=, -1 for >= and 0."""
        for name, kind in self.kind.items():
            side, size = self.side.get(name, Fraction(0)), self.range.get(name)
            low, high = (side if kind in "EG" else None), (side if kind in "EL" else None)
            if size is not None and kind in "EGL":
                low = side - abs(size) if kind == "L" or (kind == "E" and size < 0) else side
                high = side + abs(size) if kind == "G" or (kind == "E" and size > 0) else side
            if kind == "E" and not size:
                yield name, self.row[name], side, 0
            elif kind != "N":
                for end, word, sign in ((high, "<=", 1), (low, ">=", -1)):
                    if end is not None:
                        yield f"{name} {word}", self.row[name], end, sign
        for name in self.columns:
            low, high, itself = self.low[name], self.high[name], {name: Fraction(1)}
            if low is not None:
                yield f"{name} >=", itself, low, 0 if low == high else -1
            if high not in (None, low):
                yield f"{name} <=", itself, high, 1


def coupled(P):
    """The blocks of P, a matrix each."""
    beside, blocks = {}, []
    for i, j in P:
        beside.setdefault(i, set()).add(j)
    while beside:
        block, todo = [], [next(iter(beside))]
        while todo:
            j = todo.pop()
            if j in beside:
                block.append(j)
                todo += beside.pop(j)
        need(len(block) <= MOST, f"P couples {len(block)} unknowns, more than {MOST}")
        blocks.append([[P.get((i, j), Fraction(0)) for j in block] for i in block])
    return blocks


def line_verdicts(path, table_path):
    """Each claim of a line of a table of optima, and whether it holds."""
    with open(path, "rb") as file:
        content = file.read()
    with open(table_path, encoding="utf-8") as file:
        lines = [json.loads(text) for text in file]
    sha256 = hashlib.sha256(content).hexdigest()
    found = [line for line in lines if line["sha256"] == sha256]
    need(found, "no line of the table has the hash of this file")
    (line,) = found
    need(line["status"] == "optimal", f"the line says {line['status']}, of which nothing is kept")
    *folder, _ = table_path.split("/")
    answer = table("/".join([*folder, line["set"], f"{line['name']}.json"]))
    texts = [text for part in answer.values() for text in part.values()]
    need(all(isinstance(text, str) for text in texts), "the answer is too long for fractions")
    text = content.decode("utf-8", "replace")
    try:
        qps = Qps(text, blanks)
    except (LookupError, ValueError):  # names with blanks
        qps = Qps(text, places)
    x, y = ({name: Fraction(v) for name, v in answer[key].items()} for key in ("x", "multipliers"))
    need(x.keys() <= {*qps.columns}, "x names what is no column")
    limits = {name: limit for name, *limit in qps.limits()}
    need({*y, *line["active"]} <= limits.keys(), "a row is named that the file does not have")

    def off(name):
        row, side, _ = limits[name]
        return sum((v * x[j] for j, v in row.items() if j in x), -side)

    yield "P is convex", all(map(semidefinite, coupled(qps.P)))
    yield "rows", all(off(name) * sign <= 0 if sign else not off(name)
                      for name, (_, _, sign) in limits.items())  # fmt: skip
    yield "active rows bear", not any(map(off, {*y, *line["active"]}))
    yield "multipliers are of active rows", y.keys() <= {*line["active"]}
    yield "signs of multipliers", all(v > 0 or not limits[name][2] for name, v in y.items())
    objective = next(name for name, kind in qps.kind.items() if kind == "N")
    slope = {**qps.row[objective]}
    linear = sum((v * x[j] for j, v in slope.items() if j in x), -qps.side.get(objective, 0))
    quadratic = Fraction(0)
    for (i, j), v in qps.P.items():
        if j in x:
            slope[i] = slope.get(i, 0) + v * x[j]
            quadratic += v * x[j] * x.get(i, 0)
    for name, v in y.items():
        row, _, sign = limits[name]
        for j, a in row.items():
            slope[j] = slope.get(j, 0) + (sign or -1) * v * a
    yield "the multipliers balance the cost", not any(slope.values())
    value = linear + quadratic / 2
    yield "objective", float(value) == line["objective"]
    yield "fraction", line["fraction"] in (None, str(value))


def main(*paths):
    """Print what holds, up to the first claim that does not; the exit status."""
    try:
        need(len(paths) in (1, 2), "STEP.json and SOLUTION.json are asked for, or ANSWER.json")
        if paths[-1].endswith(".jsonl"):
            claims = line_verdicts(*paths)
        elif len(paths) == 1:
            claims = program_verdicts(program_read(table(*paths)))
        else:
            step, solution = map(table, paths)
            claims = verdicts(step_read(step), solution_read(solution))
        for claim, holds in claims:
            print(f"{claim}: {'holds' if holds else 'FAILS'}")
            if not holds:
                return 1
    except (ArithmeticError, LookupError, OSError, RecursionError, TypeError, ValueError) as error:
        print(f"cannot be judged: {error}")
        return 2
    return 0


if __name__ == "__main__":
    sys.set_int_max_str_digits(0)  # the fractions of a Farkas vector may be long
    sys.exit(main(*sys.argv[1:]))
