# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties > Material: the slots, and the surface as far as it is drawn."""

import bpy
from bl_ui.properties_material import EEVEE_MATERIAL_PT_context_material
from bpy.types import Panel

from . import ENGINE, EnginePanel
from .node_drawing import draw_node, shader_behind

# What of the principled shader POV-Ray is told, in Blender's order; names of 3.4, then of 4.0
DRAWN = (
    "Base Color",
    "Metallic",
    "Specular",
    "Specular IOR Level",
    "Roughness",
    "Clearcoat",
    "Coat Weight",
    "Clearcoat Roughness",
    "Coat Roughness",
    "IOR",
    "Transmission",
    "Transmission Weight",
    "Emission",
    "Emission Color",
    "Emission Strength",
    "Alpha",
    "Normal",
)


class LODESTONE_MATERIAL_PT_context_material(Panel):
    bl_label = ""
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "material"
    bl_options = {"HIDE_HEADER"}
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context):
        item, material = context.object, context.material
        if (item and item.type == "GPENCIL") or (material and material.grease_pencil):
            return False
        return bool(item or material) and context.engine in cls.COMPAT_ENGINES

    draw = EEVEE_MATERIAL_PT_context_material.draw  # the list of slots is the same everywhere


class LODESTONE_MATERIAL_PT_surface(EnginePanel, Panel):
    bl_label = "Surface"
    bl_context = "material"
    shows = "material"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and not context.material.grease_pencil

    def draw(self, context):
        layout = self.layout
        material = context.material
        layout.prop(material, "use_nodes", icon="NODETREE")
        layout.separator()
        layout.use_property_split = True
        if not material.use_nodes or material.node_tree is None:
            layout.prop(material, "diffuse_color", text="Base Color")
            layout.prop(material, "metallic")
            layout.prop(material, "specular_intensity", text="Specular")
            layout.prop(material, "roughness")
            return
        tree = material.node_tree
        output = tree.get_output_node("ALL")
        shader = shader_behind(output, "Surface")
        wanted = DRAWN if shader is not None and shader.type == "BSDF_PRINCIPLED" else None
        draw_node(layout, tree, output, "Surface", wanted)


_CLASSES = (LODESTONE_MATERIAL_PT_context_material, LODESTONE_MATERIAL_PT_surface)
register, unregister = bpy.utils.register_classes_factory(_CLASSES)
