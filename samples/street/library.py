# SPDX-License-Identifier: GPL-3.0-or-later
"""Library: collections that are instanced from the street; it is excluded from the view layer."""

import math

import bpy
from mathutils import Matrix

import fittings
import furniture
import houses
import trees
import vehicles
from furniture import Model


def place(collection, name, data, x=0.0, y=0.0, degrees=0.0, z=0.0):
    """One object of a mesh, or one empty that instances a collection."""
    is_set = isinstance(data, bpy.types.Collection)
    obj = bpy.data.objects.new(name, None if is_set else data)
    if is_set:
        obj.instance_type = "COLLECTION"
        obj.instance_collection = data
        obj.empty_display_size = 0.3
    turn = Matrix.Rotation(math.radians(degrees), 4, "Z")
    obj.matrix_basis = Matrix.Translation((x, y, z)) @ turn
    collection.objects.link(obj)
    return obj


class Library:
    """All that is modeled once: furniture sets, house designs, trees, cars, street fittings."""

    def __init__(self, scene):
        self.root = bpy.data.collections.new("Library")
        scene.collection.children.link(self.root)
        self.sets = self.furniture_sets(self.child(self.root, "Furniture Sets"))
        designs = self.child(self.root, "House Designs")
        self.houses = [houses.build(design, self.sets) for design in houses.DESIGNS]
        self.house_collections = []
        for house in self.houses:
            collection = self.child(designs, house.design.name)
            houses.realize(house, collection, Matrix(), house.design.name)
            self.house_collections.append(collection)
        self.trees = trees.models()
        wood = self.child(self.root, "Trees")
        self.tree_collections = {
            mesh.name: self.single(wood, mesh) for meshes in self.trees.values() for mesh in meshes
        }
        self.shrubs = [
            trees.shrub(0),
            trees.shrub(1),
            trees.shrub(2, "Leaves Linden"),
            trees.shrub(3, "Flowers"),
        ]
        self.cars = vehicles.models()
        garage = self.child(self.root, "Cars")
        self.car_collections = []
        for car in self.cars:
            collection = self.child(garage, car.name)
            place(collection, car.body.name, car.body)
            for x, y, z, degrees in car.places:
                place(collection, "Wheel", car.wheel, x, y, degrees, z)
            self.car_collections.append(collection)
        street = self.child(self.root, "Street Fittings")
        self.lamp = fittings.street_lamp()
        self.bench = fittings.bench()
        self.bin = fittings.litter_bin()
        self.mailbox = fittings.mailbox()
        self.wheelie = fittings.wheelie_bin()
        self.beds = [fittings.flower_bed(k) for k in range(3)]
        self.rest = self.child(street, "Resting Place")
        place(self.rest, "Bench", self.bench)
        place(self.rest, "Litter Bin", self.bin, 1.4, 0.1)

    @staticmethod
    def child(parent, name):
        collection = bpy.data.collections.new(name)
        parent.children.link(collection)
        return collection

    def single(self, parent, mesh):
        collection = self.child(parent, mesh.name)
        place(collection, mesh.name, mesh)
        return collection

    def furniture_sets(self, parent):
        """Sets by name; some hold instances of smaller sets."""
        sets = {}
        dining = self.child(parent, "Dining Set")
        place(dining, "Dining Table", furniture.dining_table().data, 0, -0.45)
        for x in (-0.45, 0.45):
            place(dining, "Chair", furniture.chair().data, x, -0.02)
            place(dining, "Chair", furniture.chair().data, x, -1.88, 180)
        sets["Dining Set"] = Model(dining, 2.0, 1.9)
        night = self.child(parent, "Night Table Set")
        place(night, "Nightstand", furniture.nightstand().data)
        place(night, "Table Lamp", furniture.table_lamp().data, 0, -0.06, 0, 0.52)
        for color in ("Blue", "Grey", "Red"):
            bedroom = self.child(parent, f"Bedroom Set {color}")
            place(bedroom, "Bed", furniture.bed(f"Fabric {color}").data)
            for x in (-1.08, 1.08):
                place(bedroom, "Night Table Set", night, x)
            sets[f"Bedroom Set {color}"] = Model(bedroom, 2.7, 2.1)
        corner = self.child(parent, "Reading Corner")
        place(corner, "Armchair", furniture.armchair("Fabric Red").data, -0.25)
        place(corner, "Floor Lamp", furniture.floor_lamp().data, 0.46)
        sets["Reading Corner"] = Model(corner, 1.4, 0.9)
        work = self.child(parent, "Work Place")
        place(work, "Desk", furniture.desk().data)
        place(work, "Chair", furniture.chair().data, -0.1, -1.15, 180)
        sets["Work Place"] = Model(work, 1.4, 1.2)
        return sets

    def exclude(self, view_layer):
        """Take the library out of the view layer; its instances stay."""
        view_layer.layer_collection.children[self.root.name].exclude = True
