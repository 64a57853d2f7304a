"""The same work as `dat2glb convert --no-key-times --fps 60` by the fastest parts Python has:
polars to parse, scipy to interpolate, numpy and struct to write.

    python3 bench/peers/convert.py slerp|spline IN.dat OUT.glb

The rotations are those of dat2glb's slerp, or of scipy's RotationSpline, at every sixtieth of
a second and at the last key, as float32 with continuous signs; the .glb passes the Khronos
validator. No error bound, no hierarchy beyond the chain of nodes, no message: only the motion.
"""

import json
import struct
import sys

import numpy as np
import polars as pl
from scipy.spatial.transform import Rotation, RotationSpline, Slerp

FPS = 60


def read(path):
    """Times and, for each box, quaternions x y z w."""
    with open(path, "rb") as file:
        boxes = int(file.readline().split()[1])
    table = pl.read_csv(
        path, separator=" ", has_header=False, skip_rows=1, schema=dict.fromkeys(map(str, range(1 + 4 * boxes)), pl.Float64)
    )
    times = table["0"].to_numpy()
    columns = lambda box: [str(4 * box + i) for i in (2, 3, 4, 1)]
    return times - times[0], lambda box: table.select(columns(box)).to_numpy(), boxes


def sampled(curve, times):
    samples = curve(times).as_quat().astype(np.float32)
    turned = np.cumprod(np.where(np.einsum("ij,ij->i", samples[1:], samples[:-1]) < 0, -1, 1))
    samples[1:] *= turned[:, None]
    return samples


def main(kind, source, target):
    times, keys, boxes = read(source)
    frames = np.append(np.arange(0, times[-1], 1 / FPS), times[-1]).astype(np.float32)
    at = np.minimum(frames.astype(np.float64), times[-1])
    curve = {"slerp": Slerp, "spline": RotationSpline}[kind]
    tracks = [sampled(curve(times, Rotation.from_quat(keys(box))), at) for box in range(boxes)]
    write(target, frames, tracks)


def write(target, frames, tracks):
    boxes, count = len(tracks), len(frames)
    views = [{"buffer": 0, "byteOffset": 0, "byteLength": 4 * count}]
    accessors = [{"bufferView": 0, "componentType": 5126, "count": count, "type": "SCALAR", "min": [0.0], "max": [float(frames[-1])]}]
    for box in range(boxes):
        views.append({"buffer": 0, "byteOffset": 4 * count + 16 * count * box, "byteLength": 16 * count})
        accessors.append({"bufferView": box + 1, "componentType": 5126, "count": count, "type": "VEC4"})
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": f"box{box + 1}", **({"children": [box + 1]} if box + 1 < boxes else {})} for box in range(boxes)],
        "animations": [{
            "samplers": [{"input": 0, "output": box + 1} for box in range(boxes)],
            "channels": [{"sampler": box, "target": {"node": box, "path": "rotation"}} for box in range(boxes)],
        }],
        "buffers": [{"byteLength": 4 * count + 16 * count * boxes}],
        "bufferViews": views,
        "accessors": accessors,
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    length = document["buffers"][0]["byteLength"]
    with open(target, "wb") as file:
        file.write(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + length, len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", length, 0x004E4942))
        file.write(frames.data)
        for track in tracks:
            file.write(track.data)


main(*sys.argv[1:])
