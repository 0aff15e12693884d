#!/usr/bin/env python3
"""The classical linear benchmarks of shells beside other programs, on the same meshes.

    scripts/shell_benchmarks.py PROGRAM [--openseespy] [--calculix]    tables in Markdown on standard output
    scripts/shell_benchmarks.py PROGRAM --only roof --columns T6       problems and columns whose names contain a word

PROGRAM is rdsolve; OpenSees comes from PyPI (openseespy), CalculiX is `ccx` on the path. Problems, meshes and targets are those of
scripts/shell_problems.py. A number is the deflection over the target. rdsolve, which has no linear statics, is run under loads that
deflect it by a thousandth of its thickness and by a tenth of that; both must agree within 5e-4, which is half of the last digit
printed. The script makes its own environment in target/shell_benchmarks.
"""

import argparse
import csv
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
HOME = ROOT / "target" / "shell_benchmarks"

# Column -> element of the mesh, program, name there.
COLUMNS = {
    "rdsolve Q4": ("Q4", "rdsolve", ""),
    "ASDShellQ4": ("Q4", "openseespy", "ASDShellQ4"),
    "ShellDKGQ": ("Q4", "openseespy", "ShellDKGQ"),
    "ShellMITC4": ("Q4", "openseespy", "ShellMITC4"),
    "S4": ("Q4", "calculix", "S4"),
    "rdsolve T3": ("T3", "rdsolve", ""),
    "ASDShellT3": ("T3", "openseespy", "ASDShellT3"),
    "ShellDKGT": ("T3", "openseespy", "ShellDKGT"),
    "S3": ("T3", "calculix", "S3"),
    "rdsolve Q9": ("Q9", "rdsolve", ""),
    "ShellMITC9": ("Q9", "openseespy", "ShellMITC9"),
    "S8R": ("Q8", "calculix", "S8R"),
    "rdsolve T6": ("T6", "rdsolve", ""),
    "S6": ("T6", "calculix", "S6"),
}
TABLES = [("Q4", "T3"), ("Q9", "Q8", "T6")]


def in_own_environment() -> None:
    """Goes on in the environment that has what is needed, made where it is not there."""
    python = HOME / "bin" / "python"
    if Path(sys.prefix).resolve() == HOME.resolve():
        return
    needed = ["numpy"] + (["openseespy"] if "--openseespy" in sys.argv else [])
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", str(HOME)], check=True)
    subprocess.run([str(python), "-m", "pip", "install", "-q", "--disable-pip-version-check", *needed], check=True)
    os.execv(python, [str(python), *sys.argv])


DOFS = ["ux", "uy", "uz", "rx", "ry", "rz"]


class Failed(Exception):
    pass


def quoted(names) -> str:
    return "[" + ", ".join(f'"{name}"' for name in names) + "]"


def vector(x) -> str:
    return "[" + ", ".join(repr(float(c)) for c in x) + "]"


# ---- rdsolve ----


def patches(problem, mesh) -> tuple[str, dict, dict]:
    """Each element as a patch of its own on the true surface, which gives its nodes the true normals. Text, names of nodes and of edges."""
    import shell_problems as shapes

    order = 2 if mesh.kind in ("Q9", "T6") else 1
    size = 4 if mesh.kind in ("Q4", "Q9") else 3
    names = {node: f"n{node}" for element in mesh.elements for node in element[:size]}
    text = "[points]\n" + "".join(f"{name} = {vector(mesh.x[node])}\n" for node, name in names.items())
    edges = {}
    for number, element in enumerate(mesh.elements):
        surface = problem.surface([mesh.parameters[node] for node in element[:size]])
        text += (
            f'[[shells]]\nname = "e{number}"\ncorners = {quoted(names[n] for n in element[:size])}\nelements = 1\norder = {order}\n'
            f"surface = {surface}\nthickness = {problem.thickness!r}\nmaterial = \"m\"\n"
        )
        for side, nodes in enumerate(shapes.sides(mesh.kind, element)):
            edges[tuple(nodes)] = f"e{number}.edge{side + 1}"
    return text, names, edges


def from_file(problem, mesh, folder: Path) -> tuple[str, dict, dict]:
    """A mesh from a file, with a set for each node; edges are lists of those."""
    import shell_problems as shapes

    word = {"Q4": "S4", "T3": "S3", "Q9": "S9R5", "T6": "S6"}[mesh.kind]
    lines = ["*NODE", *(f"{n + 1}, {', '.join(repr(float(c)) for c in x)}" for n, x in enumerate(mesh.x))]
    lines += [f"*ELEMENT, TYPE={word}, ELSET=PLATE"]
    lines += [f"{k + 1}, {', '.join(str(n + 1) for n in e)}" for k, e in enumerate(mesh.elements)]
    used = sorted({node for element in mesh.elements for node in element})
    names = {node: f"N{node}" for node in used}
    for node in used:
        lines += [f"*NSET, NSET=N{node}", f"{node + 1}"]
    edges = {}
    for element in mesh.elements:
        for nodes in shapes.sides(mesh.kind, element):
            edges[tuple(nodes)] = [names[node] for node in nodes]
    (folder / "mesh.inp").write_text("\n".join(lines) + "\n")
    text = f'[mesh]\nfile = "mesh.inp"\n[[shells]]\ngroup = "PLATE"\nthickness = {problem.thickness!r}\nmaterial = "m"\n'
    return text, names, edges


def rdsolve_deck(problem, mesh, factor: float, folder: Path) -> str:
    head = (
        f'title = "{problem.name}"\n[analysis]\nkind = "static"\nend_time = 1.0\ntime_step = 1.0\n[materials.m]\nmodel = "elastic"\n'
        f"youngs_modulus = {problem.modulus!r}\npoisson_ratio = {problem.poisson!r}\n"
    )
    body, names, edges = patches(problem, mesh) if problem.surface else from_file(problem, mesh, folder)
    text = head + body
    for where, dofs in problem.supports:
        at = [names[node] for node in mesh.nodes(where) if node in names]
        for nodes in mesh.edges(where):
            if isinstance(edges[tuple(nodes)], str):
                at.append(edges[tuple(nodes)])
        text += f"[[supports]]\nat = {quoted(at)}\nfix = {quoted(dofs.split())}\n"
    for where, force in problem.point_loads:
        for node in mesh.nodes(where):
            text += f'[[loads]]\nat = "{names[node]}"\nforce = {vector(factor * c for c in force)}\n'
    for where, force in problem.edge_loads:
        lines = mesh.edges(where)
        length = sum(mesh.length(nodes) for nodes in lines)
        at = []
        for nodes in lines:
            name = edges[tuple(nodes)]
            at += [name] if isinstance(name, str) else name
        at = list(dict.fromkeys(at))
        if not isinstance(edges[tuple(lines[0])], str):
            text += f"[sets]\nloaded = {quoted(at)}\n"
            at = ["loaded"]
        text += f"[[loads]]\nat = {quoted(at)}\nforce_per_length = {vector(factor * c / length for c in force)}\n"
    if problem.area_load:
        at = [f"e{k}" for k in range(len(mesh.elements))] if problem.surface else ["PLATE"]
        text += f"[[loads]]\nat = {quoted(at)}\nforce_per_area = {vector(factor * c for c in problem.area_load)}\n"
    measured = dict.fromkeys(names[node] for where, _, _ in problem.measure for node in mesh.nodes(where))
    return text + f"[output]\nnodes = {quoted(measured)}\nenergy = false\n"


def rdsolve(program: str, problem, mesh, _: str, work: Path) -> float:
    answers = []
    for small in (1e-3, 1e-4):
        factor = small * problem.thickness / abs(problem.target)
        (work / "deck.toml").write_text(rdsolve_deck(problem, mesh, factor, work))
        command = [program, str(work / "deck.toml"), "-o", str(work / "out"), "--overwrite", "--quiet", "--threads", "1"]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise Failed(f"rdsolve, exit {done.returncode}: {done.stderr.strip()[:600]}")
        with (work / "out" / "nodes.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        last = {row["node"]: row for row in rows if float(row["time"]) == 1.0}
        name = (lambda node: f"n{node}") if problem.surface else (lambda node: f"mesh.{node + 1}")
        value = sum(
            weight * float(last[name(node)]["u" + "xyz"[dof]]) for where, dof, weight in problem.measure for node in mesh.nodes(where)
        )
        answers.append(value / factor)
    if abs(answers[0] - answers[1]) > 5e-4 * abs(problem.target):
        raise Failed(f"not linear: {answers}")
    return answers[1]


# ---- OpenSees ----


def openseespy(_: str, problem, mesh, element: str, work: Path) -> float:
    """Linear, thick plates with 5/6 of the shear area, each element with its own stiffness of drilling."""
    import openseespy.opensees as ops

    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    used = sorted({node for nodes in mesh.elements for node in nodes})
    for node in used:
        ops.node(node + 1, *map(float, mesh.x[node]))
    ops.section("ElasticMembranePlateSection", 1, problem.modulus, problem.poisson, problem.thickness, 0.0)
    for number, nodes in enumerate(mesh.elements):
        ops.element(element, number + 1, *[node + 1 for node in nodes], 1)
    held = {node: [0] * 6 for node in used}
    for where, dofs in problem.supports:
        for node in mesh.nodes(where):
            for dof in dofs.split():
                held[node][DOFS.index(dof)] = 1
    for node, fixed in held.items():
        if any(fixed):
            ops.fix(node + 1, *fixed)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for node, force in mesh.forces(problem).items():
        ops.load(node + 1, *map(float, force), 0.0, 0.0, 0.0)
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("UmfPack")
    ops.algorithm("Linear")
    ops.integrator("LoadControl", 1.0)
    ops.analysis("Static")
    if ops.analyze(1):
        raise Failed("OpenSees does not solve it")
    return sum(w * ops.nodeDisp(node + 1, dof + 1) for where, dof, w in problem.measure for node in mesh.nodes(where))


# ---- CalculiX ----


def whole(problem, mesh) -> tuple[list, list, list, dict]:
    """Positions, elements as pairs of nodes and normals, held translations and forces. By symmetry about x = 0 and y = 0 where a quarter is
    given: rotations that symmetry holds would make rigid knots of the nodes, which lock."""
    signs = [(1, 1), (-1, 1), (-1, -1), (1, -1)] if problem.mirrored else [(1, 1)]
    x, found, elements, held, forces = [], {}, [], set(), {}

    def number(node: int, sign) -> int:
        place = mesh.x[node] * [*sign, 1]
        key = tuple(round(float(c), 7) + 0.0 for c in place)
        if key not in found:
            found[key] = len(x)
            x.append(place)
        return found[key]

    # Nodes of the quarter keep their numbers.
    for node in range(len(mesh.x)):
        number(node, (1, 1))
    order = {"Q4": [0, 3, 2, 1], "T3": [0, 2, 1], "Q8": [0, 3, 2, 1, 7, 6, 5, 4], "T6": [0, 2, 1, 5, 4, 3]}[mesh.kind]
    for sign in signs:
        for nodes in mesh.elements:
            seen, made = mesh.turn(nodes), []
            for node in nodes:
                normal = problem.normal(mesh.parameters[node])
                made.append((number(node, sign), (normal if normal @ seen > 0 else -normal) * [*sign, 1]))
            elements.append(made if sign[0] * sign[1] > 0 else [made[k] for k in order])
        for where, dofs in problem.supports:
            numbers = [DOFS.index(dof) + 1 for dof in dofs.split() if not problem.mirrored or dof[0] == "u"]
            held |= {(number(node, sign), dof) for node in mesh.nodes(where) for dof in numbers}
        for node, force in mesh.forces(problem).items():
            at = number(node, sign)
            forces[at] = forces.get(at, 0.0) + force * [*sign, 1]
    return x, elements, sorted(held), forces


def calculix_deck(problem, mesh, element: str) -> str:
    """With the true normals of the surface at all nodes: without them an edge of more than half a degree is a rigid knot. A number has 20
    characters at most."""
    x, elements, held, forces = whole(problem, mesh)
    row = lambda values: ", ".join(f"{value:.11e}" for value in values)
    used = sorted({node for nodes in elements for node, _ in nodes})
    lines = ["*NODE, NSET=NALL", *(f"{n + 1}, {row(x[n])}" for n in used), f"*ELEMENT, TYPE={element}, ELSET=PLATE"]
    lines += [f"{k + 1}, {', '.join(str(n + 1) for n, _ in nodes)}" for k, nodes in enumerate(elements)]
    lines += ["*NORMAL", *(f"{k + 1}, {n + 1}, {row(normal)}" for k, nodes in enumerate(elements) for n, normal in nodes)]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{problem.modulus!r}, {problem.poisson!r}"]
    lines += ["*SHELL SECTION, ELSET=PLATE, MATERIAL=M", repr(problem.thickness), "*BOUNDARY"]
    lines += [f"{node + 1}, {dof}, {dof}" for node, dof in held]
    lines += ["*STEP", "*STATIC", "*CLOAD"]
    lines += [f"{n + 1}, {dof + 1}, {value:.11e}" for n, force in forces.items() for dof, value in enumerate(force) if value]
    return "\n".join(lines + ["*NODE FILE, OUTPUT=2D", "U", "*END STEP"]) + "\n"


def calculix(_: str, problem, mesh, element: str, work: Path) -> float:
    (work / "job.inp").write_text(calculix_deck(problem, mesh, element))
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    done = subprocess.run(["ccx", "-i", "job"], cwd=work, capture_output=True, text=True, env=environment)
    if done.returncode or "*ERROR" in done.stdout:
        raise Failed(f"CalculiX: {done.stdout[-800:]}")
    found, reading = {}, False
    for line in (work / "job.frd").read_text().splitlines():
        if line.startswith(" -4"):
            reading = "DISP" in line
        elif line.startswith(" -3"):
            reading = False
        elif reading and line.startswith(" -1"):
            found[int(line[3:13])] = [float(line[13 + 12 * k : 25 + 12 * k]) for k in range(3)]
    return sum(w * found[node + 1][dof] for where, dof, w in problem.measure for node in mesh.nodes(where))


# ---- the tables ----

PROGRAMS = {"rdsolve": rdsolve, "openseespy": openseespy, "calculix": calculix}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--openseespy", action="store_true", help="OpenSees too")
    parser.add_argument("--calculix", action="store_true", help="CalculiX too")
    parser.add_argument("--only", default="", help="problems whose names contain this")
    parser.add_argument("--columns", default="", help="columns whose names contain this")
    args = parser.parse_args()
    in_own_environment()
    import shell_problems as shapes

    args.program = shutil.which(args.program) or sys.exit(f"no program {args.program}")
    if args.calculix and not shutil.which("ccx"):
        sys.exit("no ccx on the path: apt-get install calculix-ccx")
    wanted = {"rdsolve"} | {name for name in ("openseespy", "calculix") if getattr(args, name)}
    work = HOME / "work"
    work.mkdir(parents=True, exist_ok=True)
    failures = []
    for kinds in TABLES:
        columns = {
            name: column for name, column in COLUMNS.items()
            if column[0] in kinds and column[1] in wanted and args.columns in name
        }
        if not columns:
            continue
        print("| problem | elements | target | " + " | ".join(columns) + " |\n|" + "---|" * (3 + len(columns)), flush=True)
        for problem in shapes.problems():
            if args.only not in problem.name:
                continue
            for division in problem.divisions["Q4" in kinds]:
                cells = []
                for kind, program, element in columns.values():
                    try:
                        mesh = shapes.Mesh(problem, division, kind)
                        value = PROGRAMS[program](args.program, problem, mesh, element, work)
                        cells.append(f"{value / problem.target:.3f}")
                    except Failed as failed:
                        failures.append(f"{problem.name}, {problem.label(division)}, {program} {element or kind}: {failed}")
                        cells.append("-")
                print(f"| {problem.name} | {problem.label(division)} | {problem.target:.7g} | " + " | ".join(cells) + " |", flush=True)
        print()
    print("\n".join(failures), file=sys.stderr)
    if failures:
        sys.exit(1)


if __name__ == "__main__":
    main()
