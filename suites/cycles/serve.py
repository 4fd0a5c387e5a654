"""Pictures by Cycles, as long as Assay's plugin `process` asks for them; started by serve.sh.

Blender takes a second to start and some hundredths of a second for a small picture.
"""

import array
import os
import pathlib
import struct
import sys
import tempfile

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import scene  # noqa: E402

PRIME = 2**31 - 1


def seed_of(key, index):
    """From 1 on, in 31 bits, another for each index: as the plugin `command` has it."""
    return 1 + 630360016 * ((key + index) % PRIME) % PRIME


def picture(file, seed, samples):
    """Red, green and blue of each pixel, row by row from the top, then their average, as bytes of doubles."""
    scene.render_to(file, seed, samples)
    image = bpy.data.images.load(file)
    texels = array.array("f", bytes(4 * len(image.pixels)))
    image.pixels.foreach_get(texels)
    bpy.data.images.remove(image)
    os.remove(file)
    values = array.array("d", [
        texels[4 * (row * scene.WIDTH + column) + component]
        for row in reversed(range(scene.HEIGHT))  # Blender's first row is the lowest
        for column in range(scene.WIDTH)
        for component in range(3)])
    values.append(sum(values) / len(values))
    return values.tobytes()


def serve(questions, replies, file):
    replies.write(f"assay 1 binary\nimage {scene.WIDTH} {scene.HEIGHT} R G B\n"
                  "channel average diagnostic\nready\n".encode())
    replies.flush()
    while question := questions.read(32):
        key, first, count, samples = struct.unpack("<4Q", question)
        for index in range(first, first + count):
            replies.write(picture(file, seed_of(key, index), samples))
        replies.write(question)
        replies.flush()


try:
    scene.set_up(scene.read_settings(sys.argv[sys.argv.index("--") + 1:]))
    with tempfile.TemporaryDirectory() as folder, open(3, "wb") as out:
        serve(sys.stdin.buffer, out, f"{folder}/picture.exr")
except Exception as error:  # Blender itself would end with status 0
    print(error, file=sys.stderr)
    sys.exit(1)
