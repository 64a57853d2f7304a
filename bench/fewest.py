"""How many keys this program and other optimisers need for the same error.

    cargo build --profile dist && python3 bench/fewest.py

Two clips of four boxes with 25 keys over 20 s, steps up to 150 degrees, keys even and uneven
in time. dat2glb makes its file from the keys. The others get an export at 480 frames a second
and reduce it; each one's setting is varied until the deviation from the true curve that
`dat2glb check` measures in its file is within the tolerance by as few keys as can be. Installs
the others from npm into .tools (gltf-transform's resample, gltfpack's fixed rates, which always
writes rotations as 16-bit numbers).
"""

import json
import math
import pathlib
import random
import struct
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
TOOL = ROOT / "target/dist/dat2glb"
PEERS = ["@gltf-transform/cli@4.5.1", "gltfpack@1.3.0"]
TOLERANCES = [0.1, 0.01, 0.001]


def run(*words):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def multiplied(a, b):
    w, x, y, z = a
    p, q, r, s = b
    return (w * p - x * q - y * r - z * s, w * q + x * p + y * s - z * r,
            w * r - x * s + y * p + z * q, w * s + x * r - y * q + z * p)


def clip(path, even, seed):
    """Writes keys: each box turns from key to key about any axis by up to 150 degrees."""
    chance = random.Random(seed)
    steps = [1.0 if even else 0.3 + 1.4 * chance.random() for _ in range(24)]
    times = [20 * sum(steps[:i]) / sum(steps) for i in range(25)]
    boxes = [(1.0, 0.0, 0.0, 0.0)] * 4
    rows = ["# 4 2.5"]
    for time in times:
        turned = []
        for box in boxes:
            axis = [chance.gauss(0, 1) for _ in range(3)]
            half = math.radians(75) * chance.random()
            scale = math.sin(half) / math.hypot(*axis)
            turned.append(multiplied(box, (math.cos(half), *(scale * x for x in axis))))
        rows.append(" ".join(f"{x:.17g}" for x in [time, *sum(turned, ())]))
        boxes = turned
    path.write_text("\n".join(rows) + "\n")


def keys(path):
    """Keys of all channels of a .glb."""
    data = path.read_bytes()
    document = json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])
    animation = document["animations"][0]
    inputs = [animation["samplers"][channel["sampler"]]["input"] for channel in animation["channels"]]
    return sum(document["accessors"][accessor]["count"] for accessor in inputs)


def error(path, source):
    """The largest deviation from the curve, degrees, as the file is played."""
    words = [TOOL, "check", path, "--against", source, "--scheme", "bessel", "--ends", "natural",
             "--max-error", "179", "--json"]
    report = json.loads(subprocess.run([str(word) for word in words], capture_output=True).stdout)
    figures = [box[kind]["off"] for clip in report["motion"] for box in clip["boxes"]
               for kind in ("keys", "samples", "between")]
    return max(figures)


def fewest(make, settings, source, folder):
    """For each tolerance the fewest keys of all settings that keep it."""
    best = {}
    for setting in settings:
        output = folder / "peer.glb"
        make(setting, output)
        off, count = error(output, source), keys(output)
        for tolerance in TOLERANCES:
            if off <= tolerance:
                best[tolerance] = min(best.get(tolerance, count), count)
    return best


def main():
    tools = ROOT / ".tools"
    run("npm", "install", "--prefix", tools, "--no-audit", "--no-fund", "--loglevel=error", *PEERS)
    binaries = tools / "node_modules/.bin"
    print("| Keys in | Tolerance | dat2glb | cubicspline | gltf-transform | gltfpack | ours / transform | ours / gltfpack |")
    print("|---|--:|--:|--:|--:|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        source, dense = folder / "clip.dat", folder / "dense.glb"
        for even in (True, False):
            clip(source, even, 7)
            run(TOOL, source, dense, "--fps", "480")
            transform = fewest(
                lambda x, out: run(binaries / "gltf-transform", "resample", dense, out, "--tolerance", x),
                [10 ** (-k / 4) for k in range(8, 33)], source, folder)
            packed = fewest(
                lambda x, out: run(binaries / "gltfpack", "-i", dense, "-o", out, "-noq", "-kn", "-af", x),
                [15, 20, 24, 30, 40, 48, 60, 80, 100, 120, 160, 200, 240], source, folder)
            for tolerance in TOLERANCES:
                counts = []
                for more in ([], ["--interpolation", "cubicspline"]):
                    run(TOOL, source, folder / "ours.glb", "--tolerance", tolerance, *more)
                    assert error(folder / "ours.glb", source) <= tolerance
                    counts.append(keys(folder / "ours.glb"))
                peers = [transform.get(tolerance), packed.get(tolerance)]
                ratios = [f"{counts[0] / peer:.2f}" if peer else "" for peer in peers]
                cells = ["even" if even else "uneven", f"{tolerance}°", *counts, *(peer or "–" for peer in peers), *ratios]
                print("| " + " | ".join(map(str, cells)) + " |", flush=True)


if __name__ == "__main__":
    main()
