"""How fast dat2glb is beside others and beside the machine itself, as a table of ratios.

    python3 bench/run.py            # prints the table
    python3 bench/run.py --write    # also puts it into docs/performance.md

Builds the profile `dist`, makes a clip of 1,000,000 rows of 4 boxes, installs the others into .tools
(PyPI: polars, scipy, f3d; npm: gltf-transform, gltfpack, the Khronos validator) and runs every
comparison in turns, so that a slow moment of the machine meets both sides. Figures are medians;
only ratios carry over to another machine. Output files are new ones each time.
"""

import json
import os
import pathlib
import re
import statistics
import struct
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PEERS = ROOT / ".tools/peers"
PYTHON = PEERS / "python/bin/python"
NODE = PEERS / "npm/node_modules"
TOOL = ROOT / "target/dist/dat2glb"
EXAMPLES = ROOT / "target/dist/examples"
PYPI = ["polars==2.1.0", "scipy==1.17.1", "numpy==2.4.6", "f3d==4.0.0", "matplotlib"]
NPM = ["@gltf-transform/cli@4.5.1", "gltfpack@1.3.0", "gltf-validator@2.0.0-dev.3.10"]
ROWS = 1_000_000
QUIET = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
RENDERED = {**os.environ, "NODEVICE_SELECT": "1"}


def install():
    if not PYTHON.exists():
        subprocess.run([sys.executable, "-m", "venv", PEERS / "python"], check=True)
    subprocess.run([PYTHON, "-m", "pip", "install", "-q", "--disable-pip-version-check", *PYPI], check=True)
    subprocess.run(["npm", "install", "--prefix", PEERS / "npm", "--no-audit", "--no-fund", "--loglevel=error", *NPM], check=True)
    subprocess.run(["cargo", "build", "--profile", "dist", "--bins", "--examples"], cwd=ROOT, check=True)


class Run:
    """What one command took: seconds from start to end, and the most memory, MB."""

    def __init__(self, command, env=None):
        command = [str(word) for word in command]
        # What the run before left to be written would be waited for in this one.
        os.sync()
        start = time.perf_counter()
        process = subprocess.Popen(command, env=env or RENDERED, **QUIET)
        _, status, usage = os.wait4(process.pid, 0)
        self.seconds = time.perf_counter() - start
        self.megabytes = usage.ru_maxrss / 1024
        if status:
            sys.exit(f"failed: {' '.join(command)}")


def in_turns(rounds, *commands):
    """Medians of seconds and of megabytes of every command, run in turns."""
    runs = [[] for _ in commands]
    for _ in range(rounds):
        for command, results in zip(commands, runs):
            results.append(command())
    return [
        (statistics.median(run.seconds for run in results), statistics.median(run.megabytes for run in results))
        for results in runs
    ]


class Table:
    def __init__(self):
        self.lines = []

    def add(self, what, ours, theirs, ratio, target, good, at_least=True):
        """`good` is the number that the ratio must reach, or must not exceed."""
        reached = ratio >= good if at_least else ratio <= good
        self.lines.append((what, ours, theirs, f"{ratio:.2f}" if ratio < 10 else f"{ratio:.0f}", target, "yes" if reached else "**no**"))
        print(" · ".join(self.lines[-1]), flush=True)

    def markdown(self):
        head = "| What | dat2glb | Beside it | Ratio | Target | Reached |\n|---|---|---|---|---|---|\n"
        return head + "".join(f"| {' | '.join(line)} |\n" for line in self.lines)


def seconds(x):
    return f"{x:.2f} s" if x >= 1 else f"{1000 * x:.1f} ms" if x < 0.1 else f"{1000 * x:.0f} ms"


class Bench:
    def __init__(self, folder):
        self.folder, self.table, self.count = pathlib.Path(folder), Table(), 0
        self.clip = self.folder / "long.dat"
        with open(self.clip, "wb") as file:
            subprocess.run([EXAMPLES / "long_clip", str(ROWS), "4"], stdout=file, check=True)

    def new(self, ending):
        """A name that no file has; what the last comparison wrote is gone."""
        self.count += 1
        return self.folder / f"out-{self.count}{ending}"

    def clear(self):
        for path in self.folder.glob("out-*"):
            path.unlink()

    def convert(self, *options, clip=None, fps="60"):
        return lambda: Run([TOOL, "convert", clip or self.clip, "-o", self.new(".glb"), "-q", "--no-key-times", "--fps", fps, *options])

    def floor(self, what, path, env=None):
        command = [EXAMPLES / "floors", what, path]
        os.sync()
        return float(subprocess.run(command, check=True, capture_output=True, text=True, env=env).stdout)

    def python(self, kind):
        return lambda: Run([PYTHON, ROOT / "bench/peers/convert.py", kind, self.clip, self.new(".glb")])

    def against_python(self, scheme, kind, rounds, faster, smaller):
        (ours, memory), (theirs, their_memory) = in_turns(rounds, self.convert("--scheme", scheme, "--no-bound"), self.python(kind))
        self.clear()
        name = {"slerp": "polars, scipy Slerp", "spline": "polars, scipy RotationSpline"}[kind]
        self.table.add(f"convert, {scheme}, `--no-bound`", seconds(ours), f"{seconds(theirs)} ({name})", theirs / ours, f"≥ {faster}", faster)
        self.table.add("its memory", f"{memory:.0f} MB", f"{their_memory:.0f} MB", their_memory / memory, f"≥ {smaller}", smaller)

    def against_floors(self, rounds):
        subprocess.run([str(TOOL), "convert", self.clip, "-o", self.folder / "long.glb", "-q", "--no-key-times", "--fps", "60", "--scheme", "slerp"], check=True)
        ours, floors = [], []
        for _ in range(rounds):
            ours.append(self.convert("--scheme", "slerp", "--no-bound")().seconds)
            floors.append([self.floor("read", self.clip), self.floor("parse", self.clip), self.floor("write", self.folder / "long.glb")])
            self.clear()
        parts = [statistics.median(column) for column in zip(*floors)]
        ours, floor = statistics.median(ours), sum(parts)
        said = " + ".join(seconds(part) for part in parts)
        self.table.add("convert, slerp, `--no-bound`", seconds(ours), f"{seconds(floor)} (read + parse + write: {said})", ours / floor, "≤ 1.3", 1.3, at_least=False)

    def parsing(self, rounds):
        one = {**os.environ, "RAYON_NUM_THREADS": "1"}
        runs = [(self.floor("numbers", self.clip), self.floor("keyframes", self.clip, one), self.floor("parse", self.clip), self.floor("skipping", self.clip)) for _ in range(rounds)]
        numbers, keyframes, bare, skipping = (statistics.median(column) for column in zip(*runs))
        self.table.add("parse all numbers, one core", seconds(numbers), f"{seconds(bare)} (bare fast-float2 loop)", numbers / bare, "≤ 1", 1, at_least=False)
        self.table.add("parse all numbers, one core", seconds(numbers), f"{seconds(skipping)} (the same, tried at no blank)", numbers / skipping, "≤ 1", 1, at_least=False)
        self.table.add("parse to checked keys and hash, one core", seconds(keyframes), f"{seconds(bare)} (bare fast-float2 loop)", keyframes / bare, "≤ 1", 1, at_least=False)

    def bound(self, scheme, rounds):
        (with_bound, _), (without, _) = in_turns(rounds, self.convert("--scheme", scheme), self.convert("--scheme", scheme, "--no-bound"))
        self.clear()
        self.table.add(f"convert, {scheme}, with the proven bound", seconds(with_bound), f"{seconds(without)} (`--no-bound`)", with_bound / without, "≤ 2", 2, at_least=False)

    def memory(self):
        run = self.convert("--scheme", "slerp", "--no-bound")()
        keys = ROWS * (4 * 32 + 8) / 2**20
        self.table.add("memory beyond the keys, 1,000,000 rows", f"{run.megabytes - keys:.0f} MB", f"{keys:.0f} MB of keys", run.megabytes - keys, "≤ 64 MB", 64, at_least=False)
        short = self.folder / "ten-minutes.dat"
        with open(short, "wb") as file:
            subprocess.run([EXAMPLES / "long_clip", "36000", "4"], stdout=file, check=True)
        run = self.convert("--scheme", "bessel", clip=short, fps="10000")()
        keys = 36000 * (4 * 32 + 8) / 2**20
        size = next(self.folder.glob(f"out-{self.count}.glb")).stat().st_size / 1e6
        self.clear()
        self.table.add("memory beyond the keys, ten minutes at 10 kHz", f"{run.megabytes - keys:.0f} MB", f"{size:.0f} MB written", run.megabytes - keys, "≤ 64 MB", 64, at_least=False)

    def checking(self, rounds):
        file = self.folder / "long.glb"
        validate = "const {readFileSync} = require('fs'); require(process.argv[1]).validateBytes(new Uint8Array(readFileSync(process.argv[2])))"
        (ours, _), (theirs, _) = in_turns(
            rounds,
            lambda: Run([TOOL, "check", "-q", file]),
            lambda: Run(["node", "-e", validate, NODE / "gltf-validator", file]),
        )
        self.table.add("check of 68 MB", seconds(ours), f"{seconds(theirs)} (Khronos validator)", theirs / ours, "≥ 13", 13)

    def reducing(self, rounds):
        file = self.folder / "long.glb"
        (ours, memory), (theirs, their_memory) = in_turns(
            rounds,
            lambda: Run([TOOL, "reduce", file, "-o", self.new(".glb"), "-q", "--tolerance", "0.1"]),
            lambda: Run(["node", NODE / ".bin/gltf-transform", "resample", file, self.new("-resampled.glb")]),
        )
        self.table.add("reduce 4 × 1,000,000 keys to 0.1°", f"{seconds(ours)}, {memory:.0f} MB", f"{seconds(theirs)}, {their_memory:.0f} MB (gltf-transform resample)", theirs / ours, "≥ 3", 3)
        packed = self.new("-packed.glb")
        subprocess.run([NODE / ".bin/gltfpack", "-i", file, "-o", packed, "-kn"], check=True, **QUIET)
        reduced = next(self.folder.glob("out-*[0-9].glb"))
        ours, theirs = keys(reduced), keys(packed)
        self.table.add("its keys", f"{ours:,}", f"{theirs:,} (gltfpack)", theirs / ours, "> 1", 1)
        self.table.add("its size", f"{reduced.stat().st_size / 1e6:.1f} MB", f"{file.stat().st_size / 1e6:.1f} MB (input)", reduced.stat().st_size / file.stat().st_size, "≤ 1", 1, at_least=False)
        self.clear()

    def drawing(self, rounds):
        chain = self.folder / "chain.glb"
        subprocess.run([TOOL, "convert", ROOT / "fixtures/keyframes/chain-even.dat", "-o", chain, "-q"], check=True)
        draw = lambda *options: lambda: Run([TOOL, "thumbnail", chain, "-o", self.new(".png"), "-q", *options])
        f3d = lambda *frames: lambda: Run([PYTHON, ROOT / "bench/peers/pictures.py", chain, self.new(".png"), "10", *frames])
        (ours, _), (theirs, _) = in_turns(rounds, draw("--renderer", "cpu"), f3d())
        self.table.add("thumbnail, in software", seconds(ours), f"{seconds(theirs)} (f3d)", theirs / ours, "≥ 20", 20)
        (ours, _), (theirs, _) = in_turns(rounds, draw("--renderer", "cpu", "--sheet", "4x4"), f3d("16"))
        self.table.add("sheet of 16 cells, in software", seconds(ours), f"{seconds(theirs)} (f3d, 16 frames)", theirs / ours, "≥ 9", 9)
        (ours, _), (theirs, _) = in_turns(rounds, draw("--renderer", "wgpu"), lambda: Run([EXAMPLES / "adapter"]))
        self.table.add("thumbnail, wgpu", seconds(ours), f"{seconds(theirs)} (the adapter's start and four plain boxes)", ours / theirs, "≤ 1.2", 1.2, at_least=False)
        self.clear()

    def starting(self, rounds):
        small = ROOT / "fixtures/keyframes/chain-even.dat"
        (version, _), (convert, _), (empty, _) = in_turns(
            rounds,
            lambda: Run([TOOL, "--version"]),
            lambda: Run([TOOL, "convert", small, "-o", self.new(".glb"), "-q"]),
            lambda: Run(["true"]),
        )
        self.clear()
        self.table.add("`--version`, beyond an empty program", seconds(version - empty), seconds(empty), 1000 * (version - empty), "≤ 2 ms", 2, at_least=False)
        self.table.add("convert 26 rows, beyond an empty program", seconds(convert - empty), seconds(empty), 1000 * (convert - empty), "≤ 8 ms", 8, at_least=False)

    def curves(self):
        said = subprocess.run(["cargo", "bench", "--profile", "dist", "--bench", "stages", "--", "curve_at_all"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
        per, scheme = None, None
        for line in said.splitlines():
            if name := re.search(r"[├╰]─ ([a-z0-9-]+)", line):
                per, scheme = (name[1], scheme) if name[1].isdigit() else (per, name[1])
            rates = re.findall(r"([\d.]+) ([MG])item/s", line)
            if rates and per in ("1", "10"):
                rate = float(rates[2][0]) * (1000 if rates[2][1] == "G" else 1)
                least = 20 if scheme == "slerp" else 12
                self.table.add(f"curve, {scheme}, {per} a segment, one core", f"{rate:.1f} M/s", "–", rate, f"≥ {least} M/s", least)


def keys(path):
    """Keys of all channels of a .glb."""
    data = path.read_bytes()
    document = json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])
    return sum(
        document["accessors"][animation["samplers"][channel["sampler"]]["input"]]["count"]
        for animation in document["animations"]
        for channel in animation["channels"]
    )


def main():
    install()
    rounds = 5
    with tempfile.TemporaryDirectory(dir=ROOT / "target") as folder:
        bench = Bench(folder)
        bench.against_floors(3 * rounds)
        bench.against_python("slerp", "slerp", rounds, 15, 4)
        bench.against_python("bessel-overhauser", "spline", 3, 40, 10)
        bench.bound("slerp", rounds)
        bench.bound("bessel-overhauser", rounds)
        bench.parsing(rounds)
        bench.memory()
        bench.checking(rounds)
        bench.reducing(3)
        bench.drawing(2 * rounds)
        bench.starting(4 * rounds)
        bench.curves()
    if "--write" in sys.argv[1:]:
        page = ROOT / "docs/performance.md"
        begin, end = "<!-- table -->\n", "<!-- end of table -->"
        head, _, rest = page.read_text().partition(begin)
        page.write_text(head + begin + bench.table.markdown() + end + rest.partition(end)[2])


if __name__ == "__main__":
    main()
