"""Pictures by Cycles, one for each seed, for Assay's plugin `command`.

    blender -b --factory-startup -noaudio -P render.py -- SEEDS SAMPLES FOLDER [SETTING=VALUE]...

SEEDS has commas between; picture SEED.exr is written in FOLDER. Settings: scene.py.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import scene  # noqa: E402

try:
    seeds, samples, folder, *settings = sys.argv[sys.argv.index("--") + 1:]
    scene.set_up(scene.read_settings(settings))
    for seed in seeds.split(","):
        scene.render_to(f"{folder}/{seed}.exr", int(seed), int(samples))
except Exception as error:  # Blender itself would end with status 0
    print(error, file=sys.stderr)
    sys.exit(1)
