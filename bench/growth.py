"""How cost grows: seconds and memory of `dat2glb convert` over keys and over boxes, as a plot.

    cargo build --profile dist --bins --examples && python3 bench/run.py && python3 bench/growth.py

One box with 10^2 to 10^7 keys, and 2,000 keys of 1 to 500 boxes, by slerp and by bessel with
the proven bound, a sample a key. Draws docs/images/growth.png with matplotlib from the
environment that bench/run.py makes, and prints the figures.
"""

import pathlib
import subprocess
import sys
import tempfile

from run import EXAMPLES, PYTHON, ROOT, TOOL, Run, in_turns

KEYS = [10**n for n in range(2, 8)]
BOXES = [1, 5, 20, 100, 500]
ROWS_OF_BOXES = 2_000
SCHEMES = ["slerp", "bessel"]


def measure(folder, rows, boxes):
    clip = folder / "clip.dat"
    with open(clip, "wb") as file:
        subprocess.run([EXAMPLES / "long_clip", str(rows), str(boxes)], stdout=file, check=True)

    def convert(scheme):
        def run():
            out = folder / f"{scheme}.glb"
            out.unlink(missing_ok=True)
            return Run([TOOL, "convert", clip, "-o", out, "-q", "--no-key-times", "--fps", "60", "--scheme", scheme])

        return run

    rounds = 5 if rows * boxes < 10**6 else 3
    return in_turns(rounds, *[convert(scheme) for scheme in SCHEMES])


def main():
    if sys.executable != str(PYTHON) and "matplotlib" not in sys.modules:
        try:
            import matplotlib  # noqa: F401
        except ImportError:
            sys.exit(subprocess.run([PYTHON, __file__]).returncode)
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plot

    figure, axes = plot.subplots(1, 2, figsize=(10, 4.2), layout="constrained")
    with tempfile.TemporaryDirectory(dir=ROOT / "target") as folder:
        folder = pathlib.Path(folder)
        cases = [
            ("keys of one box", KEYS, lambda n: (n, 1)),
            (f"boxes of {ROWS_OF_BOXES:,} keys", BOXES, lambda n: (ROWS_OF_BOXES, n)),
        ]
        for axis, (label, sizes, clip) in zip(axes, cases):
            figures = []
            for size in sizes:
                figures.append(measure(folder, *clip(size)))
                print(label, size, *(f"{s}: {x:.4f} s {mb:.0f} MB" for s, (x, mb) in zip(SCHEMES, figures[-1])), flush=True)
            for i, scheme in enumerate(SCHEMES):
                axis.loglog(sizes, [row[i][0] for row in figures], "o-", label=f"{scheme}, seconds")
            total = sizes[-1]
            guide = [figures[-1][0][0] * size / total for size in sizes]
            axis.loglog(sizes, guide, ":", color="grey", label="in proportion")
            axis.set_xlabel(label)
            axis.set_ylabel("seconds")
            axis.grid(True, which="major", alpha=0.3)
            axis.legend(loc="upper left")
    target = ROOT / "docs/images/growth.png"
    figure.savefig(target, dpi=100)
    print(target)


if __name__ == "__main__":
    main()
