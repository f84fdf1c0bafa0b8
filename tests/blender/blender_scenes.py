# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes for tests inside Blender, and the add-on they are tested with."""

import math

import addon_utils
import bmesh
import bpy


def enable():
    """The staged add-on, enabled as a user does it."""
    if addon_utils.enable("lodestone", default_set=True) is None:
        raise RuntimeError("the staged add-on cannot be enabled: is BLENDER_USER_SCRIPTS set?")


def fresh():
    """An empty scene with a camera that looks along -Z from 10 m above, and the add-on."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    # What is subdivided on the GPU, once a test has woken it, is a mesh without its name.
    bpy.context.preferences.system.use_gpu_subdivision = False
    enable()
    scene = bpy.context.scene
    data = bpy.data.cameras.new("Camera")
    camera = link(bpy.data.objects.new("Camera", data))
    camera.location = (0, 0, 10)
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y = 64, 36
    scene.view_settings.view_transform = "Standard"
    return scene


def link(item, collection=None):
    (collection or bpy.context.scene.collection).objects.link(item)
    return item


def mesh(name, vertices, faces):
    made = bpy.data.meshes.new(name)
    made.from_pydata(vertices, [], faces)
    return made


def cube_mesh(name="Cube", size=1.0):
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return mesh(name, [[size / 2 * c for c in corner] for corner in corners], faces)


def cube(name="Cube", location=(0, 0, 0), size=1.0, data=None, collection=None):
    made = bpy.data.objects.new(name, data or cube_mesh(name, size))
    made.location = location
    return link(made, collection)


def bumpy_mesh(name="Ball", subdivisions=4):
    """A ball of 20 * 4^(subdivisions - 1) triangles that no ellipsoid is exactly like."""
    made, shape = bpy.data.meshes.new(name), bmesh.new()
    bmesh.ops.create_icosphere(shape, subdivisions=subdivisions, radius=1.0)
    for vertex in shape.verts:
        vertex.co *= 1.0 + 0.1 * math.sin(9.0 * vertex.co.x) * math.sin(7.0 * vertex.co.z)
    shape.to_mesh(made)
    shape.free()
    return made


def collection(name, parent=None):
    """A new collection, in parent, or in no scene when parent is None."""
    made = bpy.data.collections.new(name)
    if parent is not None:
        parent.children.link(made)
    return made


def instance(name, of, location=(0, 0, 0), scale=(1, 1, 1), turn=(0, 0, 0), parent=None):
    """An empty that instances a collection."""
    made = bpy.data.objects.new(name, None)
    made.instance_type, made.instance_collection = "COLLECTION", of
    made.location, made.scale, made.rotation_euler = location, scale, turn
    return link(made, parent)


def material(name, color=(0.8, 0.1, 0.1)):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    made.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1.0)
    return made


def matte(name, color):
    """A diffuse shader alone: Lambert's law in every engine, unlike the principled one's."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    shader = tree.nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (*color, 1.0)
    output = tree.nodes["Material Output"]
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return made


def sun(name="Sun", energy=3.0):
    data = bpy.data.lights.new(name, "SUN")
    data.energy = energy
    return link(bpy.data.objects.new(name, data))


def encoded(value):
    """Linear light as an sRGB display shows it, 0 to 1."""
    value = min(1.0, max(0.0, value))
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055


def extract(compare=True, cameras=()):
    """(extraction, differences to the depsgraph); close the extraction's model."""
    from lodestone.engines import extract_engine

    request = extract_engine.Request(cameras=cameras, compare=compare)
    extraction = extract_engine.extract_now(bpy.context.scene, request)
    return extraction, request


def particles(emitter, count, **settings):
    """A particle system on an object; see it from frame 2 on. `instance_object` or
    `instance_collection` say what each particle shows."""
    emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
    made = emitter.particle_systems[-1]
    made.settings.count = count
    made.settings.frame_start = made.settings.frame_end = 1
    if "instance_object" in settings:
        made.settings.render_type = "OBJECT"
    elif "instance_collection" in settings:
        made.settings.render_type = "COLLECTION"
    for name, value in settings.items():
        setattr(made.settings, name, value)
    return made


def node_group(name):
    """(geometry nodes with one geometry in and one out, the input node, the output node)."""
    group = bpy.data.node_groups.new(name, "GeometryNodeTree")
    group.inputs.new("NodeSocketGeometry", "Geometry")
    group.outputs.new("NodeSocketGeometry", "Geometry")
    return group, group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")


def scatter_nodes(collection=None, separate=False, primitive=False, realize=False, join=False):
    """Geometry nodes: an instance on each vertex, of a collection (or its children in turn) or of
    a cube made by a node; `join` keeps the geometry itself."""
    group, first, last = node_group("Scatter")
    nodes, links = group.nodes, group.links
    if primitive:
        source = nodes.new("GeometryNodeMeshCube")
    else:
        source = nodes.new("GeometryNodeCollectionInfo")
        source.inputs["Collection"].default_value = collection
        source.inputs["Separate Children"].default_value = separate
    on = nodes.new("GeometryNodeInstanceOnPoints")
    on.inputs["Pick Instance"].default_value = separate
    links.new(first.outputs[0], on.inputs["Points"])
    links.new(source.outputs[0], on.inputs["Instance"])
    made = on.outputs[0]
    if realize:
        real = nodes.new("GeometryNodeRealizeInstances")
        links.new(made, real.inputs[0])
        made = real.outputs[0]
    if join:
        both = nodes.new("GeometryNodeJoinGeometry")
        links.new(first.outputs[0], both.inputs[0])
        links.new(made, both.inputs[0])
        made = both.outputs[0]
    links.new(made, last.inputs[0])
    return group
