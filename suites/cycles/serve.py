"""Pictures by Cycles, as long as Assay's plugin `process` asks for them; started by serve.sh.

Blender takes a second to start and some hundredths of a second for a small picture.
"""

import array
import os
import pathlib
import sys
import tempfile

import bpy

here = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(here), str(here.parents[1] / "estimators/foreign/python")]
import assay  # noqa: E402
import scene  # noqa: E402


def picture(file, seed, samples):
    """Red, green and blue of each pixel, row by row from the top, and their average."""
    scene.render_to(file, seed, samples)
    image = bpy.data.images.load(file)
    texels = array.array("f", bytes(4 * len(image.pixels)))
    image.pixels.foreach_get(texels)
    bpy.data.images.remove(image)
    os.remove(file)
    values = [
        texels[4 * (row * scene.WIDTH + column) + component]
        for row in reversed(range(scene.HEIGHT))  # Blender's first row is the lowest
        for column in range(scene.WIDTH)
        for component in range(3)]
    return values, sum(values) / len(values)


try:
    scene.set_up(scene.read_settings(sys.argv[sys.argv.index("--") + 1:]))
    with tempfile.TemporaryDirectory() as folder:
        assay.serve(
            lambda rng, primaries: picture(f"{folder}/picture.exr", rng.render_seed, primaries),
            image=assay.Image(scene.WIDTH, scene.HEIGHT),
            channels=[assay.Channel("average", diagnostic=True)], arguments=[], output=3)
except Exception as error:  # Blender itself would end with status 0
    print(error, file=sys.stderr)
    sys.exit(1)
