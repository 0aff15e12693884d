#!/usr/bin/env python3
"""What scenes of many bodies cost.  scripts/many_bodies.py PROGRAM [--only spheres|boxes|chains] [--most N] [--others N] [--keep DIR]

Spheres: N of them, ten layers high, fall into a box of five planes. They touch each other and the planes, with friction and a damper
that leaves half of the speed of an impact; central differences. Where they are installed, Exudyn computes the same (springs and dampers
of the same stiffness, explicit Euler steps) and MuJoCo the like (soft contacts of the same frequency and restitution, conjugate
gradients).

Boxes: the same with cubes that spin; Exudyn has none.

Chains: N bodies, one hung on the other by ball joints, swing under their weight; generalized-alpha and central differences. Exudyn with
the same implicit step (and its sparse solver), MuJoCo in minimal coordinates.

Times are processor times of one thread: of a whole run less that of a run half as long, so that start, reading and tables drop out, per
step and body. The growth is the slope of log(time of a step) over log N: 1 is linear. The other programs run in processes of their own
of the same Python; where one is not installed, the script goes on without it. --most and --others are the largest N of the program
and of the others, whose 30,000 spheres take minutes. With --keep decks and results stay in DIR.
"""
import argparse, csv, importlib.util, json, math, pathlib, random, resource, subprocess, sys, tempfile, time

GRAVITY = [0.0, 0.0, -9.81]

# ---- spheres ----

GRIDS = {1000: (10, 10), 3000: (15, 20), 10_000: (25, 40), 30_000: (50, 60)}
"""Along x and y; the height is the same for all N, and so is what happens."""
SPACING, RADIUS, FRICTION = 0.105, 0.05, 0.3
INERTIA = 0.4 * RADIUS**2
STIFFNESS = 1e5
DAMPING_RATIO = math.log(2.0) / math.hypot(math.pi, math.log(2.0))
"""Of an impact of two spheres; half of the speed is left."""
DAMPING = 2.0 * DAMPING_RATIO * math.sqrt(0.5 * STIFFNESS)
FALL = 0.3
STEPS = {"spheres": {"rdsolve": 600, "Exudyn": 600, "MuJoCo": 300}, "boxes": {"rdsolve": 2400, "MuJoCo": 1200}}
"""Of the whole time; the second half of it is measured."""


SOLIDS = {
    "spheres": (f'{{ kind = "sphere", radius = {RADIUS} }}', f'size="{RADIUS}"'),
    "boxes": (f'{{ kind = "box", size = {[1.6 * RADIUS] * 3} }}', f'type="box" size="{0.8 * RADIUS} {0.8 * RADIUS} {0.8 * RADIUS}"'),
}
"""In the deck, and in MuJoCo."""
SPIN = {"spheres": 0.0, "boxes": 3.0}


def solids(n, spin=0.0):
    """Centres, velocities and angular velocities, by layers from below, each of mass 1."""
    nx, ny = GRIDS[n]
    rng = random.Random(1)
    centers = [[SPACING * (i + 0.5), SPACING * (j + 0.5), SPACING * (k + 0.5)] for k in range(10) for j in range(ny) for i in range(nx)]
    random_vectors = lambda most: [[rng.uniform(-most, most) for _ in range(3)] for _ in centers]
    return centers, random_vectors(0.3), random_vectors(spin)


def walls(n):
    """Points and normals of the planes."""
    x, y = (SPACING * count for count in GRIDS[n])
    return [([0, 0, 0], [0, 0, 1]), ([0, 0, 0], [1, 0, 0]), ([x, 0, 0], [-1, 0, 0]), ([0, 0, 0], [0, 1, 0]), ([0, y, 0], [0, -1, 0])]


def names(count):
    return ", ".join(f'"b{i}"' for i in range(count))


def head(scheme, end, steps):
    return (f'[analysis]\nkind = "dynamic"\nend_time = {end}\ntime_step = {end / steps!r}\n[integrator]\nscheme = "{scheme}"\n'
            f"[environment]\ngravity = {GRAVITY}\n[output]\ninterval = {end}\ncontacts = true\n")


def deck_of_solids(kind, n, end, steps):
    lines = [head("central-difference", end, steps), f"[sets]\nballs = [{names(n)}]\n"]
    for i, (center, velocity, spin) in enumerate(zip(*solids(n, SPIN[kind]))):
        lines.append(f'[[bodies]]\nname = "b{i}"\nmass = 1.0\ncenter = {center}\nvelocity = {velocity}\n'
                     f'angular_velocity = {spin}\nshape = {SOLIDS[kind][0]}\n')
    law = f"stiffness = {STIFFNESS}\ndamping = {DAMPING}\nfriction = {FRICTION}\n"
    for i, (point, normal) in enumerate(walls(n)):
        surface = f'{{ shape = "plane", point = {point}, normal = {normal} }}'
        lines.append(f'[[contacts]]\nname = "wall{i}"\nsurface = {surface}\nwith = "balls"\n' + law)
    return "".join(lines) + '[[contacts]]\nname = "pairs"\namong = "balls"\n' + law


VELOCITY, TURNING = ["vx", "vy", "vz"], ["wx", "wy", "wz"]


def state(z, v, w):
    """Mean height, and kinetic energy of a sphere."""
    square = lambda rows: sum(a * a for row in rows for a in row)
    return {"height": sum(z) / len(z), "kinetic": 0.5 * (square(v) + INERTIA * square(w)) / len(z)}


def solids_mujoco(n, kind="spheres"):
    import mujoco

    stiffness = lambda inverse_mass: f'solref="{-STIFFNESS * inverse_mass} {-DAMPING * inverse_mass}"'
    steps = STEPS[kind]["MuJoCo"]
    text = [f'<mujoco><option timestep="{FALL / steps}" solver="CG" cone="elliptic" integrator="implicitfast" tolerance="1e-6"/>',
            f'<size memory="4G"/><default><geom condim="3" friction="{FRICTION} 0 0" {stiffness(2.0)}/></default><worldbody>']
    vector = lambda v: " ".join(map(str, v))
    for point, normal in walls(n):
        text.append(f'<geom type="plane" size="0 0 1" priority="1" pos="{vector(point)}" zaxis="{vector(normal)}" {stiffness(1.0)}/>')
    centers, velocities, spins = solids(n, SPIN[kind])
    text += [f'<body pos="{vector(c)}"><freejoint/><geom {SOLIDS[kind][1]} mass="1"/></body>' for c in centers]
    model = mujoco.MjModel.from_xml_string("".join(text) + "</worldbody></mujoco>")
    data = mujoco.MjData(model)
    data.qvel.reshape(-1, 6)[:, :3], data.qvel.reshape(-1, 6)[:, 3:] = velocities, spins
    mujoco.mj_step(model, data, steps // 2)
    began = time.process_time()
    mujoco.mj_step(model, data, steps - steps // 2)
    seconds = time.process_time() - began
    v = data.qvel.reshape(-1, 6)
    pairs = int((data.contact.geom1 >= len(walls(n))).sum())
    return seconds, {"pairs": pairs} | state(data.qpos.reshape(-1, 7)[:, 2].tolist(), v[:, :3].tolist(), v[:, 3:].tolist())


def spheres_exudyn(n):
    import exudyn as exu
    import numpy as np
    from exudyn.utilities import Force, InertiaSphere, MarkerBodyRigid, MarkerNodeRigid, NodeRigidBodyRotVecLG, ObjectGround
    from exudyn.utilities import ObjectRigidBody

    def run(end, steps):
        mbs = exu.SystemContainer().AddSystem()
        contact = mbs.AddGeneralContact()
        # Two stiffnesses act in series.
        law = {"contactStiffness": 2 * STIFFNESS, "contactDamping": 2 * DAMPING, "frictionMaterialIndex": 0}
        ground = mbs.AddMarker(MarkerBodyRigid(bodyNumber=mbs.AddObject(ObjectGround())))
        (x, y), h = (SPACING * np.array(GRIDS[n])), 12 * SPACING
        for corners in (
            [[0, 0, 0], [x, 0, 0], [x, y, 0], [0, y, 0]], [[0, 0, 0], [0, y, 0], [0, y, h], [0, 0, h]],
            [[x, 0, 0], [x, 0, h], [x, y, h], [x, y, 0]], [[0, 0, 0], [0, 0, h], [x, 0, h], [x, 0, 0]],
            [[0, y, 0], [x, y, 0], [x, y, h], [0, y, h]],
        ):
            contact.AddTrianglesRigidBodyBased(ground, pointList=corners, triangleList=[[0, 1, 2], [0, 2, 3]], **law)
        centers, velocities, _ = solids(n)
        for c, v in zip(centers, velocities):
            node = mbs.AddNode(NodeRigidBodyRotVecLG(referenceCoordinates=c + [0, 0, 0], initialVelocities=v + [0, 0, 0]))
            mbs.AddObject(ObjectRigidBody(mass=1.0, inertia=InertiaSphere(1.0, RADIUS).GetInertia6D(), nodeNumber=node))
            marker = mbs.AddMarker(MarkerNodeRigid(nodeNumber=node))
            mbs.AddLoad(Force(markerNumber=marker, loadVector=GRAVITY))
            contact.AddSphereWithMarker(marker, radius=RADIUS, **law)
        contact.SetFrictionPairings(FRICTION * np.eye(1))
        contact.SetSearchTreeCellSize(numberOfCells=[*GRIDS[n], 12])
        contact.SetSearchTreeBox(pMin=[-0.1, -0.1, -0.1], pMax=[x + 0.1, y + 0.1, h])
        contact.frictionProportionalZone = 1e-2
        mbs.Assemble()
        seconds = exudyn_run(exu, mbs, end, steps, exu.DynamicSolverType.ExplicitEuler)
        q, v = (np.array(f()).reshape(-1, 6) for f in (mbs.systemData.GetODE2Coordinates, mbs.systemData.GetODE2Coordinates_t))
        return seconds, state((np.array(centers) + q[:, :3])[:, 2].tolist(), v[:, :3].tolist(), v[:, 3:].tolist())

    steps = STEPS["spheres"]["Exudyn"]
    half, (whole, found) = run(FALL / 2, steps // 2)[0], run(FALL, steps)
    return whole - half, found


def exudyn_run(exu, mbs, end, steps, solver):
    """Seconds of processor time."""
    settings = exu.SimulationSettings()
    integration = settings.timeIntegration
    integration.numberOfSteps, integration.endTime, integration.verboseMode = steps, end, 0
    integration.explicit.computeEndOfStepAccelerations = False
    integration.explicit.computeMassMatrixInversePerBody = True
    integration.newton.useModifiedNewton = True  # three to five times as fast here
    integration.generalizedAlpha.spectralRadius = 0.8
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    settings.solution.file.write = False
    began = time.process_time()
    mbs.SolveDynamic(settings, solverType=solver, showHints=False)
    return time.process_time() - began


# ---- chains ----

LENGTHS = [10, 30, 100, 300, 1000, 3000, 10_000, 20_000]
COMPARED = [100, 1000]
CHAIN_INERTIA = 0.1
SWING, IMPLICIT_STEPS, EXPLICIT_STEPS = 0.4, 40, 400


def chain(n):
    """Joints, and the end: links of length 1 along a helix of two turns that slopes down by half a right angle."""
    points = [[0.0, 0.0, 0.0]]
    for i in range(n):
        angle = 4 * math.pi * (i + 0.5) / n
        direction = [1.0, 0.3 * math.sin(angle), -1.0 + 0.3 * math.cos(angle)]
        length = math.hypot(*direction)
        points.append([p + d / length for p, d in zip(points[-1], direction)])
    return points


def middle(a, b):
    return [(p + q) / 2 for p, q in zip(a, b)]


def deck_of_chain(scheme, n, end, steps):
    points = chain(n)
    lines = [head(scheme, end, steps)]
    for i, (a, b) in enumerate(zip(points, points[1:])):
        lines.append(f'[[bodies]]\nname = "b{i}"\nmass = 1.0\ncenter = {middle(a, b)}\ninertia = {[CHAIN_INERTIA] * 3}\n')
        before = f'body = "b{i - 1}", point = {a}' if i else f"ground = {a}"
        lines.append(f'[[joints]]\nkind = "ball"\nname = "j{i}"\nfrom = {{ {before} }}\nto = {{ body = "b{i}" }}\n')
    return "".join(lines)


def chain_mujoco(n):
    import mujoco

    spec = mujoco.MjSpec()
    # Fourth order is converged at this step; beyond some hundred bodies a step takes so long that only one stage can be afforded.
    order = mujoco.mjtIntegrator.mjINT_RK4 if n <= 300 else mujoco.mjtIntegrator.mjINT_EULER
    spec.option.timestep, spec.option.integrator = SWING / IMPLICIT_STEPS, order
    points, body, at = chain(n), spec.worldbody, [0.0, 0.0, 0.0]
    for a, b in zip(points, points[1:]):
        here = lambda p, q: [x - y for x, y in zip(p, q)]
        body = body.add_body(pos=here(a, at), mass=1.0, inertia=[CHAIN_INERTIA] * 3, ipos=here(middle(a, b), a), explicitinertial=True)
        body.add_joint(type=mujoco.mjtJoint.mjJNT_BALL)
        at = a
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, IMPLICIT_STEPS // 2)
    began = time.process_time()
    mujoco.mj_step(model, data, IMPLICIT_STEPS // 2)
    seconds = time.process_time() - began
    mujoco.mj_forward(model, data)
    return seconds, {"last": data.xipos[-1].tolist()}


def chain_exudyn(n):
    import exudyn as exu
    import numpy as np
    from exudyn.utilities import RigidBodyInertia

    def run(end, steps):
        mbs, points = exu.SystemContainer().AddSystem(), chain(n)
        body = mbs.CreateGround()
        for a, b in zip(points, points[1:]):
            inertia = RigidBodyInertia(mass=1.0, inertiaTensor=CHAIN_INERTIA * np.eye(3))
            before, body = body, mbs.CreateRigidBody(referencePosition=middle(a, b), inertia=inertia, gravity=GRAVITY)
            mbs.CreateSphericalJoint(itemNumbers=[before, body], position=a, show=False)
        mbs.Assemble()
        seconds = exudyn_run(exu, mbs, end, steps, exu.DynamicSolverType.GeneralizedAlpha)
        return seconds, {"last": list(mbs.GetObjectOutputBody(body, exu.OutputVariableType.Position, [0, 0, 0]))}

    half, (whole, found) = run(SWING / 2, IMPLICIT_STEPS // 2)[0], run(SWING, IMPLICIT_STEPS)
    return whole - half, found


# ---- runs ----

OTHERS = {"Exudyn": {"spheres": spheres_exudyn, "chain": chain_exudyn},
          "MuJoCo": {"spheres": solids_mujoco, "boxes": lambda n: solids_mujoco(n, "boxes"), "chain": chain_mujoco}}


def other(program, scene, n):
    """What the other program finds, by a process of its own, or None."""
    if importlib.util.find_spec(program.lower()) is None or scene not in OTHERS[program]:
        return None
    command = [sys.executable, "-W", "ignore", __file__, "--other", program, scene, str(n)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        print(f"{program}, {scene}, {n}: {done.stderr.strip().splitlines()[-1:]}", file=sys.stderr)
        return None
    return json.loads(done.stdout.splitlines()[-1])


def in_own_process(program, scene, n):
    seconds, found = OTHERS[program][scene](n)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(json.dumps({"seconds": seconds, "memory": memory} | found))


ENOUGH = 20.0
"""Seconds of processor time after which a scene is not run again; no scene is run more than nine times."""


class Runs:
    """Of the program measured."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, name, text):
        """Processor time and folder of results."""
        deck, out = self.folder / f"{name}.toml", self.folder / name
        deck.write_text(text)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        command = [self.program, "run", deck, "-o", out, "--quiet", "--overwrite", "--threads", "1"]
        done = subprocess.run(command, capture_output=True, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode:
            raise RuntimeError(f"{name}: exit code {done.returncode}: {done.stderr}")
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, out

    def half_and_whole(self, name, deck, end, steps):
        """`deck` makes a text of an end and a number of steps."""
        least, spent, rounds = [math.inf, math.inf], 0.0, 0
        # Noise matters in short runs; long ones would take an hour to repeat.
        while rounds == 0 or rounds < 9 and spent < ENOUGH:
            for i, part in enumerate((0.5, 1.0)):
                seconds, out = self.run(name, deck(part * end, round(part * steps)))
                least[i], spent = min(least[i], seconds), spent + seconds
            rounds += 1
        report = json.loads((out / "result.json").read_text())
        if report["counts"]["steps"] != steps or report["warnings"]:
            print(f"{name}: {report['counts']} {report['warnings']}", file=sys.stderr)
        return {"seconds": least[1] - least[0], "memory": report["peak_memory_bytes"] / 2**20, "report": report, "out": out}


def last_rows(path):
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    return [row for row in rows if row["time"] == rows[-1]["time"]]


def numbers(row, keys):
    return [float(row[key]) for key in keys]


def growth(sizes, seconds):
    """Slope of log(seconds) over log(sizes)."""
    x, y = ([math.log(value) for value in values] for values in (sizes, seconds))
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def print_growth(what, found):
    if len(found) > 1:
        print(f"{what}: time of a step grows with N^{growth(*zip(*found)):.2f}")


def measure_solids(kind, runs, most, others):
    print(f"| {kind} | program | step, ms | pairs | µs a step and body | s a simulated s | MB | mean height | kinetic energy of one |")
    print("|---|---|---|---|---|---|---|---|---|")
    grown = {}
    for n in (n for n in GRIDS if n <= most):
        for program, steps in STEPS[kind].items():
            if program in OTHERS and n > others:
                continue
            if program == "rdsolve":
                found = runs.half_and_whole(f"{kind}_{n}", lambda end, steps: deck_of_solids(kind, n, end, steps), FALL, steps)
                rows = last_rows(found["out"] / "bodies.csv")
                found |= state([float(row["z"]) for row in rows], *([numbers(row, keys) for row in rows] for keys in (VELOCITY, TURNING)))
                found["pairs"] = next(row["touching"] for row in last_rows(found["out"] / "contacts.csv") if row["contact"] == "pairs")
            elif not (found := other(program, kind, n)):
                print(f"| {n} | {program} | not installed, or failed |")
                continue
            step = found["seconds"] / (steps / 2)
            grown.setdefault(program, []).append((n, step))
            print(f"| {n} | {program} | {1e3 * FALL / steps:g} | {found.get('pairs', '')} | {1e6 * step / n:.2f} "
                  f"| {step * steps / FALL:.1f} | {found['memory']:.0f} | {found['height']:.4f} | {found['kinetic']:.4f} |", flush=True)
    for program, found in grown.items():
        print_growth(program, found)


def measure_chains(runs, most, others):
    print("| bodies | generalized-alpha, µs a step and body | iterations a step | MB | central differences, µs a step and body | MB |")
    print("|---|---|---|---|---|---|")
    grown, last = {"generalized-alpha": [], "central-difference": []}, {}
    for n in (n for n in LENGTHS if n <= most):
        cells = [str(n)]
        for scheme, steps in (("generalized-alpha", IMPLICIT_STEPS), ("central-difference", EXPLICIT_STEPS)):
            found = runs.half_and_whole(f"{scheme}_{n}", lambda end, steps: deck_of_chain(scheme, n, end, steps), SWING, steps)
            step = found["seconds"] / (steps / 2)
            grown[scheme].append((n, step))
            last[scheme, n] = step, numbers(last_rows(found["out"] / "bodies.csv")[-1], "xyz")
            counts = found["report"]["counts"]
            iterations = [f"{counts['iterations'] / counts['steps']:.1f}"] if scheme == "generalized-alpha" else []
            cells += [f"{1e6 * step / n:.2f}", *iterations, f"{found['memory']:.0f}"]
        print(f"| {' | '.join(cells)} |", flush=True)
    for scheme, found in grown.items():
        print_growth(scheme, found)
    print("\n| bodies | program | step, ms | µs a step and body | s a simulated s | last body | away from central differences |")
    print("|---|---|---|---|---|---|---|")
    for n in (n for n in COMPARED if n <= most):
        exact = last["central-difference", n][1]
        for program in ("generalized-alpha", "central-difference", "Exudyn", "MuJoCo"):
            steps = EXPLICIT_STEPS if program == "central-difference" else IMPLICIT_STEPS
            if program in OTHERS and n > others:
                continue
            if program in OTHERS:
                if not (found := other(program, "chain", n)):
                    print(f"| {n} | {program} | not installed, or failed |")
                    continue
                step, at = found["seconds"] / (steps / 2), found["last"]
            else:
                step, at = last[program, n]
            where = ", ".join(f"{x:.4f}" for x in at)
            print(f"| {n} | {program} | {1e3 * SWING / steps:g} | {1e6 * step / n:.2f} | {step * steps / SWING:.3g} | {where} "
                  f"| {math.dist(at, exact):.1e} |", flush=True)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("program", nargs="?")
    p.add_argument("--only", choices=["spheres", "boxes", "chains"])
    p.add_argument("--most", type=int, default=30_000)
    p.add_argument("--others", type=int, default=10_000)
    p.add_argument("--keep", type=pathlib.Path)
    p.add_argument("--other", nargs=3, help=argparse.SUPPRESS)
    a = p.parse_args()
    if a.other:
        return in_own_process(a.other[0], a.other[1], int(a.other[2]))
    if not a.program:
        p.error("which program?")
    with tempfile.TemporaryDirectory() as folder:
        if a.keep:
            a.keep.mkdir(parents=True, exist_ok=True)
        runs = Runs(a.program, a.keep or pathlib.Path(folder))
        for name in ("spheres", "boxes", "chains"):
            if a.only in (None, name):
                measure_chains(runs, a.most, a.others) if name == "chains" else measure_solids(name, runs, a.most, a.others)
                print()


if __name__ == "__main__":
    main()
