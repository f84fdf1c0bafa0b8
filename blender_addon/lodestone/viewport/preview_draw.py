# SPDX-License-Identifier: GPL-3.0-or-later
"""Batches on the GPU, and drawing them. Only ever called while a viewport is drawn."""

import time

from ..core.preview import viewport_state
from ..core.session.addon_session import addon_session

MOST_BYTES = 1_000_000_000  # of batches that are kept; beyond it those go that nobody shows
KEPT_S = 20.0  # that batches nobody shows are kept, for when one looks back

_VERTEX = """
void main()
{
  at = position;
  turned = normal.xyz;
  glow = normal.w;
  vec3 low = color.rgb / 12.92;
  vec3 high = pow((color.rgb + 0.055) / 1.055, vec3(2.4));
  paint = vec4(mix(low, high, step(vec3(0.04045), color.rgb)), color.a);
  gl_Position = to_clip * vec4(position, 1.0);
}
"""
# Flat where there is no normal; the side that is seen is lit. What lets light through covers every
# so many pixels, so that nothing has to be sorted.
_FRAGMENT = """
float threshold()
{
  ivec2 p = ivec2(gl_FragCoord.xy) & 3;
  int order[16] = int[16](0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5);
  return (float(order[p.y * 4 + p.x]) + 0.5) / 16.0;
}

void main()
{
  if (paint.a < threshold()) {
    discard;
  }
  vec3 n = turned;
  if (dot(n, n) < 0.1) {
    n = cross(dFdx(at), dFdy(at));
  }
  n = n / max(length(n), 1e-20);
  vec3 to_eye = normalize(eye.xyz - at * eye.w);
  if (dot(n, to_eye) < 0.0) {
    n = -n;
  }
  float key = max(dot(n, sun.xyz), 0.0) * sun.w;
  float sky = 0.25 + 0.2 * n.z;
  float head = 0.15 * max(dot(n, to_eye), 0.0);
  picture = vec4(paint.rgb * mix(key + sky + head, 1.0, glow), 1.0);
}
"""
_DEFAULT_SUN = (0.32, -0.45, 0.83)
_KEY = 0.6


class PreviewShader:
    """The shader of the window it was made in; part of the session."""

    made = None


def shader():
    import gpu

    held = addon_session().part(PreviewShader)
    if held.made is None:
        between = gpu.types.GPUStageInterfaceInfo("lodestone_between")
        between.smooth("VEC3", "at")
        between.smooth("VEC3", "turned")
        between.smooth("VEC4", "paint")
        between.smooth("FLOAT", "glow")
        info = gpu.types.GPUShaderCreateInfo()
        info.push_constant("MAT4", "to_clip")
        info.push_constant("VEC4", "eye")  # w 0: looks from a direction
        info.push_constant("VEC4", "sun")
        info.vertex_in(0, "VEC3", "position")
        info.vertex_in(1, "VEC4", "normal")
        info.vertex_in(2, "VEC4", "color")
        info.vertex_out(between)
        info.fragment_out(0, "VEC4", "picture")
        info.vertex_source(_VERTEX)
        info.fragment_source(_FRAGMENT)
        held.made = gpu.shader.create_from_info(info)
    return held.made


class _Batch:
    def __init__(self, batch, mesh):
        self.batch = batch
        self.box = mesh.box
        self.bytes = mesh.bytes
        self.used = time.monotonic()


class Pool:
    """Batches by key: `waiting` ones are in memory, the others on the GPU."""

    def __init__(self):
        self.bytes = 0
        self._waiting = {}
        self._there = {}

    def put(self, key, mesh):
        if key not in self._there:
            self._waiting[key] = mesh

    def has(self, key):
        return key in self._there

    def holds(self, key):
        return key in self._there or key in self._waiting

    def upload(self, keys, seconds):
        """Some of these, at least one; False when time was over before all were."""
        end = time.monotonic() + seconds
        for key in keys:
            mesh = self._waiting.pop(key, None)
            if mesh is None:
                continue
            made = _Batch(_upload(mesh), mesh)
            self._there[key] = made
            self.bytes += made.bytes
            if time.monotonic() > end:
                return not self._waiting
        return True

    def draw(self, keys, planes, program):
        """Returns how many batches were in sight."""
        now, drawn = time.monotonic(), 0
        for key in keys:
            held = self._there.get(key)
            if held is None:
                continue
            held.used = now
            if held.batch is None or viewport_state.outside(planes, held.box):
                continue
            held.batch.draw(program)
            drawn += 1
        return drawn

    def prune(self, in_use):
        """Drops what nobody has shown for a while; returns its keys."""
        now = time.monotonic()
        old = sorted((held.used, key) for key, held in self._there.items() if key not in in_use)
        gone = []
        for used, key in old:
            if now - used < KEPT_S and self.bytes <= MOST_BYTES:
                break
            self.bytes -= self._there.pop(key).bytes
            gone.append(key)
        for key in [key for key in self._waiting if key not in in_use]:
            if len(self._waiting) > 4096:
                del self._waiting[key]
                gone.append(key)
        return gone

    def clear(self):
        self.bytes = 0
        self._waiting.clear()
        self._there.clear()


def _upload(mesh):
    """None where nothing is to be drawn."""
    import gpu

    vertices, triangles = len(mesh.positions) // 3, len(mesh.triangles) // 3
    if triangles == 0:
        return None
    form = gpu.types.GPUVertFormat()
    form.attr_add(id="position", comp_type="F32", len=3, fetch_mode="FLOAT")
    form.attr_add(id="normal", comp_type="I16", len=4, fetch_mode="INT_TO_FLOAT_UNIT")
    form.attr_add(id="color", comp_type="U8", len=4, fetch_mode="INT_TO_FLOAT_UNIT")
    buffer = gpu.types.GPUVertBuf(form, vertices)
    buffer.attr_fill("position", memoryview(mesh.positions).cast("B").cast("f", (vertices, 3)))
    buffer.attr_fill("normal", memoryview(mesh.normals).cast("B").cast("h", (vertices, 4)))
    buffer.attr_fill("color", memoryview(mesh.colors).cast("B", (vertices, 4)))
    indices = memoryview(mesh.triangles).cast("B").cast("I", (triangles, 3))
    elements = gpu.types.GPUIndexBuf(type="TRIS", seq=indices)
    return gpu.types.GPUBatch(type="TRIS", buf=buffer, elem=elements)


def sun_of(depsgraph):
    """(x, y, z) towards the brightest sun, and how bright it is shown."""
    best, towards = 0.0, _DEFAULT_SUN
    for item in depsgraph.objects:
        if item.type == "LIGHT" and item.data.type == "SUN" and item.data.energy > best:
            axis = item.matrix_world.col[2].to_3d()
            if axis.length > 0.0:
                best, towards = item.data.energy, tuple(axis.normalized())
    return (*towards, _KEY)


def background_of(scene):
    """Linear, of the world: of its background node where that is of one color."""
    world = scene.world
    if world is None:
        return (0.05, 0.05, 0.05)
    if world.use_nodes and world.node_tree is not None:
        for node in world.node_tree.nodes:
            if node.type == "BACKGROUND" and not node.inputs["Color"].is_linked:
                strength = min(1.0, max(0.0, node.inputs["Strength"].default_value))
                color = node.inputs["Color"].default_value[:3]
                return tuple(strength * min(1.0, max(0.0, part)) for part in color)
    return tuple(world.color)


class Canvas:
    """A picture of its own with a depth of its own, for one region: what the viewport's own depth
    holds (Blender's outlines, wires and gizmos go by it) stays as it is."""

    def __init__(self, size):
        import gpu

        self.size = size
        self._offscreen = gpu.types.GPUOffScreen(*size, format="RGBA16F")

    def draw(self, pool, keys, region_data, background, sun):
        """Returns how many batches were in sight."""
        import gpu

        matrix = region_data.perspective_matrix
        place = region_data.view_matrix.inverted()
        if region_data.is_perspective:
            eye = (*place.translation, 1.0)
        else:
            eye = (*(place.to_3x3().col[2] * 1.0), 0.0)
        program = shader()
        with self._offscreen.bind():
            frame = gpu.state.active_framebuffer_get()
            frame.clear(color=(*background, 1.0), depth=1.0)
            gpu.state.blend_set("NONE")
            gpu.state.depth_test_set("LESS_EQUAL")
            gpu.state.depth_mask_set(True)
            program.bind()
            program.uniform_float("to_clip", matrix)
            program.uniform_float("eye", eye)
            program.uniform_float("sun", sun)
            planes = viewport_state.planes_of([tuple(row) for row in matrix])
            drawn = pool.draw(keys, planes, program)
            gpu.state.depth_mask_set(False)
            gpu.state.depth_test_set("NONE")
        return drawn

    def show(self):
        """In pixels of the region that is being drawn."""
        from gpu_extras.presets import draw_texture_2d

        draw_texture_2d(self._offscreen.texture_color, (0, 0), *self.size)
