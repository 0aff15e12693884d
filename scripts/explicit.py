#!/usr/bin/env python3
"""What a step by central differences costs.  scripts/explicit.py PROGRAM [OTHER] [--threads 1,2] [--runs 3] [--only NAME]

Writes decks of some ten thousand elements to a temporary folder and runs them in turn with each program; least seconds of the
loop and of processor time over the runs, per element and step. Steps count the 60 evaluations by which the critical step is
measured first. Programs are run one after the other, so that what else the machine does falls on all of them.
"""
import argparse, itertools, json, math, pathlib, resource, subprocess, tempfile

STEPS = 390
EVALUATIONS = STEPS + 60
ELASTIC = """[materials.steel]
model = "elastic"
youngs_modulus = 210e9
poisson_ratio = 0.3
density = 7850.0
"""
YIELDING = ELASTIC.replace('"elastic"', '"elastic-plastic"') + "yield_stress = 1e5\nhardening_modulus = 2e9\n"
TUBE = '[sections.tube]\nshape = "tube"\nradius = 0.05\nthickness = 0.005\n'
FIBRES = '[sections.tube]\nshape = "rectangle"\nwidth = 0.05\nheight = 0.05\nfibres = [4, 4]\n'


def head(step):
    end = step * STEPS
    return f"""[analysis]
kind = "dynamic"
end_time = {end}
time_step = {step}
[integrator]
scheme = "central-difference"
[output]
interval = {end}
"""


def sheet(material, more=""):
    """A sheet of 100 x 100 quadrilaterals under pressure."""
    text = head(1e-6) + material + """[points]
a = [0.0, 0.0, 0.0]
b = [2.0, 0.0, 0.0]
c = [2.0, 2.0, 0.1]
d = [0.0, 2.0, 0.0]
[[shells]]
name = "sheet"
corners = ["a", "b", "c", "d"]
elements = [100, 100]
material = "steel"
thickness = 0.01
""" + more
    return 10_000, text + '[[supports]]\nat = "sheet.edge1"\nfix = "all"\n[[loads]]\nat = "sheet"\npressure = 3e5\n'


def names(points):
    return ", ".join(f'"{point}"' for point in points)


def beam(name, path, elements, normal):
    return (f'[[beams]]\nname = "{name}"\npath = [{names(path)}]\nelements = {elements}\norder = 1\nmaterial = "steel"\n'
            f'section = "tube"\norientation = {normal}\n')


def space_frame(material, section, pushed):
    """Beams that wind through all points of a grid along each axis, two elements from point to point; every other point is pushed."""
    n, cells = 12, list(itertools.product(range(12), repeat=3))
    text = head(5e-6) + material + section + "[points]\n"
    for i, j, k in cells:
        x, y, z = 0.7 * i, 0.8 * j, 0.9 * k
        text += f"p{i}_{j}_{k} = [{x}, {y}, {z + 0.02 * math.sin(1.3 * x) * y}]\n"
    back = lambda index, turn: index if turn % 2 == 0 else n - 1 - index
    for axis in range(3):
        path = []
        for i, j, k in cells:
            at = [back(k, i * n + j), back(j, i), i]
            path.append("p%d_%d_%d" % tuple(at[-axis:] + at[:-axis] if axis else at))
        text += beam(f"beam{axis}", path, 2, [1.0, 1.1, 1.2])
    text += f'[[supports]]\nat = ["p0_0_0", "p0_{n - 1}_0", "p{n - 1}_0_0"]\nfix = "all"\n'
    points = [f"p{i}_{j}_{k}" for i, j, k in cells if (i + j + k) % 2] if pushed else ["p3_3_3"]
    return 6 * (n**3 - 1), text + f"[[loads]]\nat = [{names(points)}]\nforce = [2e5, -3e5, 4e5]\n"


def plane_frame():
    nx, ny, elements = 32, 33, 4
    text = head(5e-6) + ELASTIC + TUBE + "[environment]\ngravity = [0.3, -9.81, 0.0]\n[points]\n"
    text += "".join(f"p{i}_{j} = [{4.0 * i}, {3.0 * j}, 0.0]\n" for i in range(nx) for j in range(ny))
    normal = [0.0, 0.0, 1.0]
    text += "".join(beam(f"column{i}", [f"p{i}_{j}" for j in range(ny)], elements, normal) for i in range(nx))
    text += "".join(beam(f"row{j}", [f"p{i}_{j}" for i in range(nx)], elements, normal) for j in range(1, ny))
    text += f'[[supports]]\nat = [{names(f"p{i}_0" for i in range(nx))}]\nfix = "all"\n'
    return elements * (nx * (ny - 1) + (nx - 1) * (ny - 1)), text + '[[loads]]\nat = "p3_3"\nforce = [1e5, 2e5, 0.0]\n'


SCENES = {
    "shell, elastic": lambda: sheet(ELASTIC),
    "shell, five yielding layers": lambda: sheet(YIELDING, "layers = 5\n"),
    "beam in space, elastic": lambda: space_frame(ELASTIC, TUBE, False),
    "beam in a plane, elastic": plane_frame,
    "beam, 16 fibres that yield": lambda: space_frame(YIELDING, FIBRES, True),
}


def run(program, deck, out, threads):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [program, "run", deck, "-o", out, "--quiet", "--overwrite", "--threads", str(threads)]
    subprocess.run(command, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return processor, json.loads((out / "result.json").read_text())["timings"]["loop_s"]


def main():
    p = argparse.ArgumentParser()
    p.add_argument("programs", nargs="+")
    p.add_argument("--threads", default="1")
    p.add_argument("--runs", type=int, default=3)
    p.add_argument("--only", default="")
    a = p.parse_args()
    print("| scene | program | threads | processor, µs | loop, µs |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name, scene in SCENES.items():
            if a.only not in name:
                continue
            elements, text = scene()
            deck = folder / "deck.toml"
            deck.write_text(text)
            cases = [(program, int(threads)) for program in a.programs for threads in a.threads.split(",")]
            least = {case: (math.inf, math.inf) for case in cases}
            for case in cases * a.runs:
                found = run(case[0], deck, folder / "out", case[1])
                least[case] = tuple(map(min, least[case], found))
            for (program, threads), seconds in least.items():
                processor, loop = (f"{1e6 * s / elements / EVALUATIONS:.3f}" for s in seconds)
                print(f"| {name} | {pathlib.Path(program).name} | {threads} | {processor} | {loop} |", flush=True)


if __name__ == "__main__":
    main()
