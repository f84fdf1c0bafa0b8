/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lodestone's C interface: everything Blender, the command and other programs may call.
   Over 500 lines: the one public header is the manual.

   Holds for every function unless it says otherwise:
   units       metres, radians, watts, seconds; right-handed, Z up; linear Rec.709 colors
   transforms  double[12], row-major 3x4, x -> M x + t
   status      LDS_OK (0) or the cause; the sentence that names the thing is lds_last_error_text().
               On failure outputs are untouched
   structs     set struct_size to sizeof the struct before a call reads or fills it. Structs that
               begin with it may grow at their end in later versions: fields that an older caller's
               lacks count as 0 and are not filled, those that an older library lacks are left as
               they are. They are passed by pointer alone, so none lies in an array or in another
               struct; none ends with padding. All other structs stay as they are.
               lds_..._default fills in the usual values
   strings     UTF-8 in, any bytes accepted; strings handed out stay valid until the model or cut
               they came from changes or is destroyed. A null name counts as ""
   arrays      read during the call only, never kept; results are copied into the caller's buffers
   threads     different models may be used from different threads at once; one model only by one
               thread at a time (its const functions by several). Long calls use all cores
   jobs        long calls take an lds_job* (may be null), owned by the caller, who may read it and
               set `cancel` from any thread; a cancelled call returns LDS_ERROR_CANCELLED within
               0.1 s and leaves nothing half done
   errors      nothing throws or aborts */
#ifndef LODESTONE_LODESTONE_H
#define LODESTONE_LODESTONE_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define LDS_API __attribute__((visibility("default")))
#else
#define LDS_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Raised by the first version after which a program that was compiled before must not go on; compare
   with lds_abi_version() before anything else. New functions, new enumerators and new members at
   the end of a struct that begins with struct_size do not raise it. */
#define LDS_ABI_VERSION 1

typedef enum lds_status {
    LDS_OK = 0,
    LDS_ERROR_INVALID_ARGUMENT = 1,
    LDS_ERROR_OUT_OF_MEMORY = 2,
    LDS_ERROR_INTERNAL = 3,
    LDS_ERROR_CANCELLED = 4,
    LDS_ERROR_STALE_ID = 5, /* an id of another or a destroyed model */
    LDS_ERROR_IO = 10,
    LDS_ERROR_BAD_FILE = 11,
    LDS_ERROR_RAYS_UNAVAILABLE = 20, /* Embree 3 missing or unusable */
    LDS_ERROR_POVRAY_MISSING = 30,
    LDS_ERROR_POVRAY_FAILED = 31
} lds_status;

/* The stage that a long call is in. */
typedef enum lds_stage {
    LDS_STAGE_NONE = 0,
    LDS_STAGE_EXTRACT = 1,
    LDS_STAGE_MEASURE = 2,
    LDS_STAGE_SIMPLIFY = 3,
    LDS_STAGE_GROUP = 4,
    LDS_STAGE_STORE = 5,
    LDS_STAGE_CHOOSE = 6,
    LDS_STAGE_EXPORT = 7,
    LDS_STAGE_PARSE = 8,
    LDS_STAGE_TRACE = 9
} lds_stage;

typedef struct lds_job {
    uint32_t struct_size;
    int32_t cancel;  /* set to 1 to stop */
    int32_t stage;   /* lds_stage */
    double fraction; /* 0...1 of the whole call, never falling */
} lds_job;

/* ---- Library ------------------------------------------------------------------------------ */

LDS_API uint32_t lds_abi_version(void);
/* The version, as "0.1.0". */
LDS_API const char* lds_version(void);
/* The name of a status, "INVALID_ARGUMENT" and so on; "UNKNOWN" for a number that is no status. */
LDS_API const char* lds_status_name(lds_status status);
/* The sentence of this thread's last failed call; "" after a success. Valid until its next call. */
LDS_API const char* lds_last_error_text(void);
/* Loads Embree and tests a known ray. LDS_ERROR_RAYS_UNAVAILABLE with the reason. */
LDS_API lds_status lds_rays_check(void);

/* ---- Model: objects, placements, materials, lights, cameras -------------------------------- */

typedef struct lds_model lds_model;

/* The id of an object of one model. {0, 0} is none. */
typedef struct lds_object {
    uint32_t index;
    uint32_t generation;
} lds_object;

typedef enum lds_role {
    LDS_ROLE_AUTOMATIC = 0, /* ordinary; but the ground that most of a group's other children stand
                                 on is never a solid (lds_kind), and neither is their group */
    LDS_ROLE_ENVIRONMENT = 1, /* wall, ground or sky: simplified, but never a solid */
    LDS_ROLE_ORDINARY = 2     /* may be replaced whatever stands on it */
} lds_role;

/* A solid is what is neither a mesh nor an assembly. */
typedef enum lds_kind {
    LDS_KIND_MESH = 1,
    LDS_KIND_BOX = 3,
    LDS_KIND_ELLIPSOID = 4,
    LDS_KIND_COMPOSITE = 7, /* several boxes and ellipsoids */
    LDS_KIND_ASSEMBLY = 8   /* placements of other objects; drawn by these */
} lds_kind;
/* One more than the largest kind: the length of arrays that are indexed by lds_kind. Such an array
   is the last member of its struct, which grows with it. */
#define LDS_KIND_COUNT 9
/* The word for a kind in files and reports, "mesh" and so on; "" for a number that is no kind. */
LDS_API const char* lds_kind_name(int32_t kind);

/* Bits of a mask. Rays refracted by glass count as camera rays. */
typedef enum lds_ray_class {
    LDS_RAY_CAMERA = 1,
    LDS_RAY_REFLECTION = 2,
    LDS_RAY_SHADOW = 4,
    LDS_RAY_RADIOSITY = 8
} lds_ray_class;

typedef struct lds_object_info {
    uint32_t struct_size;
    const char* uid;       /* stable and unique in the model; not empty */
    const char* name;      /* the user's */
    int32_t role;          /* lds_role */
    int32_t deforms;       /* 1: its shape changes from frame to frame. Its levels are those that
                         lds_build_options.poses make to follow it, if any; groups that hold it
                         are always opened */
    uint64_t connectivity; /* with deforms: a number that two frames share exactly when they have
                              the same polygons, however these are cut into triangles; 0: compare
                              the triangles */
} lds_object_info;

/* An image. Exactly one of path, bytes and pixels is given. */
typedef struct lds_picture {
    uint32_t struct_size;
    int32_t linear;    /* 0: display-encoded (sRGB) color; 1: linear color, or data */
    const char* name;  /* the user's */
    const char* path;  /* a PNG, JPEG or OpenEXR file */
    const void* bytes; /* such a file's content */
    size_t byte_count;
    const float* pixels; /* float32[height][width][4], straight alpha, lowest row first (Blender's
                            order), numbers as the color space says; kept as an 8-bit PNG */
    int32_t width;
    int32_t height;
} lds_picture;

typedef enum lds_channel {
    LDS_CHANNEL_COLOR = 0,
    LDS_CHANNEL_RED = 1,
    LDS_CHANNEL_GREEN = 2,
    LDS_CHANNEL_BLUE = 3,
    LDS_CHANNEL_ALPHA = 4,
    LDS_CHANNEL_LUMA = 5
} lds_channel;

typedef enum lds_extension {
    LDS_EXTENSION_REPEAT = 0,
    LDS_EXTENSION_EXTEND = 1,
    LDS_EXTENSION_CLIP = 2, /* outside 0...1: black, alpha 0 */
    LDS_EXTENSION_MIRROR = 3
} lds_extension;

/* A picture laid on a surface by its texture coordinates: the value there is
   offset + scale * texel(to_picture (u, v, 1)); v = 0 is the picture's lowest row. */
typedef struct lds_texture {
    uint32_t picture;     /* 1 + the index of an added picture; 0: no texture */
    int32_t channel;      /* lds_channel; for a single number COLOR means luma */
    int32_t extension;    /* lds_extension */
    int32_t closest;      /* 1: no interpolation between texels */
    double to_picture[6]; /* row-major 2x3 */
    double scale[3];      /* a single number takes the first */
    double offset[3];
} lds_texture;

typedef enum lds_alpha_mode {
    LDS_ALPHA_MODE_OPAQUE = 0,
    LDS_ALPHA_MODE_BLEND = 1,
    LDS_ALPHA_MODE_CLIP = 2 /* opaque where alpha >= alpha_cutoff, else nothing */
} lds_alpha_mode;

/* Where a value has a texture, the texture counts. The field beside it must then hold the texture's
   mean (from lds_model_texture_mean), for everything that does not look at textures. Start from
   lds_material_default. */
typedef struct lds_material {
    uint32_t struct_size;
    const char* name;
    double base_color[3]; /* linear, usual 0...1 */
    double roughness;     /* 0...1 */
    double metallic;      /* 0...1 */
    double specular;      /* 0...1; 0.5 = index of refraction 1.45 */
    double emission[3];   /* linear, W/(sr m^2) */
    lds_texture base_color_texture;
    lds_texture roughness_texture;
    lds_texture metallic_texture;
    lds_texture emission_texture;
    int32_t vertex_colors; /* 1: base color and alpha are multiplied by the mesh's colors */
    double alpha;          /* 0...1 */
    lds_texture alpha_texture;
    int32_t alpha_mode; /* lds_alpha_mode */
    double alpha_cutoff;
    double transmission; /* 0...1: share of light that is refracted instead of scattered */
    double ior;          /* > 0; usual 1...3 */
    double clearcoat;    /* 0...1 */
    double clearcoat_roughness;
    lds_texture normal_texture; /* tangent space, 0...1 for -1...1, green up */
    double normal_strength;
    lds_texture bump_texture; /* height in parts of bump_distance */
    double bump_distance;     /* metres from 0 to 1; below 0 inward */
    uint32_t other; /* 1 + the index of the added material that this one is mixed with; 0: none */
    double mix;     /* 0...1: share of the other */
    lds_texture mix_texture;
} lds_material;
LDS_API lds_status lds_material_default(lds_material* material);

/* A triangle mesh as the caller has it. Normals and uvs belong to corners: entry corners[3 t + c]
   of corner_normals is that of corner c of triangle t. */
typedef struct lds_mesh_view {
    uint32_t struct_size;
    const float* positions; /* float32[vertex_count][3] metres */
    size_t vertex_count;
    const uint32_t* triangles; /* uint32[triangle_count][3], < vertex_count */
    size_t triangle_count;
    const uint32_t* corners; /* uint32[triangle_count][3], < corner_count; null: the same as
                                    triangles, and corner_count = vertex_count */
    size_t corner_count;
    const float* corner_normals; /* float32[corner_count][3]; null: flat shaded */
    const float* corner_uvs;     /* float32[corner_count][2]; null: none */
    const float* corner_colors;  /* float32[corner_count][4] linear RGBA, straight; null: white */
    const int32_t* slots;        /* int32[triangle_count]; null: all 0. Outside 0...material_count-1
                                    counts as the nearest slot (Blender's rule) */
} lds_mesh_view;

/* A mesh of polygons as modelers keep it; the backend triangulates it and makes its normals. A
   corner is one vertex of one face. Corners are listed face by face, in order around each face. */
typedef struct lds_faces_view {
    uint32_t struct_size;
    const float* positions; /* float32[vertex_count][3] metres */
    size_t vertex_count;
    const uint32_t* corner_vertices; /* uint32[corner_count], < vertex_count */
    size_t corner_count;
    const uint32_t* face_starts; /* uint32[face_count]: first corner of each, rising from 0; null:
                                    all have three */
    size_t face_count;
    const uint32_t* triangles; /* uint32[triangle_count][3] corners, in the order of the faces;
                                  null: no face has more than four */
    size_t triangle_count;
    const uint8_t* face_smooth;  /* uint8[face_count]; null: all flat */
    const int32_t* face_slots;   /* int32[face_count]; null: all 0. Outside 0...material_count-1
                                    counts as the nearest slot */
    const float* corner_normals; /* float32[corner_count][3]; null: smooth faces have at each vertex
                                    the mean of the adjacent faces' normals, weighted by angle.
                                    Given normals that differ from these by rounding alone are
                                    replaced by them, so that a mesh keeps its hash */
    const float* corner_uvs;     /* float32[corner_count][2]; null: none */
    const float* corner_colors;  /* float32[corner_count][4] linear RGBA, straight; null: white */
    const float* vertex_colors;  /* float32[vertex_count][4], where corner_colors is null */
} lds_faces_view;

/* Hair or grass: lines with radii. Points of all strands in a row, each strand's root first. */
typedef struct lds_strands_view {
    uint32_t struct_size;
    const float* points; /* float32[point_count][3] metres */
    const float* radii;  /* float32[point_count] metres */
    size_t point_count;
    const uint32_t* counts; /* uint32[strand_count]: points of each; their sum is point_count */
    size_t strand_count;
    const int32_t* slots; /* int32[strand_count]; null: all 0. Outside 0...material_count-1 counts
                             as the nearest slot */
    const float* uvs;     /* float32[strand_count][2]: of the surface at its root; null: none */
} lds_strands_view;

typedef enum lds_projection {
    LDS_PROJECTION_FLAT = 0,   /* x and y */
    LDS_PROJECTION_BOX = 1,    /* by the side of a cube that a triangle faces most */
    LDS_PROJECTION_SPHERE = 2, /* longitude and latitude around (1/2, 1/2, 1/2) */
    LDS_PROJECTION_TUBE = 3    /* longitude around that point's z axis, and z */
} lds_projection;

/* How the texture coordinates of a slot's corners are made: their positions, moved by to_space, are
   projected. */
typedef struct lds_uv_projection {
    uint32_t struct_size;
    int32_t projection;  /* lds_projection */
    double to_space[12]; /* row-major 3x4 */
    const float* points; /* float32[vertex_count][3] to take instead of the mesh's positions; may be
                            null */
    int32_t slot;        /* only triangles of this slot; < 0: all */
    uint32_t slot_count; /* slots outside 0...slot_count-1 count as the nearest */
} lds_uv_projection;

typedef enum lds_light_kind {
    LDS_LIGHT_SUN = 0,
    LDS_LIGHT_POINT = 1,
    LDS_LIGHT_SPOT = 2,
    LDS_LIGHT_AREA = 3
} lds_light_kind;

typedef struct lds_light {
    uint32_t struct_size;
    const char* name;
    int32_t kind; /* lds_light_kind */
    double color[3];
    double power;        /* sun: W/m^2; others: W; Blender's energy units. May be negative */
    double position[3];  /* all but suns; an area's center */
    double direction[3]; /* all but points: the way the light travels */
    int32_t shadow;      /* 0: casts none */
    double radius;       /* point, spot: metres; 0: sharp shadows */
    double angle;        /* sun: its diameter in the sky, radians; 0: sharp shadows */
    double spot_size;    /* spot: the whole cone, radians, more than 0, at most pi */
    double spot_blend;   /* spot: 0 (a sharp edge) to 1 (fading from the axis on) */
    double edge_u[3];    /* area: its width and height, metres */
    double edge_v[3];
    int32_t round; /* area: 1: the ellipse inside the edges */
    double spread; /* area: light leaves only within this cone, radians; 0: the whole half space */
} lds_light;

/* Perspective: pixel (u, v) in [-1/2, 1/2]^2 looks along direction + u right + v up from position.
   Orthographic: along direction from position + u right + v up. */
typedef struct lds_camera {
    uint32_t struct_size;
    const char* name;
    int32_t orthographic;
    double position[3];
    double direction[3];
    double right[3];
    double up[3];
    double near_clip;
    double focus_distance; /* metres along the view to the sharp plane; 0: all is sharp */
    double aperture;       /* diameter of the lens's opening, metres */
} lds_camera;

typedef struct lds_world {
    uint32_t struct_size;
    uint32_t environment; /* 1 + the index of an added picture, seen all around instead of color:
                             equirectangular as Blender's, +Z up; 0: none */
    double color[3];      /* linear radiance, the same from everywhere */
    int32_t transparent;  /* 1: the background has alpha 0 */
    double environment_turn[9]; /* row-major: directions in the world -> in the picture; all 0: the
                                   same */
    double environment_strength[3]; /* times the picture's radiance */
} lds_world;

LDS_API lds_status lds_model_create(lds_model** out_model);
/* A null model is ignored. */
LDS_API void lds_model_destroy(lds_model* model);

/* Reads a .obj, .ply, .glb or .gltf file, or a store (its folder or tileset.json). A store's meshes
   are read when they are needed. LDS_ERROR_BAD_FILE, too, for a file with errors of which no
   triangle is left. */
LDS_API lds_status lds_model_read(const char* path, lds_model** out_model);
/* Writes the finest representations as .obj, .ply or .glb, told by the name's ending. */
LDS_API lds_status lds_model_write(lds_model* model, const char* path);

/* Adds a picture. out_index: its index, counted from 0; a picture with the same content keeps its
   first index. BAD_FILE, IO. */
LDS_API lds_status lds_model_add_picture(lds_model* model, const lds_picture* picture,
                                         uint32_t* out_index);
/* Finds what a folder keeps about pictures that are added (their size and mean) and baked, for the
   life of the process, and writes there what was found since the last call: it is called before
   pictures are added and after. A folder that cannot be read or written to is no error. */
LDS_API lds_status lds_pictures_keep(const char* folder);
/* The mean of a texture's value over its whole picture, colors weighted by alpha. A single number
   is the first of out_color with a channel other than COLOR. */
LDS_API lds_status lds_model_texture_mean(lds_model* model, const lds_texture* texture,
                                          double out_color[3]);
/* The operation of a step on the results a, b, c of earlier steps. */
typedef enum lds_bake_op {
    LDS_BAKE_CONSTANT = 0, /* value */
    LDS_BAKE_TEXEL = 1,    /* color and alpha of texture args[0], through its mapping */
    LDS_BAKE_CHANNEL = 2,  /* a's channel value[0] (0...3), in all channels */
    LDS_BAKE_LUMA = 3,     /* the luma of a, in all channels */
    LDS_BAKE_COMBINE = 4,  /* red of a, green of b, blue of c */
    LDS_BAKE_ADD = 5,
    LDS_BAKE_SUBTRACT = 6,
    LDS_BAKE_MULTIPLY = 7,
    LDS_BAKE_DIVIDE = 8, /* 0 where b is 0 */
    LDS_BAKE_POWER = 9,  /* 0 where it has no real value */
    LDS_BAKE_MINIMUM = 10,
    LDS_BAKE_MAXIMUM = 11,
    LDS_BAKE_MIX = 12,     /* a + c (b - a) */
    LDS_BAKE_GREATER = 13, /* 1 where a > b, else 0 */
    LDS_BAKE_ABSOLUTE = 14,
    LDS_BAKE_FLOOR = 15,
    LDS_BAKE_MODULO = 16, /* with a's sign; 0 where b is 0 */
    LDS_BAKE_RAMP = 17,   /* the table's color at a's red */
    LDS_BAKE_CURVES = 18, /* each channel of a through that channel of the table */
    LDS_BAKE_TO_HSV = 19, /* all 0...1 */
    LDS_BAKE_FROM_HSV = 20,
    LDS_BAKE_TO_SRGB = 21, /* display-encodes linear color */
    LDS_BAKE_FROM_SRGB = 22
} lds_bake_op;

typedef struct lds_bake_step {
    int32_t op;       /* lds_bake_op; works on each channel by itself unless it says otherwise */
    uint32_t args[3]; /* a, b, c: earlier steps */
    double value[4];
    const float* table; /* float32[table_count][4] over 0...1, linear between; RAMP, CURVES */
    size_t table_count;
} lds_bake_step;

typedef struct lds_bake {
    uint32_t struct_size;
    int32_t linear;              /* as in lds_picture: 0 keeps color display-encoded */
    const char* name;            /* the new picture's */
    const lds_bake_step* steps;  /* the last one's color is the texel's */
    size_t step_count;           /* at most 256 */
    const lds_texture* textures; /* to_picture takes the new picture's coordinates */
    size_t texture_count;
    int32_t width; /* 0: as the largest picture, at most 4096 a side */
    int32_t height;
} lds_bake;
/* Adds a picture computed from others, texel by texel; opaque, cut to 0...1, an 8-bit PNG.
   out_index as lds_model_add_picture's. */
LDS_API lds_status lds_model_bake_picture(lds_model* model, const lds_bake* bake, lds_job* job,
                                          uint32_t* out_index);
/* out_index: of the new material, counted from 0. */
LDS_API lds_status lds_model_add_material(lds_model* model, const lds_material* material,
                                          uint32_t* out_index);
/* Writes projected texture coordinates to out_corner_uvs (float32[corner_count][2]). Corners of
   other slots keep theirs. Coordinates that are not finite become 0. */
LDS_API lds_status lds_faces_project_uvs(const lds_faces_view* faces,
                                         const lds_uv_projection* projection,
                                         float* out_corner_uvs);
/* The most corners that a face has (as in lds_faces_view; above four the faces need triangles), or
   0 when the starts are not rising. */
LDS_API size_t lds_faces_largest(const uint32_t* face_starts, size_t face_count,
                                 size_t corner_count);
/* Adds an object with one mesh; materials[slot] are indices of added materials (none: a grey one).
   Triangles that use a non-finite vertex are left out, with a problem. */
LDS_API lds_status lds_model_add_mesh(lds_model* model, const lds_object_info* info,
                                      const lds_mesh_view* mesh, const uint32_t* materials,
                                      size_t material_count, lds_object* out_object);
LDS_API lds_status lds_model_add_faces(lds_model* model, const lds_object_info* info,
                                       const lds_faces_view* faces, const uint32_t* materials,
                                       size_t material_count, lds_object* out_object);
/* Adds an object with one mesh: for each strand a closed, tapered, smooth-shaded tube along a
   curve through its points. Tubes have three sides and, over all directions, the mean width of a
   round one. Points that lie within a quarter of the radius of a straight line share one segment.
   A strand without length or radius draws nothing. */
LDS_API lds_status lds_model_add_strands(lds_model* model, const lds_object_info* info,
                                         const lds_strands_view* strands, const uint32_t* materials,
                                         size_t material_count, lds_object* out_object);
/* Adds a group without children. */
LDS_API lds_status lds_model_add_group(lds_model* model, const lds_object_info* info,
                                       lds_object* out_object);
/* Places child in group. A group that contains itself is reported by the first call that goes
   through the model (INVALID_ARGUMENT). */
LDS_API lds_status lds_model_add_placement(lds_model* model, lds_object group, lds_object child,
                                           const double transform[12], const char* name);
/* Places many, in this order: children[count], transforms float32[count][12], names (count texts of
   UTF-8 one after the other, each ended by NUL), and the ray classes (lds_ray_class bits) each is
   hidden from as below; null: none is. All or none. */
LDS_API lds_status lds_model_add_placements(lds_model* model, lds_object group, size_t count,
                                            const lds_object* children, const float* transforms,
                                            const char* names, const uint32_t* hidden);
/* Hides a group's newest placement, with everything below it, from the ray classes in the mask
   (lds_ray_class bits). A group that holds something hidden is always drawn by its children. */
LDS_API lds_status lds_model_hide_placement(lds_model* model, lds_object group,
                                            uint32_t ray_classes);
/* A level limit or pin that is none. */
#define LDS_ANY_LEVEL UINT32_MAX

/* Sets the user's decisions about the placement at `position` of a group (counted from 0, in the
   order they were added).
   importance   how many times finer it and everything below it are drawn, 1/64 to 64; 1: no change
   coarsest     the largest LOD number that may draw it; groups around it are opened for that.
                LDS_ANY_LEVEL: no limit; 0: the originals of it and of everything below it */
LDS_API lds_status lds_model_decide_placement(lds_model* model, lds_object group, size_t position,
                                              double importance, uint32_t coarsest);
/* Pins the placement to one LOD number, from wherever it is seen; groups around it are opened. An
   object with fewer levels takes its coarsest; if the view cannot draw that kind, the nearest
   level it can. LDS_ANY_LEVEL: no pin. It replaces the `coarsest` of lds_model_decide_placement. */
LDS_API lds_status lds_model_pin_placement(lds_model* model, lds_object group, size_t position,
                                           uint32_t lod);
/* For viewers: changes a placement after the levels were built. transform: its new place (null:
   the old one); hidden: ray classes, as for lds_model_hide_placement. Groups around it are opened,
   since their stand-ins show the old state. Builds do not see the change. */
LDS_API lds_status lds_model_change_placement(lds_model* model, lds_object group, size_t position,
                                              const double transform[12], uint32_t hidden);
/* Sets where a placement is when the shutter closes, in the group's frame; null: it does not move
   in its group. Read by lds_modifiers.when_moving; not stored. */
LDS_API lds_status lds_model_move_placement(lds_model* model, lds_object group, size_t position,
                                            const double closing[12]);
/* Puts the children of a group with more than most_children (at least 8; usual 64) into nested
   groups of at most that many, by position (octree cells). Occurrences stay exactly where they
   are. Cells are fixed, so a child added in a later frame changes only the groups around it. Call
   it when the group is complete. out_added may be null. */
LDS_API lds_status lds_model_group_by_position(lds_model* model, lds_object group,
                                               uint32_t most_children, size_t* out_added);

typedef struct lds_structure_options {
    uint32_t struct_size;
    int32_t threads;          /* 0 = all */
    uint32_t fewest_children; /* groups of at most this many are left alone; usual 64, least 2 */
    uint32_t most_children;   /* the most children of a group; at least 8, usual 64 */
    uint32_t orders;          /* random orders that are tried, 1 to 1024; usual 4. More: a slightly
                                 lower cost, linearly more time */
    double similarity;        /* weight of looks (color, size, shape, orientation) beside position;
                                 0: position alone, usual 0.1 */
    double group_cost;        /* the cost of a group, counted in children; usual 8. Larger: fewer
                                 and larger groups */
    uint64_t seed;
} lds_structure_options;
LDS_API lds_status lds_structure_options_default(lds_structure_options* options);

typedef struct lds_structure_report {
    uint32_t struct_size;
    uint64_t structured; /* the given groups that were structured */
    uint64_t made;       /* the groups that were made */
    double cost_before;  /* expected number of children that a random ray through a group is tested
                            against, summed over the groups given */
    double cost_after;
    double cpu_s;
} lds_structure_report;
/* Puts the children of flat groups into nested groups of things that are near and look alike, by
   inserting one child after the other where the cost grows least. Occurrences stay exactly where
   they are. Children that deform, or hold something hidden from some rays, are not moved. The
   result depends neither on the order of the children nor on the number of threads. groups null:
   all below the root.

   source   Sewell, Managing complex models for computer graphics: 4.5.3, 4.5.4 */
LDS_API lds_status lds_model_structure(lds_model* model, const lds_object* groups,
                                       size_t group_count, const lds_structure_options* options,
                                       lds_job* job, lds_structure_report* out_report);

typedef struct lds_loose_options {
    uint32_t struct_size;
    int32_t always;            /* 1: also meshes that hardly gain by it */
    uint32_t fewest_triangles; /* triangles of a cluster; usual 8192. Larger: fewer clusters, a
                                  faster build. Smaller: detail follows distance more closely */
    uint32_t most_clusters;    /* clusters of one mesh, on average; 2 or more, usual 128 */
    int32_t threads;           /* 0 = all */
} lds_loose_options;
LDS_API lds_status lds_loose_options_default(lds_loose_options* options);

typedef struct lds_loose_report {
    uint32_t struct_size;
    uint64_t split; /* meshes that became groups */
    uint64_t parts; /* loose parts these had */
    uint64_t made;  /* objects that were made: clusters of parts, and groups of these */
    double cpu_s;
} lds_loose_report;
/* Turns meshes of many loose parts (kit-bashed scenes, joined rocks) into groups, in place. The
   children are clusters of neighboring parts with levels of their own, so that a part near the eye
   does not make the whole mesh fine. The object stays one object and one occurrence; triangles,
   normals, texture coordinates, colors and materials stay exactly the same. Meshes that deform or
   refract are not split. Without `always` a mesh is split only if it has more than 50,000
   triangles in more than 64 parts, at least half of the triangles lie in parts at most an eighth
   as large as the whole, and it was not read from a store. objects null: all below the root. Call
   it before lds_model_build. */
LDS_API lds_status lds_model_split_loose_parts(lds_model* model, const lds_object* objects,
                                               size_t object_count,
                                               const lds_loose_options* options, lds_job* job,
                                               lds_loose_report* out_report);
LDS_API lds_status lds_model_set_root(lds_model* model, lds_object root);
LDS_API lds_status lds_model_add_light(lds_model* model, const lds_light* light);
LDS_API lds_status lds_model_add_camera(lds_model* model, const lds_camera* camera);
LDS_API lds_status lds_model_set_world(lds_model* model, const lds_world* world);

typedef struct lds_totals {
    uint32_t struct_size;
    uint64_t objects;          /* reachable from the root, groups included; an object split into
                                  loose parts counts once */
    uint64_t occurrences;      /* those of leaves: each path counts */
    uint64_t triangles_placed; /* the triangles of all occurrences at full detail */
    uint64_t triangles_unique;
    uint64_t representations;
} lds_totals;
LDS_API lds_status lds_model_totals(lds_model* model, lds_totals* out_totals);

typedef struct lds_object_summary {
    uint32_t struct_size;
    const char* uid;
    const char* name;
    int32_t role;
    int32_t group; /* 1: its finest representation is an assembly */
    uint32_t representation_count;
    uint32_t child_count;
    uint64_t source_hash;
    double center[3]; /* bound, object's frame */
    double radius;
} lds_object_summary;
LDS_API size_t lds_model_object_count(const lds_model* model);
LDS_API lds_status lds_model_object_at(const lds_model* model, size_t position,
                                       lds_object* out_object);
/* out_object is {0, 0} when there is none of that uid. */
LDS_API lds_status lds_model_find_object(const lds_model* model, const char* uid,
                                         lds_object* out_object);
LDS_API lds_status lds_model_object_summary(lds_model* model, lds_object object,
                                            lds_object_summary* out_summary);

typedef struct lds_placement {
    uint32_t struct_size;
    lds_object object;
    double transform[12]; /* the object's frame -> the group's */
    const char* name;
    uint32_t hidden;   /* the ray classes that do not see it (lds_ray_class bits) */
    uint32_t coarsest; /* the largest LOD number that it may be drawn with */
    double importance;
} lds_placement;
/* position: below the summary's child_count. */
LDS_API lds_status lds_model_child(const lds_model* model, lds_object group, size_t position,
                                   lds_placement* out_placement);

/* lod 0 is the finest. */
typedef struct lds_representation {
    uint32_t struct_size;
    int32_t kind;     /* lds_kind */
    double error;     /* metres in the object's frame */
    double max_error; /* the largest distance behind the error's quantile */
    uint64_t triangles;
    uint64_t bytes; /* the bytes of POV-Ray's memory that it takes */
    uint64_t hash;
} lds_representation;
LDS_API lds_status lds_model_representation(lds_model* model, lds_object object, uint32_t lod,
                                            lds_representation* out_representation);

/* A leaf reached along one path of placements; depth-first order. */
typedef struct lds_occurrence {
    lds_object object;
    double world[12];
} lds_occurrence;
LDS_API lds_status lds_model_occurrence_count(lds_model* model, size_t* out_count);
/* Copies the first min(capacity, count). */
LDS_API lds_status lds_model_occurrence_copy(lds_model* model, lds_occurrence* out_occurrences,
                                             size_t capacity);
/* The ray classes (lds_ray_class bits) that do not see them, in the same order. */
LDS_API lds_status lds_model_occurrence_hidden(lds_model* model, uint32_t* out_ray_classes,
                                               size_t capacity);

/* Cameras and lights that were added, or that a store or file holds. */
LDS_API size_t lds_model_camera_count(const lds_model* model);
LDS_API lds_status lds_model_camera(const lds_model* model, size_t position,
                                    lds_camera* out_camera);
LDS_API size_t lds_model_light_count(const lds_model* model);

typedef enum lds_severity {
    LDS_SEVERITY_INFO = 0,
    LDS_SEVERITY_WARNING = 1,
    LDS_SEVERITY_ERROR = 2 /* the picture is wrong or incomplete there */
} lds_severity;

/* Problems of the user's data, found while adding, reading, building, exporting. */
typedef struct lds_problem {
    uint32_t struct_size;
    const char* object;
    int32_t severity; /* lds_severity */
    const char* code; /* snake_case, stable */
    const char* message;
} lds_problem;
LDS_API size_t lds_model_problem_count(const lds_model* model);
LDS_API lds_status lds_model_problem(const lds_model* model, size_t position,
                                     lds_problem* out_problem);

/* ---- Measuring ------------------------------------------------------------------------------ */

/* Area, center and inertia of a triangle surface of uniform thickness.

   out  out_area     float64     square metres
        out_center   float64[3]  metres
        out_inertia  float64[6]  xx yy zz xy yz zx, about out_center, m^4
   errors   INVALID_ARGUMENT  a null pointer; an index >= vertex_count; total area 0
   cost     O(triangle_count)
   source   Sewell, Managing complex models for computer graphics: eqs. 4.20, 4.28-4.30, A.1.1
   differs  scaling by s multiplies the tensor by s^4 (mass is area, 4.3); eq. 4.27 prints s^2 */
LDS_API lds_status lds_surface_inertia(const float* positions, size_t vertex_count,
                                       const uint32_t* triangles, size_t triangle_count,
                                       double* out_area, double out_center[3],
                                       double out_inertia[6]);

typedef struct lds_measure_options {
    uint32_t struct_size;
    int32_t threads;       /* 0 = all */
    uint64_t rays;         /* fixed budget; usual 4096. More: less noise, linearly more time */
    double relative_error; /* > 0: cast until the visible area has this relative error (95 %
                              confidence), whatever `rays` says */
    uint64_t seed;
} lds_measure_options;
LDS_API lds_status lds_measure_options_default(lds_measure_options* options);

typedef struct lds_attributes {
    uint32_t struct_size;
    double visible_area; /* VSA, m^2; open sheets count both sides */
    double surface_area; /* m^2 of all sides that could be seen, if nothing hid them */
    double centroid[3];
    double inertia[6]; /* xx yy zz xy yz zx about the centroid, m^4 */
    double normal_moment;
    double color[3]; /* mean base color by visible area, linear */
    double roughness;
    double metallic;
    double relative_error;
    uint64_t rays;
} lds_attributes;
/* Measures an object at full detail by rays (eqs. 4.16-4.19); a group with everything it places. */
LDS_API lds_status lds_model_measure(lds_model* model, lds_object object,
                                     const lds_measure_options* options, lds_job* job,
                                     lds_attributes* out_attributes);

/* ---- Simplifying ---------------------------------------------------------------------------- */

typedef enum lds_simplify_mode {
    LDS_SIMPLIFY_FAST = 0,   /* edge collapse */
    LDS_SIMPLIFY_BEST = 1,   /* edge collapse with a smaller error, in about three times the time */
    LDS_SIMPLIFY_CLUSTER = 2 /* vertex clustering: fastest; separate parts may be joined */
} lds_simplify_mode;

typedef struct lds_simplify_options {
    uint32_t struct_size;
    double ratio;       /* the share of the triangles to keep, 0...1; 0: not used */
    uint64_t triangles; /* the triangles to keep in the whole model; 0: not used */
    double error;       /* metres: the fewest triangles within it; 0: not used */
    int32_t measure;    /* 1: measure the error of the result; error and pixels always do */
    uint64_t seed;
    int32_t threads;
    double pixels;         /* as error, in pixels of a picture in which the model's largest side is
                         height_px pixels long; 0: not used */
    double height_px;      /* with pixels: more than 0 */
    int32_t mode;          /* lds_simplify_mode */
    int32_t keep_topology; /* 1: keep all parts, holes and handles, even if that misses the target;
                              not with LDS_SIMPLIFY_CLUSTER */
} lds_simplify_options;
LDS_API lds_status lds_simplify_options_default(lds_simplify_options* options);

typedef struct lds_simplify_report {
    uint32_t struct_size;
    uint64_t triangles_before;
    uint64_t triangles;
    double cpu_s;     /* CPU seconds of the simplification alone, all threads */
    double error;     /* metres in the model's frame; negative when it was not measured */
    double max_error; /* metres: the largest distance; negative when it was not measured */
} lds_simplify_report;
/* Replaces the finest mesh of every object. Exactly one of ratio, triangles, error, pixels is
   given. */
LDS_API lds_status lds_model_simplify(lds_model* model, const lds_simplify_options* options,
                                      lds_job* job, lds_simplify_report* out_report);

/* ---- Building the hierarchy ----------------------------------------------------------------- */

typedef struct lds_build_options {
    uint32_t struct_size;
    double level_ratio; /* triangles of a level over those of the next finer one; usual 0.4. Below
                           the first level of a large surface its root. Larger: more levels, a
                           closer fit to every distance, more time and disk */
    uint64_t rays;      /* rays that measure an object; usual 4096 */
    uint32_t samples;   /* points that measure an error, in each direction; usual 2048 */
    uint64_t group_triangles; /* most triangles of a group's finest stand-in; usual 40000 */
    uint64_t seed;
    int32_t threads;         /* 0 = all */
    int32_t rebuild;         /* 1: build also objects that are up to date */
    const lds_object* scope; /* build only objects that are reachable from these. Stale objects
                                elsewhere keep their finest level alone, and stay stale */
    size_t scope_count;      /* 0: everything */
    /* The same scene in a few frames, the same frames in every call: an object that deforms is
       collapsed once, to suit all of them, and its levels follow it in every frame. Objects are
       matched by uid; one whose present faces are in none of the poses is drawn at full detail. */
    const struct lds_model* const* poses;
    size_t pose_count;           /* 0: everything that deforms is drawn at full detail */
    const struct lds_view* view; /* build only the objects that save this picture most time; all
                                    others stay stale. NULL: everything */
    double share; /* with a view: the most time to build, as a share of the picture's own time (both
                     estimated from counts); usual 0.2 */
    uint64_t of_one_frame; /* 1: a store that differs in nothing but cameras, lights and the world
                              stays as it is. For the frames of an animation */
} lds_build_options;
LDS_API lds_status lds_build_options_default(lds_build_options* options);

typedef struct lds_build_report {
    uint32_t struct_size;
    uint64_t objects;         /* reachable objects of which something is seen */
    uint64_t built;           /* those of them that were new or stale */
    uint64_t representations; /* those in the store, finest included */
    uint64_t triangles;       /* the triangles of the stale objects' finest meshes */
    uint64_t bytes_written;
    double wall_s;
    double cpu_s;
    uint64_t left; /* objects still stale, because options.view does not need them */
} lds_build_report;

/* The costs of drawing in POV-Ray 3.7. Levels are built by them (a store whose levels were built by
   other costs is stale), and the bytes and times that are told are theirs. */
typedef struct lds_cost_model {
    uint32_t struct_size;
    uint64_t triangle_bytes;   /* bytes of a mesh's triangle, however often it is drawn */
    uint64_t primitive_bytes;  /* bytes of a box, an ellipsoid, each solid of a composite */
    uint64_t occurrence_bytes; /* bytes of each occurrence, whatever it draws */
} lds_cost_model;
LDS_API lds_status lds_cost_model_default(lds_cost_model* costs);

/* Tells how much lds_model_build would do: fills objects, built, triangles and wall_s (an
   estimate). */
LDS_API lds_status lds_model_build_estimate(lds_model* model, const char* store,
                                            const lds_build_options* options,
                                            lds_build_report* out_report);
/* Gives every object its stand-ins: those in the store (a folder, made when missing) where the
   source hash still matches, newly built ones elsewhere. The store is written about every 20
   seconds, so a build that was cancelled or killed continues from there; the model of a failed
   call is unchanged. One writer at a time. */
LDS_API lds_status lds_model_build(lds_model* model, const char* store,
                                   const lds_build_options* options, lds_job* job,
                                   lds_build_report* out_report);

/* ---- Choosing ------------------------------------------------------------------------------- */

typedef enum lds_lens_shape { LDS_LENS_SHAPE_SPHERE = 0, LDS_LENS_SHAPE_BOX = 1 } lds_lens_shape;
/* The meaning of a lens's list of objects. */
typedef enum lds_lens_filter {
    LDS_LENS_FILTER_ALL = 0,    /* no list: everything inside is refined */
    LDS_LENS_FILTER_REFINE = 1, /* only the listed objects, and all below them, are refined */
    LDS_LENS_FILTER_SHOW = 2    /* the same, and nothing else whose bound has its center inside the
                                   lens is drawn */
} lds_lens_filter;
/* A region of the world inside which everything is drawn up to `strength` times finer (below 1:
   coarser). The factor falls off towards the rim:
     1 + (strength - 1) cos(pi d / (2 radius))^falloff,  1 outside
   where d is the distance from the origin of the lens's frame (for a box: the largest coordinate).
   A bound takes the largest factor anywhere in it. So a group that the lens touches is opened, and
   those of its children that the lens does not touch are not refined. */
typedef struct lds_lens {
    int32_t shape;        /* lds_lens_shape */
    double transform[12]; /* its frame -> the world; a singular one: no effect */
    double radius;        /* of the sphere, or half the box's sides, in its frame; 0: no effect */
    double strength;      /* more than 0; usual 4 */
    double falloff;       /* usual 1; 0: the same everywhere inside */
    int32_t filter;       /* lds_lens_filter */
    const char* name;     /* for messages */
    const lds_object* objects; /* the list of the filter: objects and groups */
    size_t object_count;
} lds_lens;
/* The same as a disc on the image. */
typedef struct lds_screen_lens {
    int32_t in_pixels; /* 1: center and radius are pixels of the final image; 0: shares of its width
                          and height (the radius: of its width) */
    double center[2];  /* from the left and the top */
    double radius;
    double strength;
    double falloff;
    const char* name;
} lds_screen_lens;

/* The measure by which a level is good enough (5.2.2), and so the unit of lds_view.pixel_error. */
typedef enum lds_criterion {
    LDS_CRITERION_RESOLUTION = 0, /* pixels: the error of the level on screen */
    LDS_CRITERION_FEATURE = 1,    /* share of the picture that the largest missing feature covers */
    LDS_CRITERION_AREA = 2,       /* share of the picture that an object may cover with its coarsest
                                     level; four times as much with each finer one */
    LDS_CRITERION_DISTANCE = 3    /* metres up to which the original is used, twice as many for each
                                     coarser level; here a larger threshold is finer */
} lds_criterion;

/* How fine things outside of the picture are. A border does not count: the whole picture does. */
typedef enum lds_off_screen {
    LDS_OFF_SCREEN_FULL = 0,      /* as if they were in it */
    LDS_OFF_SCREEN_REFLECTED = 1, /* as their visible shadows and mirror images need */
    LDS_OFF_SCREEN_SHADOWS = 2    /* as their visible shadows need; images may be coarse */
} lds_off_screen;

/* Mask of the ray classes that may meet coarser representations than camera rays do (5.3). */
typedef enum lds_rays {
    LDS_RAYS_REFLECTION = 1,
    LDS_RAYS_SHADOW = 2,
    LDS_RAYS_RADIOSITY = 4
} lds_rays;

/* The factors that make single things finer or coarser than the view's threshold (5.5.5). All of
   them, and the placements' importances, are multiplied; the product is clamped to 1/64 ... 64. */
typedef struct lds_modifiers {
    uint32_t struct_size;
    int32_t criterion;      /* lds_criterion */
    const lds_lens* lenses; /* at most 1024, of them 64 with a list */
    size_t lens_count;
    const lds_screen_lens* screen_lenses; /* at most 1024 */
    size_t screen_lens_count;
    double depth;        /* exaggeration k, 0 to 8; 1: none. Coarser by (z / depth_focus)^(k - 1) */
    double depth_focus;  /* metres */
    int32_t when_moving; /* 1: what crosses m pixels while the shutter is open is coarser by
                            sqrt(1 + m^2). The motion is the camera's (`closing`) and that of
                            lds_model_move_placement */
    int32_t when_dark;   /* 1: what the lamps and the world light so little that a white surface
                            would be displayed below 1/2 is coarser, unless the world behind it is
                            brighter */
    const lds_camera* closing; /* the camera when the shutter closes; null: it rests */
    int32_t off_screen;        /* lds_off_screen */
    uint32_t ray_classes;      /* lds_rays that may meet coarser levels; 0: none */
} lds_modifiers;
LDS_API lds_status lds_modifiers_default(lds_modifiers* modifiers);

typedef struct lds_view {
    uint32_t struct_size;
    int32_t width; /* pixels of the final image */
    int32_t height;
    const lds_camera* camera;
    double pixel_error; /* T, usual 1; larger is coarser and cheaper; 0 = originals */
    uint32_t kinds;     /* bit (1 << lds_kind) for each kind the consumer can draw; 0 = all, also
                           those of later versions */
    int32_t border[4];  /* the part of the image that is drawn: left, top, width, height in pixels;
                           width 0: all of it */
    const lds_modifiers* modifiers; /* null: none */
} lds_view;

typedef struct lds_cut lds_cut;
LDS_API lds_status lds_cut_create(lds_model* model, const lds_view* view, lds_job* job,
                                  lds_cut** out_cut);
/* Makes `cut` the cut of another view of its model, bit for bit the one that lds_cut_create would
   make. From the second call on it takes a fraction of the time if only the camera has moved or
   turned, or detail lenses that hide nothing have changed. Strings, colors and surfaces of the old
   cut are gone. On failure the cut is unchanged. */
LDS_API lds_status lds_cut_step(lds_model* model, lds_cut* cut, const lds_view* view, lds_job* job);

/* The most that a cut may cost. */
typedef struct lds_budget {
    uint32_t struct_size;
    uint64_t triangles; /* triangles as placed; 0: any number */
    uint64_t bytes;     /* bytes of POV-Ray's memory, shared representations counted once; 0: any
                           number */
} lds_budget;
typedef struct lds_budget_report {
    uint32_t struct_size;
    int32_t fits;       /* 0: even the coarsest cut costs more, and that one is returned */
    double pixel_error; /* the smallest threshold, not below the view's, whose cut fits */
    uint64_t cuts;      /* traversals of the model this took: at most 3 */
} lds_budget_report;
/* The finest cut within the budget. A larger budget never gives a coarser cut. */
LDS_API lds_status lds_cut_create_within(lds_model* model, const lds_view* view,
                                         const lds_budget* budget, lds_job* job,
                                         lds_budget_report* out_report, lds_cut** out_cut);
LDS_API void lds_cut_destroy(lds_cut* cut);

typedef struct lds_cut_summary {
    uint32_t struct_size;
    uint64_t occurrences; /* chosen ones, each drawn once */
    uint64_t opened;      /* groups drawn by their children */
    uint64_t originals;   /* occurrences drawn at LOD 0 */
    uint64_t triangles;   /* triangles as placed; of large surfaces those that POV-Ray draws */
    uint64_t bytes;       /* the bytes of POV-Ray's memory that they take */
    double largest_error_px;
    const char* largest_error_name;               /* path of placements */
    uint64_t largest_error_choice;                /* its position among the choices */
    uint64_t occurrences_of_kind[LDS_KIND_COUNT]; /* drawn by each lds_kind */
} lds_cut_summary;
LDS_API lds_status lds_cut_get_summary(const lds_cut* cut, lds_cut_summary* out_summary);

typedef struct lds_choice {
    lds_object object;
    uint32_t lod;
    int32_t kind;
    double error_px;
    double world[12];
} lds_choice;
LDS_API size_t lds_cut_choice_count(const lds_cut* cut);
LDS_API lds_status lds_cut_choice_copy(const lds_cut* cut, lds_choice* out_choices,
                                       size_t capacity);
/* How many occurrences each level is drawn by, by object and LOD number, rising. out_count: of
   how many; the first capacity of them are copied. */
typedef struct lds_level_use {
    lds_object object;
    uint32_t lod;
    uint32_t unused; /* 0 */
    uint64_t occurrences;
} lds_level_use;
LDS_API lds_status lds_cut_level_uses(const lds_cut* cut, lds_level_use* out_uses, size_t capacity,
                                      size_t* out_count);
/* Names of the placements from the root, joined by '/'. */
LDS_API const char* lds_cut_choice_path(lds_cut* cut, size_t position);

/* Why a choice was made: its error_px * factor is at most the Pixel Error, and that of the next
   coarser level (coarser_error_px * coarser_factor) is not, or a pin forbids that level. */
typedef struct lds_reason {
    uint32_t struct_size;
    uint32_t lod;      /* the LOD number of the choice */
    int32_t pinned;    /* 1: a decision about a placement forbids the next coarser level */
    uint32_t unused;   /* 0 */
    double z;          /* metres from the eye to its bound, at least the near clip */
    double pixel;      /* size of a pixel at that distance, metres */
    double error;      /* metres in the object's frame */
    double stretch;    /* factor by which its placements enlarge it */
    double error_px;   /* error * stretch / pixel */
    double factor;     /* all that refines / all that coarsens, within 1/64 ... 64; infinite where
                          a lens hides part of it. importance, demand, lenses and screen_lenses
                          refine; a later factor says what it does, where it stands */
    double importance; /* that of its placements */
    double demand;     /* largest importance below it; infinite where a level limit lies below */
    double lenses;
    double screen_lenses;
    double depth; /* coarsens, as motion, darkness and off_screen do */
    double motion;
    double darkness;
    double off_screen;
    lds_object coarser_object; /* the next coarser level is this object's: the choice's own, or the
                                  nearest group around it that has one; {0, 0}: there is none */
    uint32_t coarser_lod;
    int32_t coarser_kind;
    double coarser_error;    /* metres in that object's frame */
    double coarser_error_px; /* on screen */
    double coarser_factor;
} lds_reason;
/* model: the one the cut was made from, with the same levels. */
LDS_API lds_status lds_cut_choice_reason(lds_model* model, const lds_cut* cut, size_t position,
                                         lds_reason* out_reason);
/* The representations that a class of rays meets instead of the camera's: their number and size. */
typedef struct lds_ray_summary {
    uint32_t struct_size;
    uint32_t rays;           /* the class: one of lds_rays */
    uint64_t own;            /* coarser representations of occurrences and groups that it meets */
    uint64_t occurrences;    /* all occurrences that it meets */
    uint64_t triangles;      /* their triangles as placed */
    uint64_t bytes;          /* the bytes of POV-Ray's memory that they take */
    double largest_error_px; /* upper bound: how far they shift shadow edges or mirror images */
    /* Choices that the class meets as the camera does, and why: */
    uint64_t kept_need;     /* nothing coarser is good enough */
    uint64_t kept_shape;    /* a stand-in would shadow or mirror its own original */
    uint64_t kept_contact;  /* something else is too near */
    uint64_t all_triangles; /* triangles as placed that the camera or any class meets */
    uint64_t all_bytes;     /* the bytes of POV-Ray's memory that they take */
} lds_ray_summary;
/* rays: one class. For a class that the cut's modifiers do not ask for, the camera's numbers. */
LDS_API lds_status lds_cut_get_rays(const lds_cut* cut, uint32_t rays,
                                    lds_ray_summary* out_summary);
typedef enum lds_met {
    LDS_MET_OFF = 0,    /* the class was not asked for, or does not meet this choice */
    LDS_MET_OWN = 1,    /* a coarser representation of its own */
    LDS_MET_GROUP = 2,  /* a stand-in for a group around it */
    LDS_MET_NEED = 3,   /* as the camera's: nothing coarser is good enough */
    LDS_MET_SHAPE = 4,  /* as the camera's: a stand-in would shadow or mirror its own original */
    LDS_MET_CONTACT = 5 /* as the camera's: something else is too near */
} lds_met;
/* The representation that a class of rays meets for one choice. */
typedef struct lds_ray_choice {
    uint32_t struct_size;
    int32_t met;       /* lds_met */
    lds_object object; /* the object whose representation it meets */
    uint32_t lod;
    int32_t kind;
    double scale;    /* the factor of a box or ellipsoid about its center, so that it lies inside
                        the original (shadows) or around it (reflections) */
    double error;    /* metres in the world; 0 where it meets the camera's representation */
    double error_px; /* upper bound: how far edges of its shadow or mirror image are off */
} lds_ray_choice;
LDS_API lds_status lds_cut_choice_rays(lds_model* model, const lds_cut* cut, size_t position,
                                       uint32_t rays, lds_ray_choice* out_choice);
/* How a cut draws one thing of the scene. */
typedef enum lds_drawn {
    LDS_DRAWN_MISSING = 0,  /* not at all: the model has no such occurrence */
    LDS_DRAWN_ITSELF = 1,   /* by a level of its own */
    LDS_DRAWN_IN_GROUP = 2, /* by a stand-in for a group around it */
    LDS_DRAWN_OPENED = 3,   /* it is a group, drawn by its children */
    LDS_DRAWN_NOT = 4       /* not at all: hidden from all rays, or by a lens */
} lds_drawn;
/* Finds how an occurrence is drawn: that of `object` whose transform is nearest to `world` (within
   1/1000 of its distance from the origin, or 1 mm). out_position: the choice that draws it, set for
   ITSELF and IN_GROUP. */
LDS_API lds_status lds_cut_find_choice(lds_model* model, const lds_cut* cut, lds_object object,
                                       const double world[12], int32_t* out_drawn,
                                       size_t* out_position);
/* The path of placements from a group to the thing below it that has the largest importance, or a
   level limit, and for which the group is opened; "" if there is none. Valid until this thread's
   next call of it. */
LDS_API lds_status lds_model_most_demanding(lds_model* model, lds_object group,
                                            const char** out_path);
/* Frees the meshes that can be read again from the store the model was built with; this is done
   when they are needed. */
LDS_API lds_status lds_model_release_meshes(lds_model* model);

/* Sets the linear colors in which surfaces, batches and pictures with
   lds_povray_options.false_color show the choices: colors float64[choice count][3], 0 to 1, in the
   order of the choices. count 0: back to those of lds_povray_false_color. */
LDS_API lds_status lds_cut_set_colors(lds_cut* cut, const double* colors, size_t count);
/* Gives each choice a unique color, from which lds_image_compare_shown finds it in a picture. */
LDS_API lds_status lds_cut_set_identities(lds_cut* cut);
/* Makes an unindexed triangle list of all that cameras see of the cut, of about most_triangles at
   most: if there are more, coarser levels or boxes are shown. Kept with the cut until the next
   call; 0 frees the list. */
LDS_API lds_status lds_cut_make_surface(lds_model* model, lds_cut* cut, uint64_t most_triangles,
                                        lds_job* job, uint64_t* out_triangles);
/* out_corners float32[triangles][3][3], in the world; out_colors uint8[triangles][3][4], sRGB and
   opaque, shaded as by light from above. capacity counts triangles. */
LDS_API lds_status lds_cut_surface_copy(const lds_cut* cut, float* out_corners, uint8_t* out_colors,
                                        size_t capacity);

/* Divides all that cameras see of a cut into batches for a viewer that keeps them on the GPU.
   Batches of different cuts with equal keys show the same (colors of lds_cut_set_colors included),
   so the viewer creates only those whose key is new. Kept with the cut until the next call. */
LDS_API lds_status lds_cut_make_batches(lds_model* model, lds_cut* cut, size_t* out_count);
/* out_keys uint64[count], never 0; out_triangles uint64[count], an estimate for composites. */
LDS_API lds_status lds_cut_batch_keys(const lds_cut* cut, uint64_t* out_keys,
                                      uint64_t* out_triangles, size_t capacity);
typedef struct lds_batch lds_batch;
/* Reads the meshes that a batch needs and merges them. The batch may outlive cut and model. */
LDS_API lds_status lds_batch_create(lds_model* model, const lds_cut* cut, size_t position,
                                    lds_job* job, lds_batch** out_batch);
LDS_API void lds_batch_destroy(lds_batch* batch);
LDS_API size_t lds_batch_vertex_count(const lds_batch* batch);
LDS_API size_t lds_batch_triangle_count(const lds_batch* batch);
/* Its bounding box in the world: the lower corner, then the upper one; zeros for an empty batch. */
LDS_API lds_status lds_batch_box(const lds_batch* batch, double out_box[6]);
/* out_positions float32[vertices][3], in the world; out_normals int16[vertices][4]: unit normals
   times 32767, zero on flat shaded surfaces, and in the fourth number 32767 where the surface
   glows; out_colors uint8[vertices][4]: sRGB and opacity; out_triangles uint32[triangles][3]. */
LDS_API lds_status lds_batch_copy(const lds_batch* batch, float* out_positions,
                                  int16_t* out_normals, uint8_t* out_colors,
                                  uint32_t* out_triangles);

/* ---- POV-Ray -------------------------------------------------------------------------------- */

typedef enum lds_antialias {
    LDS_ANTIALIAS_OFF = 0,
    LDS_ANTIALIAS_FINAL = 1,    /* adaptive, for pictures */
    LDS_ANTIALIAS_REFERENCE = 2 /* 16 samples in every pixel */
} lds_antialias;

typedef struct lds_povray_options {
    uint32_t struct_size;
    int32_t antialias;    /* lds_antialias; usual FINAL */
    int32_t false_color;  /* 1: paint by kind and LOD number */
    int32_t covered_only; /* 1: without environment objects and world, so that alpha is the mask of
                             covered pixels */
    int32_t threads;      /* 0 = all */
    const char* program;  /* null: $LODESTONE_POVRAY, else povray on the PATH */
    /* How finely the picture is shaded; 0 is the usual value. Larger errors are cheaper. */
    double antialias_threshold; /* FINAL: difference of neighbors that adds samples; usual 0.1 */
    int32_t antialias_depth;    /* FINAL: n, for n x n samples in such a pixel; usual 3 */
    int32_t trace_depth;        /* most mirrors and glass bodies one behind the other, fewer where
                                   the next one could not show; usual 5 */
    int32_t area_samples; /* shadow rays along the edge of a lamp, made 2^n + 1; 1: sharp shadows;
                             usual 17, with OFF 1 */
    int32_t sky_lights;   /* the most lights that stand for the peaks of an environment image, or,
                             without sky_rays or with bounces, for all of it; below 0: none; usual
                             24, with OFF 12, with REFERENCE 64 */
    double shadow_error;  /* pixels: a penumbra narrower than this is drawn sharp; usual the view's
                             pixel_error */
    double light_error; /* replaces the view's Pixel Error where lamps are left out, or joined into
                             lights that stand for several: on average a point is off by about as
                             many 255ths, and always by up to 1/1024 of its light (a view of Pixel
                             Error 0); 0: every lamp lights everything, as it is; negative (usual):
                             the view's */
    double reflection_error; /* 255ths: rays that add less are not followed; usual 1 */
    double texture_error;    /* pixels that image textures may be blurred by; usual 0: as fine as
                                the samples of pixels show */
    int32_t bounces;         /* bounces of indirect light, up to 8; usual 0: direct light only */
    int32_t bounce_rays;     /* rays that gather indirect light; usual 200, OFF 60, REFERENCE 800 */
    double bounce_error;     /* 0...1: how far gathered light is interpolated; usual 0.6, with OFF
                                1, with REFERENCE 0.4 */
    int32_t sky_rays; /* rays by which each corner of a mesh finds how much of the sky's uniform
                         light reaches it, half as many where triangles are small, up to 1024; below
                         0: all of it reaches everything; usual 128, with OFF none. Nothing with
                         bounces, which do it */
    int32_t still; /* 1: a picture alone: what moves in an animation shades what is around it, and
                      is shaded, as if it rested, faces that are seen from behind have the sky's
                      light of that side, the largest copies have that of where they stand, and gloss
                      shows the lit surfaces around. Usual 0: so that no frame needs rays anew, what
                      moves hides the sky from itself alone, and nothing changes with the camera */
    double filter_size; /* pixels: of the Blackman-Harris filter that blurs the picture, as Cycles'
                           and Eevee's do (usually 1.5 there); usual 0: each pixel is what its
                           square shows. Never where false_color or covered_only is set, nor in
                           pictures of more than 67 million pixels */
    const char* bake_folder; /* a folder that keeps what such rays found, for the next
                                picture: that of the store; null: the scene's own folder */
} lds_povray_options;
LDS_API lds_status lds_povray_options_default(lds_povray_options* options);

typedef struct lds_export_report {
    uint32_t struct_size;
    uint64_t bytes; /* bytes of all files the scene uses */
    uint64_t files;
    uint64_t written;   /* files that were not there yet */
    double cpu_s;       /* of the whole process while they were written */
    uint64_t lamps;     /* lights but suns */
    double lights_each; /* lights, of one lamp or standing for several, per point of the picture, on
                           average */
    uint64_t unseen;    /* occurrences that the camera does not see, but some class of rays meets */
    uint64_t left_out; /* occurrences of the cut that are not written, for the picture neither shows
                           them nor their shadows; only where the view's off_screen is not FULL */
    uint64_t left_out_bytes; /* of POV-Ray's memory as the cut counts it, for these and for parts of
                                meshes, about */
    uint64_t sky_copies; /* representations written once more, for copies that see another share of
                            the sky */
    uint64_t cut_triangles; /* about how many triangles masks that are cut out become, beyond those
                               of the cut; within its memory budget but for an eighth */
    double shadow_rays;     /* from a point of the picture to suns and lamps, about, on average */
    double lamp_rays;       /* of these, those to lamps */
    uint64_t sky_lights;    /* of these, one each to the lights that stand for the world's image */
    uint64_t soft_lamps;    /* lamps, and lights that stand for several, with soft shadows */
    uint64_t text_bytes;    /* of `bytes`, those of texts: meshes and scene.pov */
    uint64_t texels;        /* of all pictures that the scene uses, as they are written */
    double covered; /* the share of the picture where anything is seen, about; 1: not known */
} lds_export_report;
/* Writes scene.pov, scene.ini and r/<16 hex>.inc into folder, with the model's lights and world. */
LDS_API lds_status lds_povray_export(lds_model* model, const lds_cut* cut, const lds_view* view,
                                     const char* folder, const lds_povray_options* options,
                                     lds_job* job, lds_export_report* out_report);

typedef struct lds_povray_report {
    uint32_t struct_size;
    int32_t exit_code;
    double parse_cpu_s;
    double trace_cpu_s;
    double wall_s;
    uint64_t peak_bytes; /* largest resident memory (VmHWM) */
} lds_povray_report;
/* Renders folder/scene.ini to folder/<picture> (ending .exr or .png). POVRAY_FAILED comes with
   POV-Ray's own sentence. If the call fails or is cancelled, an older picture stays as it was. */
LDS_API lds_status lds_povray_run(const char* folder, const char* picture,
                                  const lds_povray_options* options, lds_job* job,
                                  lds_povray_report* out_report);
/* A picture while POV-Ray draws it, for somebody who looks meanwhile: a mosaic of squares first, then
   finished rectangles. */
typedef struct lds_live_picture lds_live_picture;
/* part int32[4]: left, top, width, height of what is drawn of the whole picture: the view's border,
   else all of it. */
LDS_API lds_status lds_live_picture_create(const int32_t part[4], lds_live_picture** out_picture);
/* Not while a call draws into it. */
LDS_API void lds_live_picture_destroy(lds_live_picture* picture);
/* Hands out a rectangle that was drawn since it was handed out last, from any thread. Call it until
   there is none.
   bottom_up    1: rows and out_part count from the lowest row (Blender's order)
   out_part     int32[4]: left, top (or bottom), width, height, within the part; width 0: none
   out_pixels   float32[height][width][4]: linear RGBA, associated alpha, as lds_image_read_part
                will read it from the finished picture
   capacity     counts floats; room for 32 x 32 pixels is the least */
LDS_API lds_status lds_live_picture_take(lds_live_picture* picture, int32_t bottom_up,
                                         int32_t out_part[4], float* out_pixels, size_t capacity);
/* The number of finished pixels: those of the mosaic do not count. */
LDS_API lds_status lds_live_picture_finished(lds_live_picture* picture, uint64_t* out_pixels);
/* Does what lds_povray_run does, and draws into `live` meanwhile; after a failure it has what was
   drawn before.
   With options.bounces there is no mosaic but the one that gathering light draws anyway: more of it
   would gather more, and the finished picture would not be the one of lds_povray_run. */
LDS_API lds_status lds_povray_run_live(const char* folder, const char* picture,
                                       const lds_povray_options* options, lds_live_picture* live,
                                       lds_job* job, lds_povray_report* out_report);
/* peak_bytes of an empty picture of this size: subtract it to know what a scene costs. Measured by
   running POV-Ray, then remembered for the life of the process. */
LDS_API lds_status lds_povray_empty_bytes(int32_t width, int32_t height, const char* program,
                                          uint64_t* out_bytes);
/* The program that would be run. POVRAY_MISSING says what to do. */
LDS_API lds_status lds_povray_find(const char* program, const char** out_path);
/* The color lds_povray_options.false_color gives a representation (linear). */
LDS_API lds_status lds_povray_false_color(int32_t kind, uint32_t lod, double out_color[3]);

/* ---- Pictures ------------------------------------------------------------------------------- */

/* Size of a PNG, JPEG or EXR. */
LDS_API lds_status lds_image_size(const char* path, int32_t* out_width, int32_t* out_height);
/* Linear RGBA, associated alpha. bottom_up 1: the lowest row first (Blender's order).
   out_pixels float32[height][width][4]; capacity counts floats. */
LDS_API lds_status lds_image_read(const char* path, int32_t bottom_up, float* out_pixels,
                                  size_t capacity);
/* The same of a part of an EXR, of any size: part int32[4]: left, top, width, height. It takes no
   memory for the rest, and lds_image_size is not needed before. */
LDS_API lds_status lds_image_read_part(const char* path, const int32_t part[4], int32_t bottom_up,
                                       float* out_pixels, size_t capacity);
/* Linear RGBA (associated alpha, top row first) -> 8-bit sRGB PNG. */
LDS_API lds_status lds_image_write_png(const char* path, int32_t width, int32_t height,
                                       const float* pixels);

/* Adds lines of text to a PNG, as its readers show them ("Comment", "Software"): keywords of 1 to
   79 characters. Lines of the same keyword are replaced; what is not ASCII becomes '?'. All or
   nothing. */
LDS_API lds_status lds_image_add_text(const char* path, const char* const* keywords,
                                      const char* const* texts, size_t count);

typedef struct lds_difference {
    uint32_t struct_size;
    double mean; /* over the compared pixels; of display-encoded values 0...1 */
    double p999; /* 99.9 % quantile */
    double max;
    double ssim; /* structural similarity of luma, 11x11 Gaussian */
    uint64_t pixels;
} lds_difference;
/* mask (may be null): a picture whose alpha > 1/255 marks the covered pixels. */
LDS_API lds_status lds_image_compare(const char* path_a, const char* path_b, const char* mask,
                                     lds_difference* out_difference);
/* Compares two pictures where either shows something, and tells which choices differ.
   shown_a, shown_b   linear pictures of the two cuts, made after lds_cut_set_identities with
                      false_color and covered_only, without antialiasing
   out_a, out_b       float64[count_a], float64[count_b]: for each choice the sum over its pixels of
                      the mean difference of R, G and B. A pixel belongs to the choice that shown_a
                      shows there, or, where it shows none, to that of shown_b
   out_picture        float32[height][width][4]: the differences as lds_image_difference_color gives
                      them; may be null. capacity counts floats */
LDS_API lds_status lds_image_compare_shown(const char* path_a, const char* path_b,
                                           const char* shown_a, const char* shown_b, double* out_a,
                                           size_t count_a, double* out_b, size_t count_b,
                                           int32_t bottom_up, float* out_picture, size_t capacity,
                                           lds_difference* out_difference);
/* The color (linear) of a difference of display-encoded values: 0 black, 0.02 blue, 0.05 green, 0.1
   yellow, 0.25 and more red. */
LDS_API lds_status lds_image_difference_color(double difference, double out_color[3]);

#ifdef __cplusplus
}
#endif

#endif /* LODESTONE_LODESTONE_H */
