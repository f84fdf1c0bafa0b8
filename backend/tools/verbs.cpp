// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs.h"

#include "choosing.h"

namespace lodestone::tools {
namespace {

const OptionHelp kJson{"json", "FILE", "also write the result as a JSON report"};
const OptionHelp kThreads{"threads", "N", "use at most N threads (default: all)"};
const OptionHelp kSeed{"seed", "N", "seed of random samples (default 1)"};

}  // namespace

const std::vector<CommandVerb>& verbs() {
    // One row a verb, in the order a user meets them.
    // Law: the counts and options are those that each verb's function takes.
    static const std::vector<CommandVerb> kAll{
        {"measure",
         "FILE",
         "visible area, center, inertia and mean color of each object",
         "FILE is a .obj, .ply, .glb or .gltf, or a store made by `lodestone build`.\n"
         "Rays are cast from all around; open sheets count both sides.",
         1,
         {{"relative-error", "E", "cast until the area is this sure (default 0.01)"},
          {"rays", "N", "so many rays an object instead; more is surer and slower"},
          kJson,
          kThreads,
          kSeed},
         run_measure},
        {"simplify",
         "IN OUT",
         "the same model with fewer triangles",
         "Give one of --ratio, --triangles, --error and --pixels. IN is any file that measure "
         "reads, OUT .obj, .ply or .glb.\n"
         "The distance to the original is measured with --error, --pixels and --measure only.",
         2,
         {{"mode", "MODE", "best, fast (default) or cluster (fastest; parts may grow together)"},
          {"ratio", "R", "keep this share of every object's triangles, e.g. 0.1"},
          {"triangles", "N", "keep about N triangles in the whole model"},
          {"error", "METRES", "the fewest triangles that stay within this distance"},
          {"pixels", "P", "the same in pixels of a picture (default 1), with one or both of:"},
          {"distance", "METRES", "seen from there"},
          {"height", "PIXELS",
           "the picture's height (default 360); the model's without --distance"},
          {"angle-deg", "A", "with --distance: field of view over the height (default 29.4)"},
          {"keep-topology", "", "keep parts, holes and handles, even where that misses the target"},
          {"measure", "", "measure the distance to the original"},
          kJson,
          kThreads,
          kSeed},
         run_simplify},
        {"build",
         "IN STORE",
         "the approximation hierarchy of a model, in a folder",
         "Makes simpler levels, boxes, ellipsoids and composites of every object and group of IN\n"
         "and writes them to the folder STORE, a 3D Tiles 1.1 tileset. What has not changed is\n"
         "kept.",
         2,
         {{"level-ratio", "R", "triangles of a level over the finer one's (default 0.4)"},
          {"rays", "N", "rays to measure an object (default 4096)"},
          {"samples", "N", "samples to measure an error (default 2048)"},
          {"loose-parts", "WAY",
           "one: a mesh is one object; objects: so are its loose parts; auto (default): if small"},
          {"groups", "WAY",
           "given: those of the file; auto (default): nested ones where many things lie in one"},
          {"rebuild", "", "also build what has not changed"},
          kJson,
          kThreads,
          kSeed},
         run_build},
        {"info",
         "STORE",
         "what a store or model holds",
         "Lists every object with its levels: kind, triangles, error.",
         1,
         {{"objects", "N", "list at most N objects (default 40)"}, kJson},
         run_info},
        {"cut",
         "STORE",
         "which level of everything a view would use",
         "The camera is one of the store (--camera NAME), or placed by --eye and --look-at.",
         1,
         {{"pixel-error", "PX", "largest error on screen in pixels (default 1; 0 = originals)"},
          kMaxTriangles,
          kMaxMemory,
          kCriterion,
          kOffScreen,
          kRayClasses,
          {"size", "WxH", "picture size in pixels (default 640x360)"},
          {"camera", "NAME", "a camera of the store (default: its first)"},
          {"eye", "X,Y,Z", "where the eye is"},
          {"look-at", "X,Y,Z", "what it looks at (default 0,0,0)"},
          {"angle-deg", "A", "horizontal field of view (default 50)"},
          {"list", "", "list every choice"},
          kJson},
         run_cut},
        {"povray",
         "STORE|MODEL",
         "a picture, by POV-Ray, with just the detail it needs",
         "Renders a store, or a .glb, .gltf, .obj or .ply at full detail, to an sRGB PNG. The "
         "camera\n"
         "is one of the file (--camera NAME), placed by --eye and --look-at, or sees everything.\n"
         "What holds no light is lit by a sun and a sky.",
         1,
         {{"out", "X.png", "the picture"},
          {"pixel-error", "PX", "largest error on screen in pixels (default 1; 0 = originals)"},
          kMaxTriangles,
          kMaxMemory,
          kCriterion,
          kOffScreen,
          kRayClasses,
          {"size", "WxH", "picture size in pixels (default 640 wide in the camera's shape)"},
          {"camera", "NAME", "a camera of the file (default: its first)"},
          {"eye", "X,Y,Z", "where the eye is"},
          {"look-at", "X,Y,Z", "what it looks at (default 0,0,0)"},
          {"angle-deg", "A", "horizontal field of view (default 50)"},
          {"antialias", "HOW", "off, final (default) or reference"},
          {"filter-size", "PX",
           "of the filter that blurs the picture as Blender's does (default 1.5; 0: none)"},
          {"light-error", "PX",
           "the same for lights alone (default: as pixel-error; 0 = all lamps as they are)"},
          {"sky-occlusion", "N",
           "rays by which a corner finds its share of the sky (default 128; 0: all see all of it)"},
          {"bounces", "N", "of light from surface to surface (default 0: direct light only)"},
          {"false-color", "", "paint by kind and level of detail"},
          {"scene", "DIR", "keep the files for POV-Ray in this folder"},
          {"program", "POVRAY", "the program (default: $LODESTONE_POVRAY, else on the PATH)"},
          kJson,
          kThreads},
         run_povray},
        {"compare",
         "A B",
         "how much two pictures differ",
         "Prints mean, 99.9 % and largest difference of display values (0...1) and the structural\n"
         "similarity (SSIM, 1 = the same). PNG, JPEG or EXR.",
         2,
         {{"mask", "M", "count only pixels where this picture's alpha is more than 1/255"}, kJson},
         run_compare},
        {"version",
         "",
         "version of Lodestone and what it found on this machine",
         "",
         0,
         {kJson},
         run_version},
    };
    return kAll;
}

}  // namespace lodestone::tools
