"""Pictures of a .glb by f3d (PyPI), which needs no display: Mesa's software renderer by EGL.

    python3 bench/peers/pictures.py IN.glb OUT.png SECONDS [FRAMES]

One picture half way through the first animation, which takes so many seconds, or so many
evenly spaced ones in one process, each written as a PNG of 512 x 512 pixels.
"""

import sys

import f3d


def main(source, target, seconds, frames="1"):
    f3d.Engine.autoload_plugins()
    engine = f3d.Engine.create_egl()
    engine.window.size = 512, 512
    engine.scene.add(source)
    count = int(frames)
    for frame in range(count):
        engine.scene.animation.load_time(float(seconds) * (frame + 0.5) / count)
        picture = engine.window.render_to_image()
        picture.save(target if count == 1 else target.replace(".png", f"-{frame}.png"))


main(*sys.argv[1:])
