"""A scene for Cycles and its pictures, one for each seed, as 32-bit OpenEXR.

    blender -b --factory-startup -noaudio -P room.py -- SEEDS SAMPLES FOLDER [SETTING=VALUE]...

SEEDS has commas between; picture SEED.exr is written in FOLDER. One process renders them all: it
takes most of a second to start and some hundredths for a picture. Settings: clamp_indirect,
clamp_direct (0: none), max_bounces, light (a factor of the lamp's power).
"""

import sys

import bpy

SIZE = 64


def clear():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing, do_unlink=True)


def diffuse(name, colour):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    surface = nodes.new("ShaderNodeBsdfDiffuse")
    surface.inputs["Color"].default_value = (*colour, 1)
    output = nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(surface.outputs["BSDF"], output.inputs["Surface"])
    return material


def add_mesh(name, corners, faces, material):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    mesh.materials.append(material)
    bpy.context.collection.objects.link(bpy.data.objects.new(name, mesh))


def add_scene(light):
    """A block on a floor before a wall, a small lamp close above the floor beside it."""
    white = diffuse("white", (0.8, 0.8, 0.8))
    red = diffuse("red", (0.8, 0.3, 0.2))
    add_mesh("floor", [(-4, -4, 0), (4, -4, 0), (4, 4, 0), (-4, 4, 0)], [(0, 1, 2, 3)], white)
    add_mesh("wall", [(-4, 2, 0), (4, 2, 0), (4, 2, 4), (-4, 2, 4)], [(3, 2, 1, 0)], red)
    corners = [(x, y, z) for z in (0, 1) for y in (-0.5, 0.5) for x in (-0.5, 0.5)]
    faces = [(4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
    add_mesh("block", corners, faces, white)
    lamp = bpy.data.lights.new("lamp", "AREA")
    lamp.energy = 10 * light
    lamp.size = 0.5
    bulb = bpy.data.objects.new("lamp", lamp)
    bulb.location = (1.5, -1, 2)
    bpy.context.collection.objects.link(bulb)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = (0, -6, 3)
    camera.rotation_euler = (1.15, 0, 0)
    bpy.context.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0


def set_up(samples, settings):
    """Pictures that are unbiased means of independent samples, but for what the settings spoil."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    scene.render.threads_mode = "FIXED"
    scene.render.threads = 1
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.color_mode = "RGB"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = samples
    cycles.use_adaptive_sampling = False  # it looks at the picture to decide when to stop
    cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"  # no sample counts for two pixels
    cycles.blur_glossy = 0
    cycles.sample_clamp_direct = settings["clamp_direct"]
    cycles.sample_clamp_indirect = settings["clamp_indirect"]
    cycles.max_bounces = cycles.diffuse_bounces = int(settings["max_bounces"])


def main(words):
    seeds, samples, folder = words[0].split(","), int(words[1]), words[2]
    settings = {"clamp_direct": 0, "clamp_indirect": 0, "max_bounces": 8, "light": 1}
    for word in words[3:]:
        name, value = word.split("=")
        if name not in settings:
            raise SystemExit(f"no setting {name}; there are {', '.join(settings)}")
        settings[name] = float(value)
    clear()
    add_scene(settings["light"])
    set_up(samples, settings)
    scene = bpy.context.scene
    for seed in seeds:
        scene.cycles.seed = int(seed)
        scene.render.filepath = f"{folder}/{seed}.exr"
        bpy.ops.render.render(write_still=True)


try:
    main(sys.argv[sys.argv.index("--") + 1:])
except Exception as error:  # Blender itself would end with status 0
    print(error, file=sys.stderr)
    sys.exit(1)
