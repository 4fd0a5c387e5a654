"""A scene for Cycles, and pictures of it that are unbiased but for what the settings spoil.

A small lamp lights a floor and a block on it. Most of the light comes straight from the lamp; of
the paths that go on, the few that meet the lit sides of the block or the floor beneath the lamp
bring much, and the many that leave for the black sky nothing. So `clamp_indirect=10`, Cycles'
default, takes little of the mean and most of the variance.

`glass=1` puts a ball of clear glass on the floor. Light reaches the floor through it only on paths
that meet the small lamp by chance. They are few and bright, and `caustics=0` leaves them out.
"""

import bpy

WIDTH, HEIGHT = 32, 18
DEFAULTS = {
    "clamp_indirect": 0,  # 0: no clamp
    "max_bounces": 8,
    "glass": 0,
    "caustics": 1,
    "blur_glossy": 0,
}


def read_settings(words):
    """SETTING=VALUE words over the defaults."""
    settings = dict(DEFAULTS)
    for word in words:
        name, _, value = word.partition("=")
        if name not in settings:
            raise ValueError(f"there is no setting `{name}`; there are {', '.join(settings)}")
        settings[name] = float(value)
    return settings


def material_of(node, **inputs):
    """A material of one node."""
    material = bpy.data.materials.new(node)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    surface = nodes.new(node)
    for name, value in inputs.items():
        surface.inputs[name].default_value = value
    output = nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(surface.outputs["BSDF"], output.inputs["Surface"])
    return material


def add_object(name, data, **place):
    thing = bpy.data.objects.new(name, data)
    for key, value in place.items():
        setattr(thing, key, value)
    bpy.context.collection.objects.link(thing)
    return thing


def add_mesh(name, corners, faces, material):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    mesh.materials.append(material)
    add_object(name, mesh)


def add_glass_ball():
    """Its facets are flat: Blender adds up smooth normals in another order each time it starts."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=0.5, location=(1.2, -0.6, 0.5))
    bpy.context.object.data.materials.append(material_of("ShaderNodeBsdfGlass", Roughness=0, IOR=1.5))


def add_scene(glass):
    material = material_of("ShaderNodeBsdfDiffuse", Color=(0.8, 0.75, 0.7, 1))
    floor = [(-16, -16, 0), (16, -16, 0), (16, 16, 0), (-16, 16, 0)]
    add_mesh("floor", floor, [(0, 1, 2, 3)], material)
    block = [(x, y, z) for z in (0, 1) for y in (-0.5, 0.5) for x in (-0.5, 0.5)]
    sides = [(4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]
    add_mesh("block", block, sides, material)
    if glass:
        add_glass_ball()
    lamp = bpy.data.lights.new("lamp", "AREA")
    lamp.energy = 5000  # W
    lamp.size = 0.3
    add_object("lamp", lamp, location=(1.2, -1.2, 1.5))
    camera = bpy.data.cameras.new("camera")
    bpy.context.scene.camera = add_object(
        "camera", camera, location=(0, -6, 3), rotation_euler=(1, 0, 0))
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0


def set_up(settings):
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing, do_unlink=True)
    add_scene(settings["glass"])
    render = bpy.context.scene.render
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y, render.resolution_percentage = WIDTH, HEIGHT, 100
    render.threads_mode, render.threads = "FIXED", 1  # Assay runs as many programs as there are cores
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.image_settings.color_mode = "RGB"
    cycles = bpy.context.scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = False  # it looks at the picture to decide when to stop
    cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.blur_glossy = settings["blur_glossy"]
    cycles.caustics_reflective = cycles.caustics_refractive = settings["caustics"] != 0
    cycles.sample_clamp_direct = 0
    cycles.sample_clamp_indirect = settings["clamp_indirect"]
    cycles.max_bounces = int(settings["max_bounces"])
    cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = cycles.max_bounces


def render_to(file, seed, samples):
    scene = bpy.context.scene
    scene.cycles.seed = seed
    scene.cycles.samples = samples
    scene.render.filepath = file
    if bpy.ops.render.render(write_still=True) != {"FINISHED"}:
        raise RuntimeError(f"the picture of seed {seed} was not rendered")
