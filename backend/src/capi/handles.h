// SPDX-License-Identifier: GPL-3.0-or-later
// Handles: the structs behind the opaque pointers, and the translation of small structs.
#pragma once

#include "lodestone/lodestone.h"

#include "choose/cut_budget.h"
#include "choose/follow/cut_stepper.h"
#include "choose/ray_class/ray_cut.h"
#include "choose/surface_detail.h"
#include "geometry/polygon_mesh.h"
#include "hierarchy/build_settings.h"
#include "segment/store.h"
#include "view/viewer_batches.h"
#include "view/viewer_surface.h"

#include <map>
#include <memory>
#include <optional>
#include <unordered_map>

struct lds_model {
    lodestone::Model model;
    uint32_t generation = 0;  // that of its ids; no two models of a process share one
    std::vector<lodestone::PicturePtr> pictures;  // added, by index
    lodestone::Problems problems;
    std::optional<lodestone::segment::Store> store;  // where meshes that are not resident lie
    std::unordered_map<std::string, uint32_t> by_uid;
    /// The finest meshes by content, so that equal ones that are added later share them.
    std::unordered_map<lodestone::Hash, std::weak_ptr<const lodestone::Mesh>> meshes;
    bool summarized = false;  // assemblies' bounds, costs and hashes are up to date
    uint64_t structured = 0;  // how often what groups place was put into other groups
    /// The table for choosing; reset when the model changes. Cuts keep it.
    std::shared_ptr<const lodestone::choose::ChoiceTable> table;
    /// The shapes of meshes, alone and beside a box or ellipsoid, by their hashes.
    std::map<std::pair<lodestone::Hash, lodestone::Hash>, lodestone::choose::RayShape> shapes;

    /// The index of an id; throws Error(StaleId) for another model's.
    lodestone::ObjectIndex index_of(lds_object object) const;
    lds_object id_of(lodestone::ObjectIndex index) const { return {index, generation}; }
    lodestone::Object& at(lds_object object) { return model.objects[index_of(object)]; }
    /// Brings the summaries of assemblies up to date.
    void summarize();
    /// The table that choosing reads, up to date. Throws Error(InvalidArgument) without a root.
    std::shared_ptr<const lodestone::choose::ChoiceTable> table_for(lodestone::KindMask kinds);
    /// Makes a representation resident.
    void load(lodestone::Representation& representation);
    /// Makes every finest mesh and every picture resident (a model read from a store).
    void load_finest();
    /// Makes every picture resident.
    void load_pictures();
};

struct lds_cut {
    lodestone::choose::Cut cut;
    /// The chunks of large surfaces in it; none where it was stepped: viewports draw whole levels.
    std::vector<lodestone::choose::SurfaceDetail> surfaces;
    std::vector<lodestone::choose::RayCut> rays;  // those of the classes asked for
    lodestone::choose::ResidentSize resident;     // for the camera and these
    lodestone::View view;                         // it was made for this, with the threshold found
    uint64_t budget = 0;                          // the bytes it was made to fit; 0: any
    uint32_t generation = 0;                      // that of the model it was made from
    uint64_t structured = 0;                      // the model's then
    std::shared_ptr<const lodestone::choose::ChoiceTable> table;  // it was chosen from this one
    std::unique_ptr<lodestone::choose::CutStepper> stepper;  // on the table; null: not stepped yet
    std::vector<std::string> paths;                          // by choice; those asked for
    double largest_error_px = 0;                             // of what is drawn, chunks included
    uint32_t largest_error_node = lodestone::choose::kNoParent;  // in Cut::nodes
    std::string largest_error_name;
    std::vector<glm::dvec3> colors;  // linear, by choice; empty: by kind and LOD number
    lodestone::view::ViewerSurface surface;
    std::vector<lodestone::view::ViewerBatch> batches;
    std::vector<glm::dvec3> batch_colors;  // the colors that the batches were made with
};

namespace lodestone::capi {

glm::dvec3 vector(const double values[3], const char* what);
void copy(const glm::dvec3& from, double to[3]);
std::string name_of(const char* text);
/// Translates a view. Lenses may list objects of `model`.
View view_of(const lds_view* view, const lds_model* model);
Camera camera_of(const lds_camera* camera);
/// Translates the modifiers of quality, for a picture of this size in pixels.
QualityModifiers modifiers_of(const lds_modifiers* modifiers, const lds_model* model, int width,
                              int height);
/// Translates polygons to views into the caller's memory; throws Error(InvalidArgument) for lengths
/// and indices that do not fit.
PolygonMesh faces_of(const lds_faces_view* view);
lds_model* new_model();
/// The info of an object. Throws Error(InvalidArgument) for null and for one that lacks fields.
lds_object_info object_info(const lds_object_info* info);
/// Adds an object of that uid; throws when the uid is empty or taken.
ObjectIndex add_object(lds_model& model, const lds_object_info* info, Representation finest);

}  // namespace lodestone::capi
