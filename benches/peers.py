#!/usr/bin/env python3
"""Both orders against the strongest existing renderers, side by side: ratios for docs/performance.md.

    python3 benches/peers.py                        # every mesh; about 20 minutes
    python3 benches/peers.py --meshes stanford-bunny sphere:501x1000 --repeats 9 --rounds 5
    python3 benches/peers.py --markdown             # the same, and the table into docs/performance.md

Our object order runs against Mesa llvmpipe, our image order against Intel Embree, each on the same mesh from
the same camera. ../shared/peers says how, and what its programs time. A picture in colour runs against llvmpipe with the
same lights in its fragment shader (gl_shaded.cpp). Rounds alternate between ours and
theirs, so that changes of the machine's speed affect both. A ratio is their time over ours: above 1, ours is
faster. Where perf counts, a table says what a ray of image order executes and fetches. The tables give the median of the rounds, and the time to clear the id and distance buffers. Let
nothing else run on the machine. The README of the peers lists what they need; a message names each peer that
is missing, and the tables leave it out.
"""
import argparse
import json
import os
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "target/peers"
PAGE = ROOT / "docs/performance.md"
BEGIN, END = "<!-- peers.py writes from here -->", "<!-- to here -->"

# Generated meshes, in the notation of mkmesh.
GENERATED = ["sphere:51x100", "sphere:501x1000", "sphere:1415x2828", "soup:100000"]
# The summary against llvmpipe is over meshes of at least so many triangles.
MANY = 50_000
# A mesh of at least so many triangles takes each process seconds to load, so that one round must do.
LARGE = 4_000_000
# What perf counts of image order: the instructions of the program, and lines of memory that come into the first cache and
# into the last one. A line has so many bytes.
EVENTS = {"instructions": "instructions:u", "cached": "L1-dcache-load-misses:u", "memory": "cache-misses:u"}
LINE = 64
# Frames of a short run: what a longer one counts beyond it belongs to the frames that it has more.
FEW = 2


def main():
    options = arguments()
    try:
        results = measure(options)
    except subprocess.CalledProcessError as error:
        words = " ".join(map(str, error.cmd))
        fail(f"{words}\nended with {error.returncode}: {(error.stderr or '').strip()[-2000:]}")
    except OSError as error:
        fail(error)
    tables = markdown(results)
    print(tables)
    write(BUILD / "peers.json", json.dumps(results, indent=2) + "\n")
    if options.markdown:
        page = PAGE.read_text(encoding="utf-8")
        before, _, rest = page.partition(BEGIN)
        _, _, after = rest.partition(END)
        write(PAGE, f"{before}{BEGIN}\n\n{tables}\n{END}{after}")


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0], epilog="JSON goes to target/peers/peers.json."
    )
    option = parser.add_argument
    option("--meshes", nargs="+", metavar="MESH",
           help="names of ../shared/meshes, OBJ files, sphere:LATxLON or soup:N; all if not given")
    option("--sizes", nargs="+", metavar="WxH", type=size, default=["1920x1080"])
    option("--threads", metavar="N", type=whole, default=2)
    option("--repeats", metavar="N", type=whole, default=9, help="timed frames a process")
    option("--rounds", metavar="N", type=whole, default=3, help="processes of each, alternating")
    option("--shared", metavar="FOLDER", type=Path, default=ROOT / "../shared",
           help="where peers and meshes are, if not in ../shared")
    option("--order", choices=["both", "object", "image"], default="both")
    option("--without-fill", action="store_true",
           help="leave the memory fill out: its bench alone compiles all packages once more")
    option("--markdown", action="store_true", help="also write the tables into docs/performance.md")
    return parser.parse_args()


def whole(text):
    if not text.isascii() or not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text} is not a whole number from 1")
    return int(text)


def size(text):
    if not re.fullmatch(r"[1-9]\d{0,4}x[1-9]\d{0,4}", text):
        raise argparse.ArgumentTypeError(f"{text} is not a size; write it like 1920x1080")
    return text


def fail(text):
    say(text)
    sys.exit(2)


def say(text):
    print(text, file=sys.stderr, flush=True)


def run(*words, **more):
    """Runs a program and returns its output."""
    done = subprocess.run([*map(str, words)], check=True, capture_output=True, text=True, **more)
    return done.stdout


def write(path, text):
    """Writes a file under a temporary name, then renames it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(path.name + ".partial")
    partial.write_text(text, encoding="utf-8")
    partial.replace(path)


def measure(options):
    if options.markdown and BEGIN not in PAGE.read_text(encoding="utf-8"):
        fail(f"{PAGE} has no line {BEGIN!r}: put it back where the table belongs")
    specs = list(meshes(options.meshes, options.shared / "meshes"))
    peers = build_peers(options.shared / "peers")
    if "mkmesh" not in peers:
        fail("nothing to draw: ../shared/peers and a C++ compiler make the scenes; get both")
    ours, fill = build_ours(options.without_fill)
    if options.threads != 2 and "embree" in peers and options.order != "object":
        say("Embree's program times 1 and 2 threads only")
    if options.order != "object" and not counted([sys.executable, "-c", ""]):
        say("perf counts no instructions here: what a ray takes is left out")
    rows = []
    with tempfile.TemporaryDirectory(prefix="bothways-peers-") as folder:
        for spec in specs:
            for image in options.sizes:
                rows.append(compare(spec, image, options, peers, ours, fill, Path(folder)))
                say(one_line(rows[-1]))
    return {
        "machine": f"{platform.system()} {platform.machine()}, {processor()}, {os.cpu_count()} cores",
        "commit": commit(),
        "date": run("date", "+%F").strip(),
        "threads": options.threads,
        "repeats": options.repeats,
        "rounds": options.rounds,
        "rows": rows,
    }


def meshes(named, folder):
    """The OBJ files and generated meshes to draw."""
    if not named:
        named = [str(path) for path in sorted(folder.glob("*.obj"))]
        if not named:
            say(f"{folder} has no meshes: generated ones alone")
        named += GENERATED
    for name in named:
        if re.fullmatch(r"sphere:\d+x\d+|soup:\d+", name):
            yield name
            continue
        candidates = [Path(name), folder / f"{name}.obj"]
        found = [path for path in candidates if path.suffix == ".obj" and path.is_file()]
        if not found:
            kinds = "an OBJ file, a name of ../shared/meshes, sphere:LATxLON or soup:N"
            fail(f"there is no mesh {name}: give {kinds}")
        yield str(found[0].resolve())


# --- building ---------------------------------------------------------------------------------------


def build_peers(folder):
    """Builds the peers into target/peers, and returns the programs by name. A message names each that is missing."""
    if not folder.is_dir():
        say(f"{folder} is absent: no peers")
        return {}
    compiler = shutil.which("g++")
    if not compiler:
        say("no g++: no peers")
        return {}
    flags = ["-O3", "-march=native", "-mprefer-vector-width=512", "-fopenmp-simd", "-std=c++17"]
    gl, mesa = ["-lEGL", "-lGL"], "llvmpipe (libegl-dev libgl-dev libgl1-mesa-dri)"
    sources = {
        "mkmesh": (folder / "mkmesh.cpp", [], "meshes"),
        "llvmpipe": (folder / "gl_raster.cpp", gl, mesa),
        "llvmpipe_lit": (ROOT / "benches/gl_shaded.cpp", [f"-I{folder}", *gl], mesa),
        "embree": (folder / "embree_primary.cpp", ["-lembree3", "-lpthread"], "Embree (libembree-dev libtbb-dev)"),
    }
    BUILD.mkdir(parents=True, exist_ok=True)
    programs = {}
    for name, (source, libraries, what) in sources.items():
        program = BUILD / name
        newest = max(path.stat().st_mtime for path in [source, *folder.glob("*.*")])
        if not program.exists() or program.stat().st_mtime < newest:
            say(f"building {name}")
            built = subprocess.run(
                [compiler, *flags, "-o", str(program), str(source), *libraries],
                capture_output=True, text=True,
            )
            if built.returncode != 0:
                say(f"left out, for it does not build here: {what}\n{built.stderr.strip()[:300]}")
                continue
        programs[name] = program
    return programs


def build_ours(without_fill):
    """Builds our program and, if it is wanted, the bench `memory_fill`, and returns their paths."""
    say("building ours")
    ours = built("bothways", "build", "--release", "--bin", "bothways")
    if without_fill:
        return ours, None
    return ours, built("memory_fill", "bench", "--no-run", "--bench", "memory_fill")


def built(name, *words):
    """Builds a program with Cargo, and returns its path."""
    messages = run("cargo", *words, "--locked", "--message-format", "json", cwd=ROOT).splitlines()
    messages = [json.loads(line) for line in messages if line.startswith("{")]
    made = [m["executable"] for m in messages if m.get("executable") and m["target"]["name"] == name]
    return made[0]


# --- measuring --------------------------------------------------------------------------------------


def compare(spec, image, options, peers, ours, fill, folder):
    """Times one mesh at one image size: every renderer in turn, round by round."""
    name = re.sub(r"[^\w-]", "_", Path(spec).stem if spec.endswith(".obj") else spec)
    say(f"{name}, {image}")
    scene = folder / f"{name}.toml"
    run(sys.executable, options.shared / "peers/scene.py", peers["mkmesh"], spec, name, image, folder)
    tri, lit = scene.with_suffix(".tri"), folder / f"{name}.lit.toml"
    lit.write_text(in_studio(ours, scene), encoding="utf-8")
    triangles = int.from_bytes(tri.read_bytes()[8:12], "little")
    times = {}

    def note(key, value):
        if value is not None:
            times.setdefault(key, []).append(value)

    for _ in range(options.rounds if triangles < LARGE else 1):
        report = {}
        if options.order != "image":
            report = ours_on(ours, "object", scene, options, folder)
            note("object", report["visibility_ms"]["median"])
            if "llvmpipe" in peers:
                note("llvmpipe", llvmpipe(peers["llvmpipe"], tri, image, options))
            for order in ("object", "image") if options.order == "both" else ("object",):
                shaded = ours_on(ours, order, lit, options, folder)
                note(f"{order}_shading", shaded["shading_ms"]["median"])
                note(f"{order}_lit", shaded["visibility_ms"]["median"] + shaded["shading_ms"]["median"])
            if "llvmpipe_lit" in peers:
                note("llvmpipe_lit", llvmpipe_lit(peers["llvmpipe_lit"], tri, image, options))
        if options.order != "object":
            report = ours_on(ours, "image", scene, options, folder)
            note("image", report["visibility_ms"]["median"])
            note("prepare", report["prepare_ms"]["median"])
            for key, value in a_ray(ours, scene, image, options, folder).items():
                note(key, value)
            if "embree" in peers and options.threads <= 2:
                for mode, value in embree(peers["embree"], tri, image, options).items():
                    note(mode, value)
        if fill is not None:
            note("fill", json.loads(run(fill, image, options.threads, options.repeats))["median"])
    for path in folder.glob(f"{name}.*"):
        path.unlink()
    return {"mesh": name, "triangles": triangles, "size": image, "ms": times}


def ours_on(program, order, scene, options, folder):
    """Our report for one order."""
    words = ["render", "--order", order, "--threads", options.threads, "--repeat", options.repeats]
    report = json.loads(run(program, *words, "--json", "-o", folder / "out", scene))
    return report[f"{order}_order"]


def a_ray(program, scene, image, options, folder):
    """What a frame of image order executes and fetches, for each of its rays: nothing of what is done once."""
    words = [program, "render", "--order", "image", "--threads", options.threads, "--only", "report"]
    runs = [[*words, "--repeat", frames, "-o", folder / "out", scene] for frames in (FEW, FEW + options.repeats)]
    few, many = map(counted, runs)
    width, height = map(int, image.split("x"))
    rays = width * height * options.repeats
    units = {"instructions": 1, "cached": LINE, "memory": LINE}
    return {f"{key}_a_ray": (many[key] - few[key]) * units[key] / rays for key in EVENTS if key in few and key in many}


def counted(words):
    """What perf counts of a program, as far as this machine counts it."""
    perf = shutil.which("perf")
    if not perf:
        return {}
    with tempfile.NamedTemporaryFile("r", suffix=".csv") as report:
        run(perf, "stat", "-x", ",", "-o", report.name, "-e", ",".join(EVENTS.values()), "--", *words)
        rows = [line.split(",") for line in report.read().splitlines()]
    # A count, its unit, its event; in place of the count, what says that there is none.
    counts = {row[2]: float(row[0]) for row in rows if len(row) > 2 and row[0].replace(".", "", 1).isdigit()}
    return {key: counts[event] for key, event in EVENTS.items() if event in counts}


def in_studio(program, scene):
    """The same scene in the light of a framed mesh file, which gl_shaded.cpp has, too."""
    triangle = scene.with_name("triangle.obj")
    triangle.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
    framed = run(program, "scenes", triangle.name, cwd=scene.parent)
    camera, _, _ = scene.read_text(encoding="utf-8").partition("\n[[object]]")
    studio = framed[framed.index("background"):].replace(triangle.name, scene.with_suffix(".obj").name)
    return f"{camera}{studio}"


def llvmpipe_on(options):
    """The environment in which OpenGL is llvmpipe."""
    # 1 is a thread besides that of the application; 0 is that of the application alone.
    threads = 0 if options.threads == 1 else options.threads
    chosen = {"LIBGL_ALWAYS_SOFTWARE": "1", "GALLIUM_DRIVER": "llvmpipe", "LP_NUM_THREADS": str(threads)}
    return {**os.environ, **chosen}


def llvmpipe_lit(program, tri, image, options):
    """The time of a picture in colour."""
    words = run(program, tri, options.repeats, image, env=llvmpipe_on(options)).split()
    return float(words[words.index("median") + 1])


def llvmpipe(program, tri, image, options):
    """The time of the faster of its two ways to write ids."""
    drawn = run(program, tri, "-", options.repeats, image, env=llvmpipe_on(options))
    lines = drawn.splitlines()
    lines = [line.split("|") for line in lines if "|primid|" in line or "|vid|" in line]
    return min(float(line[6].removeprefix("median ")) for line in lines)


def embree(program, tri, image, options):
    """The times of its fastest modes, watertight and not (m0 traces nothing), and of its builds."""
    best = {}
    for line in run(program, tri, "-", options.repeats, image).splitlines():
        fields = line.split("|")
        if fields[1] == "BUILD" and fields[5:7] == ["fast", f"{options.threads}T"]:
            time = fields[7].removeprefix("median ").removesuffix(" ms")
            best[f"build_{fields[4].lower()}"] = float(time)
        if len(fields) != 12 or fields[8] != f"{options.threads}T" or fields[5] == "m0":
            continue
        key = f"embree_{fields[3]}"
        best[key] = min(float(fields[9]), best.get(key, float("inf")))
    return best


def processor():
    try:
        names = re.findall(r"^model name\s*:\s*(.+)$", Path("/proc/cpuinfo").read_text(), re.MULTILINE)
    except OSError:
        names = []
    return names[0] if names else platform.processor() or "unknown processor"


def commit():
    try:
        changed = run("git", "status", "--porcelain", "--untracked-files=no", "--", "*.rs", cwd=ROOT)
        name = run("git", "rev-parse", "--short", "HEAD", cwd=ROOT).strip()
        return f"{name}, changed" if changed else name
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


# --- showing ----------------------------------------------------------------------------------------


def median(row, key):
    values = row["ms"].get(key)
    return statistics.median(values) if values else None


def ratio(row, theirs, ours):
    """Their time over ours, as the median of the rounds."""
    pairs = list(zip(row["ms"].get(theirs, []), row["ms"].get(ours, [])))
    return statistics.median(a / b for a, b in pairs) if pairs else None


def shown(value, digits=2):
    return "–" if value is None else f"{value:.{digits}f}"


def best_embree(row):
    """The row with Embree's best mode of each round, watertight or not."""
    pairs = zip(row["ms"].get("embree_fast", []), row["ms"].get("embree_robust", []))
    return {**row, "ms": {**row["ms"], "embree": [min(pair) for pair in pairs]}}


def one_line(row):
    parts = [f"{key} {shown(median(row, key))} ms" for key in row["ms"]]
    return f"  {row['triangles']} triangles: " + ", ".join(parts)


def markdown(results):
    rows = [best_embree(row) for row in results["rows"]]
    said = (
        f"{results['machine']}; {results['date']}, commit {results['commit']}; {results['threads']} threads, "
        f"{results['rounds']} alternating rounds of {results['repeats']} frames. Times in milliseconds; a "
        "ratio is theirs over ours, above 1 where ours is faster."
    )
    parts = [said]
    if any("object" in row["ms"] for row in rows):
        parts += object_order(rows)
    if any("image" in row["ms"] for row in rows):
        parts += image_order(rows)
    return "\n\n".join(parts) + "\n"


def object_order(rows):
    def cells(row):
        peer = ratio(row, "llvmpipe", "object")
        over = ratio(row, "object", "fill")
        times = [shown(median(row, key)) for key in ("object", "llvmpipe")]
        return [*times, shown(peer, 1), shown(median(row, "fill")), shown(over, 1)]

    yield table(["object order", "llvmpipe", "ratio", "memory fill", "ours over fill"], rows, cells)
    many = [row for row in rows if row["triangles"] >= MANY]
    yield from summary(f"From {MANY:,} triangles on, the", many, "llvmpipe", "object", 1)
    yield from shading(rows, many)


def shading(rows, many):
    """A picture in colour: shading beside visibility, and both together beside llvmpipe."""

    def cells(row):
        cells = []
        for order in ("object", "image"):
            cells += [shown(median(row, f"{order}_shading")), shown(ratio(row, f"{order}_shading", order))]
        times = [shown(median(row, key)) for key in ("object_lit", "llvmpipe_lit")]
        return [*cells, *times, shown(ratio(row, "llvmpipe_lit", "object_lit"), 1)]

    yield table(
        ["shading in object order", "over visibility", "in image order", "over visibility", "object order in colour",
         "llvmpipe in colour", "ratio"],
        rows, cells,
    )
    yield from summary(f"In colour, from {MANY:,} triangles on, the", many, "llvmpipe_lit", "object_lit", 1)


def image_order(rows):
    def cells(row):
        times = [median(row, key) for key in ("image", "embree", "embree_robust")]
        ratios = [ratio(row, key, "image") for key in ("embree", "embree_robust")]
        return [shown(value) for value in times + ratios]

    heads = ["image order", "Embree", "watertight", "ratio", "to watertight"]
    yield table(heads, rows, cells)
    yield from summary("The", rows, "embree", "image", 2)

    def builds(row):
        times = [median(row, key) for key in ("prepare", "build_high", "build_medium")]
        ratios = [ratio(row, key, "prepare") for key in ("build_high", "build_medium")]
        return [shown(value) for value in times + ratios]

    heads = ["prepare", "Embree, high", "medium", "ratio to high", "to medium"]
    yield table(heads, rows, builds)

    def rays(row):
        return [shown(median(row, f"{key}_a_ray"), 1) for key in EVENTS]

    if any(f"{key}_a_ray" in row["ms"] for row in rows for key in EVENTS):
        yield "What a ray of image order takes, by perf: instructions, and bytes that come from beyond the first cache and from memory."
        yield table(["instructions a ray", "bytes into the first cache", "bytes from memory"], rows, rays)


def summary(start, rows, theirs, ours, digits):
    ratios = [ratio(row, theirs, ours) for row in rows]
    ratios = [value for value in ratios if value is not None]
    if ratios:
        middle, least = (shown(value, digits) for value in (statistics.median(ratios), min(ratios)))
        yield f"{start} median ratio is {middle}, the least {least}."


def table(heads, rows, cells):
    lines = ["| " + " | ".join(["mesh", "triangles", "pixels", *heads]) + " |"]
    lines.append("|---" + "|--:" * (len(heads) + 2) + "|")
    for row in rows:
        line = [row["mesh"], f"{row['triangles']:,}", row["size"], *cells(row)]
        lines.append("| " + " | ".join(line) + " |")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
