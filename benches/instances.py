"""Ten thousand bunnies as instances, in both orders and in Embree's two-level hierarchy, side by side.

    python3 benches/instances.py            # needs ../shared/peers, ../shared/meshes, g++ and libembree-dev

The scene is a grid of instances of one mesh, seen from near its edge and from above. Rounds alternate between ours and
Embree: for ours `visibility_ms` of the report, for Embree making the rays, tracing them and storing ids, with the fastest of its modes, and
the fastest of its watertight ones. Let nothing else run on the machine meanwhile.
"""

import argparse
import json
import statistics
import subprocess
import tempfile
from pathlib import Path

from peers import BUILD, ROOT, build_ours

SHARED = ROOT.parent / "shared"
# Where the eye is and what it looks at, in lengths of a side of the mesh's box.
VIEWS = {"from near its edge": ([0, 3, 70], [0, 0, 20]), "from above": ([0, 90, 60], [0, 0, 10])}
IMAGE = [1920, 1080]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mesh", default="stanford-bunny", help="a mesh of ../shared/meshes")
    parser.add_argument("--side", type=int, default=100, help="instances along each side of the grid")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--frames", type=int, default=9, help="timed frames in a round")
    options = parser.parse_args()
    mesh = SHARED / "meshes" / f"{options.mesh}.obj"
    if not mesh.exists() or not (SHARED / "peers").is_dir():
        print("skipped: ../shared has no such mesh, or no peers")
        return
    ours, _ = build_ours(without_fill=True)
    theirs, mkmesh = build_theirs("embree_instances", "embree3"), build_theirs("mkmesh", None)
    spacing = 1.2 * longest_side(mesh)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        subprocess.run([mkmesh, mesh, folder / "mesh.tri"], check=True, stdout=subprocess.DEVNULL)
        (folder / "mesh.obj").write_bytes(mesh.read_bytes())
        for name, (eye, at) in VIEWS.items():
            eye, at = ([spacing * number for number in place] for place in (eye, at))
            scene = folder / "scene.toml"
            scene.write_text(scene_file(eye, at, spacing, options.side))
            rounds = [
                (trace_ours(ours, scene, folder, options), trace_theirs(theirs, folder, eye, at, spacing, options))
                for _ in range(options.rounds)
            ]
            show(name, rounds, options)


def build_theirs(name, library):
    """Builds a program of the peers, or one beside this file."""
    own = ROOT / "benches" / f"{name}.cpp"
    source = own if own.exists() else SHARED / "peers" / f"{name}.cpp"
    program = BUILD / name
    BUILD.mkdir(parents=True, exist_ok=True)
    flags = ["-O3", "-march=native", "-mprefer-vector-width=512", "-fopenmp-simd", "-std=c++17", f"-I{SHARED / 'peers'}"]
    libraries = [f"-l{library}", "-lpthread"] if library else []
    subprocess.run(["g++", *flags, "-o", program, source, *libraries], check=True)
    return program


def longest_side(mesh):
    """The longest side of the box of an OBJ file's vertices."""
    lines = (line.split() for line in mesh.read_text().splitlines() if line.startswith("v "))
    vertices = [[float(number) for number in line[1:4]] for line in lines]
    return max(max(axis) - min(axis) for axis in zip(*vertices))


def scene_file(eye, at, spacing, side):
    return f"""
[camera]
eye = {eye}
look_at = {at}
distance = 1
viewport = [{IMAGE[0] / IMAGE[1]}, 1]
image = {IMAGE}
[[object]]
mesh = "mesh.obj"
instances = {{ grid = {{ count = [{side}, 1, {side}], spacing = {spacing} }} }}
"""


def trace_ours(program, scene, folder, options):
    """Milliseconds of each order, and the pixels that are covered."""
    out = folder / "out"
    words = [program, scene, "--only", "report", "--quiet", "--threads", "2", "--repeat", str(options.frames), "-o", out]
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    report = json.loads((out / "report.json").read_text())
    times = {order: report[f"{order}_order"]["visibility_ms"]["median"] for order in ("object", "image")}
    return times | {"covered": report["coverage"]["object_order"]}


def trace_theirs(program, folder, eye, at, spacing, options):
    """Milliseconds of Embree's fastest mode, and of the fastest watertight one; and the pixels that are covered."""
    numbers = [options.frames, options.side, options.side, spacing, *eye, *at, 1, "x".join(map(str, IMAGE))]
    words = [program, folder / "mesh.tri", *map(str, numbers)]
    said = subprocess.run(words, check=True, capture_output=True, text=True).stdout
    lines = [line.split("|") for line in said.splitlines() if line.startswith("trace|")]
    best = {
        kind: min(float(line[3].split()[1]) for line in lines if line[1] == kind) for kind in ("fast", "robust")
    }
    return best | {"covered": int(lines[0][5].split()[1])}


def show(name, rounds, options):
    def middle(side, key):
        return statistics.median(one[side][key] for one in rounds)

    print(f"{options.side * options.side} instances of {options.mesh}, {name}, {IMAGE[0]} x {IMAGE[1]}, 2 threads:")
    print(f"  covered: ours {middle(0, 'covered'):.0f}, Embree {middle(1, 'covered'):.0f} pixels")
    print(f"  object order {middle(0, 'object'):.1f} ms, image order {middle(0, 'image'):.1f} ms")
    for kind, words in (("fast", "Embree, its fastest mode"), ("robust", "the fastest watertight one")):
        ratio = middle(1, kind) / middle(0, "image")
        print(f"  {words} {middle(1, kind):.1f} ms: {ratio:.2f} times image order")


if __name__ == "__main__":
    main()
