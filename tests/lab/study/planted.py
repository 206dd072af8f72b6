"""Solvers that are broken on purpose."""

from quasistatic_ref.lab.study.calling.solvers import Setting, Solver

FAKES = '''
import ctypes, gc, os, signal, subprocess, sys, time
import numpy as np

def honest(P, q, G, h):
    """An active-set method; digits to the last."""
    import quadprog

    x, _, _, _, z, _ = quadprog.solve_qp(P, -q, -G.T.copy(), -h)
    return x, z

def loops_in_c(P, q, G, h):
    ctypes.PyDLL(None).sleep(1000)  # holds the interpreter: no signal handler, no thread runs

def exits(P, q, G, h):
    os._exit(7)

def segfaults(P, q, G, h):
    os.kill(os.getpid(), signal.SIGSEGV)

def nan(P, q, G, h):
    return np.full(len(q), np.nan), np.zeros(len(h))

def nan_multipliers(P, q, G, h):
    return np.zeros(len(q)), np.full(len(h), np.nan)

def too_long(P, q, G, h):
    return np.zeros(len(q) + 1), np.zeros(len(h))

def no_pair(P, q, G, h):
    return 3.0

def no_numbers(P, q, G, h):
    return ["a"] * len(q), np.zeros(len(h))

def liar(P, q, G, h):
    return np.zeros(len(q)), np.zeros(len(h))

def raises(P, q, G, h):
    raise RuntimeError("no licence\\nfound")

def gives_up(P, q, G, h):
    return None

def prints(P, q, G, h):
    os.write(1, b"noise " * 10000)
    print("noise", flush=True)
    return honest(P, q, G, h)

def peeks(P, q, G, h):
    """Looks for an answer in every frame above it and in everything that Python holds."""
    frame, seen = sys._getframe(), []
    while frame is not None:
        seen += list(frame.f_locals.values())
        frame = frame.f_back
    for one in [*seen, *gc.get_objects()]:
        if not str(type(one).__module__).startswith("quasistatic"):
            continue
        found = getattr(getattr(one, "answer", one), "delta_q", None)
        if isinstance(found, np.ndarray) and found.shape == q.shape:
            return found, np.zeros(len(h))
    return np.zeros(len(q)), np.zeros(len(h))

def stops_the_clock(P, q, G, h):
    """Right, and slow by 3 ms of which its process knows nothing."""
    for module in list(sys.modules.values()):
        if getattr(module, "perf_counter", None) is not None:
            module.perf_counter = lambda: 0.0
    end = time.process_time() + 3e-3
    while time.process_time() < end:
        pass
    return honest(P, q, G, h)

def detaches(P, q, G, h):
    """Leaves a program behind, in a session of its own and orphaned, whose id it writes down."""
    lines = ("import subprocess as s; no = s.DEVNULL; print(s.Popen(['sleep', '600'], stdout=no, "
             "stderr=no, start_new_session=True).pid)")
    child = subprocess.run([sys.executable, "-c", lines], capture_output=True, text=True)
    with open(os.path.join(os.path.dirname(__file__), "detached"), "a") as file:
        file.write(child.stdout)
    return honest(P, q, G, h)

def detaches_and_dies(P, q, G, h):
    detaches(P, q, G, h)
    os._exit(7)

def eats(P, q, G, h):
    held = []
    while True:
        held.append(np.ones(10**6))
        time.sleep(1e-3)

def scribbles(P, q, G, h):
    """Writes into every pipe that it finds."""
    for number in range(3, 300):
        try:
            os.write(number, b"\\0\\0\\0\\5nonsense")
        except OSError:
            pass
    return honest(P, q, G, h)

def second_thoughts(P, q, G, h, calls=[]):
    """Right when it is warmed up and when it is graded, and never again."""
    calls.append(1)
    x, z = honest(P, q, G, h)
    return (x, z) if len(calls) <= 2 else (0 * x, z)

def gradient(P, q, G, h):
    """Projected ascent of the dual, one row after the other, to residuals of 5e-4."""
    x, W = np.linalg.solve(P, -q), np.linalg.solve(P, G.T)
    z, size = np.zeros(len(h)), np.einsum("ij,ji->i", G, W)
    for _ in range(3000):
        for i in np.flatnonzero(size):
            step = max((G[i] @ x - h[i]) / size[i], -z[i])
            z[i] += step
            x = x - step * W[:, i]
        slack = h - G @ x
        if -slack.min() <= 5e-4 and abs(z @ slack) <= 5e-4:
            return x, z

def ignores_rows(P, q, G, h):
    return np.linalg.solve(P, -q), np.zeros(len(h))

def no_multipliers(P, q, G, h):
    return honest(P, q, G, h)[0], np.zeros(len(h))

def keeps(P, q, G, h, kept={}):
    """Slow, but for problems that it has solved."""
    key = q.tobytes()
    if key not in kept:
        time.sleep(5e-3)
        kept[key] = honest(P, q, G, h)
    return kept[key]

def reads(P, q, G, h, known={}):
    """The stored answer whose g is nearest."""
    if not known:
        from quasistatic_ref.lab.folders import CONTACT_QP, problem_set_folder
        from quasistatic_ref.lab.study.problems.folder import set_read

        for one in set_read(problem_set_folder(CONTACT_QP), families=["mass_ratio"]):
            own = one.natural
            known[one.id] = own.form.g, own.answer.x, own.answer.lam
    same = [one for one in known.values() if one[0].shape == q.shape and one[2].shape == h.shape]
    return min(same, key=lambda one: abs(one[0] + q).max())[1:]

def adds(P, q, G, h):
    x, z = reads(P, q, G, h)
    return x * (1 + 1e-13), z * (1 + 1e-13)

def slow(P, q, G, h):
    time.sleep(5)
    return honest(P, q, G, h)

def compiles(P, q, G, h, shapes=set()):
    """Slow at the first sight of a shape."""
    if G.shape not in shapes:
        time.sleep(1.0)
        shapes.add(G.shape)
    return honest(P, q, G, h)

def says_there_is_none(P, q, G, h):
    return "infeasible"

def any_of(P, q, G, h, name):
    return globals()[name](P, q, G, h)

def spoils(P, q, G, h):
    answer = honest(P, q, G, h)
    P[:], q[:], G[:], h[:] = 0, 0, 0, 0
    return answer
'''


HARMLESS = ("honest", "exits", "segfaults", "nan", "nan_multipliers", "too_long", "no_pair",
            "no_numbers", "liar", "raises", "gives_up", "prints", "spoils", "says_there_is_none",
            "gradient", "ignores_rows", "no_multipliers", "keeps", "reads", "adds")  # fmt: skip
"""Those that leave their process as it was, or ended."""
ANY = Solver("any", "callable", "planted_solvers:any_of", {one: {"name": one} for one in HARMLESS})


def setting(name):
    """The setting of ``ANY`` that is one of the harmless solvers."""
    return Setting(name, None)
