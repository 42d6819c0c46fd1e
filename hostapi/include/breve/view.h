/* breve/view.h: what there is to see in a world. A host with a renderer of its own reads the scene: instances of shared
 * meshes, lines, text, cameras, lights. Any other host has the library draw it into an array of pixels, without a screen.
 *
 *     breve_scene* scene;                                   breve_view* view;
 *     breve_scene_create(&scene);                           breve_view_create(runtime, NULL, &view);
 *     breve_scene_read(scene, world);                       breve_view_render(view, world, pixels, 0);
 *     breve_scene_rows(scene, BREVE_SCENE_INSTANCES, &rows);
 *
 * The rules of breve.h also hold here. Neither a scene nor a view belongs to a world: each reads the world that it is
 * given, at that moment, changes nothing in it, and keeps only copies. A scene or a view is used by one thread at a time;
 * different ones may be used by different threads. Their memory comes from the C++ allocator. While none is made nothing
 * of this costs anything: no mesh is built, no picture is decoded, no graphics library is loaded.
 *
 * Numbers here are float, as renderers take them; what is too large for one is cut off at 1e18. Colours are red, green,
 * blue and alpha from 0 to 1, encoded as sRGB, as scripts give them.
 */
#ifndef BREVE_VIEW_H
#define BREVE_VIEW_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the scene --------------------------------------------------------------------------------------------------- */

typedef struct breve_scene breve_scene;

/* Rows that lie in an array of the library: the first one, how many there are, and the bytes from one to the next. These
   rows grow as structs with struct_size do: a later library may have longer ones, so a host steps by `stride`. They are
   good until the next call of breve_scene_read on that scene. */
typedef struct breve_rows {
  const void* data; /* NULL if there are none */
  size_t count;
  size_t stride;
} breve_rows;

/* What a scene has rows of. */
typedef enum breve_scene_kind {
  BREVE_SCENE_INSTANCES = 0, /* breve_instance, in order of creation */
  BREVE_SCENE_MESHES = 1,    /* breve_mesh */
  BREVE_SCENE_TEXTURES = 2,  /* breve_texture */
  BREVE_SCENE_LINES = 3,     /* breve_line: drawings, traces, springs, lines to neighbours, bounding boxes, axes */
  BREVE_SCENE_TRIANGLES = 4, /* breve_vertex, three for each triangle: polygons that scripts draw */
  BREVE_SCENE_SPRITES = 5,   /* breve_sprite: pictures that face the camera, and points */
  BREVE_SCENE_SHEETS = 6,    /* breve_sheet: flat grids of cells. Cells of other grids are instances of the box */
  BREVE_SCENE_LABELS = 7,    /* breve_label */
  BREVE_SCENE_TEXTS = 8,     /* breve_overlay_text */
  BREVE_SCENE_CAMERAS = 9,   /* breve_camera, the main one first */
  BREVE_SCENE_LIGHTS = 10    /* breve_light, the main one first */
} breve_scene_kind;

#define BREVE_NO_TEXTURE UINT32_MAX

/* A mesh drawn at a place. */
typedef struct breve_instance {
  breve_object object;    /* the body or grid that it shows */
  float transform[12];    /* three rows of four: world = transform * (x, y, z, 1) */
  float color[4];
  float texture_scale[2]; /* length units that one tile of the texture takes, across and along */
  uint32_t mesh;          /* row of BREVE_SCENE_MESHES */
  uint32_t texture;       /* row of BREVE_SCENE_TEXTURES, or BREVE_NO_TEXTURE */
  uint32_t casts_shadow;  /* 0 or 1 */
  uint32_t fixed;         /* 1: a Stationary or Terrain */
} breve_instance;

/* Triangles that instances share. Bodies with shapes that look alike have the same mesh: there is one for all spheres. */
typedef struct breve_mesh {
  const float* positions; /* 3 for each vertex; NULL in a row that is not in use */
  const float* normals;   /* 3 for each vertex, of unit length */
  const float* uvs;       /* 2 for each vertex: 0 to 1 over a terrain, else 0 */
  const float* colors;    /* 3 for each vertex, in place of the instance's; NULL: none */
  const uint32_t* indices; /* 3 for each triangle, counter-clockwise seen from outside */
  size_t vertex_count, index_count;
  uint64_t revision;      /* another number when this row holds another mesh, or a changed one */
} breve_mesh;

typedef struct breve_texture {
  breve_object image;  /* the Image object */
  const uint8_t* rgba; /* 4 for each pixel, rows from the top; NULL in a row that is not in use */
  uint32_t width, height;
  uint64_t revision;   /* another number when the pixels are others */
} breve_texture;

typedef struct breve_line {
  float from[3], to[3];
  float color[4];
  float width;      /* pixels */
  uint32_t pattern; /* bit i of 16: the i-th two pixels are drawn, over and over */
} breve_line;

typedef struct breve_vertex {
  float position[3];
  float color[4];
} breve_vertex;

typedef struct breve_sprite {
  breve_object object;
  float center[3];
  float size;       /* its side in length units; of a point: its diameter in pixels */
  float heading;    /* rad, counter-clockwise on the screen */
  float color[4];
  uint32_t texture; /* row of BREVE_SCENE_TEXTURES */
  uint32_t glow;    /* 1: it is added to what is behind it */
  uint32_t point;   /* 1: a disc without a texture */
} breve_sprite;

typedef struct breve_sheet {
  breve_object object;
  float corner[3], across[3], along[3]; /* its low corner and its sides */
  uint32_t columns, rows;
  const uint8_t* rgba; /* a pixel for each cell, those along `across` first */
  uint64_t revision;
} breve_sheet;

typedef struct breve_label {
  breve_object object;
  float place[3]; /* the text stands above it */
  const char* text;
} breve_label;

typedef struct breve_overlay_text {
  const char* text;
  float x, y; /* of the picture, -1 to 1: where its baseline begins */
  float color[3];
} breve_overlay_text;

/* A camera stands at target + offset. Without rotation it looks along -z; it is pitched about x, then turned about y. */
typedef struct breve_camera {
  breve_object object; /* null: the controller's */
  double target[3], offset[3];
  double pitch, yaw;      /* rad */
  double field_of_view;   /* rad, vertical */
  double far_plane;       /* length units */
  double window[4];       /* x, y, width, height in pixels from the lower left; all 0: the whole picture */
  uint32_t automatic;     /* 1: the program has placed none, and whoever draws shows the whole scene */
  uint32_t orthographic;  /* 1: half the height of the picture is distance * tan(field_of_view / 2) */
} breve_camera;

typedef struct breve_light {
  double position[3];
  float ambient[3], diffuse[3], specular[3]; /* factors, not encoded */
} breve_light;

/* What there is one of. */
typedef struct breve_backdrop {
  size_t struct_size; /* as breve_backdrop_default gives it */
  float color[3];
  uint32_t texture;   /* row of BREVE_SCENE_TEXTURES, or BREVE_NO_TEXTURE */
  float scroll[2];    /* texture widths and heights by which it has slid */
  uint32_t mountains; /* 1: the built-in sky box */
  uint32_t fog;       /* 1: on */
  float fog_start, fog_end, fog_intensity; /* length units from the camera */
  float fog_color[3];
  uint32_t dimension; /* 2 or 3 */
  uint32_t lighting, shadows, reflections, outline, text; /* 0 or 1: what the program has switched on */
  double time;        /* simulated, s */
  uint64_t iteration;
  uint32_t skybox[6];   /* rows of BREVE_SCENE_TEXTURES: front (-z), back, left (-x), right, top, bottom; drawn if none is
                           BREVE_NO_TEXTURE */
  uint32_t every_frame; /* 1: a window should draw after every iteration; 0: it may leave out pictures */
} breve_backdrop;

/* All zero, to be filled in. */
static inline breve_backdrop breve_backdrop_default(void) {
  breve_backdrop backdrop;
  breve_clear(&backdrop, sizeof backdrop);
  backdrop.struct_size = sizeof backdrop;
  return backdrop;
}

/* An empty scene.
   @param scene  to be given back to breve_scene_destroy
   BREVE_OK; BREVE_ERROR_MEMORY. */
BREVE_API breve_status breve_scene_create(breve_scene** scene);

/* NULL is nothing. */
BREVE_API void breve_scene_destroy(breve_scene* scene);

/* Read what there is to see in the world now. Meshes and textures keep their rows from one reading to the next. Runs no
   script, changes nothing that breve_world_hash covers. May be called from a callback while script runs.
   BREVE_OK; BREVE_ERROR_MEMORY: then the scene is empty. */
BREVE_API breve_status breve_scene_read(breve_scene* scene, breve_world* world);

/* The rows of one part of what was read last.
   @param part  breve_scene_kind
   BREVE_OK; BREVE_ERROR_ARGUMENT. */
BREVE_API breve_status breve_scene_rows(const breve_scene* scene, uint32_t part, breve_rows* rows);

/* BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_scene_backdrop(const breve_scene* scene, breve_backdrop* backdrop);

/* The main camera for a picture of that size: the program's, or one that shows all that moves. Shape of the picture alone
   counts. An automatic camera glides from one call to the next, so that it does not jump.
   BREVE_OK; BREVE_ERROR_ARGUMENT: a side is 0. */
BREVE_API breve_status breve_scene_camera(breve_scene* scene, uint32_t width, uint32_t height, breve_camera* camera);

/* Where a camera sees a point.
   @param seen  pixels from the left and from the top of the picture; and the distance along the line of sight
   BREVE_OK; BREVE_ERROR_ARGUMENT; BREVE_ERROR_NOT_FOUND: it is behind the camera. */
BREVE_API breve_status breve_camera_project(const breve_camera* camera, uint32_t width, uint32_t height,
                                            const double point[3], double seen[3]);

/* ---- pictures ---------------------------------------------------------------------------------------------------- */

/* Draws scenes in main memory (OpenGL on OSMesa). */
typedef struct breve_view breve_view;

typedef enum breve_look {
  BREVE_LOOK_FULL = 0, /* what a program leaves open is made good-looking: soft light, sky, haze */
  BREVE_LOOK_PLAIN = 1 /* nothing but the colours and lights that the program sets */
} breve_look;

typedef struct breve_view_config {
  size_t struct_size; /* as breve_view_config_default gives it */
  uint32_t width, height; /* pixels, 1 to 16384. Default 640 x 480 */
  uint32_t samples;   /* of each pixel, against jagged edges: 1, 2 or 4. Default 4 */
  uint32_t look;      /* breve_look. Default BREVE_LOOK_FULL */
  const char* font;   /* a file of TrueType or OpenType, read now; NULL: DejaVu Sans. Without it no text is drawn. Default
                         NULL */
} breve_view_config;

/* The defaults named above. */
static inline breve_view_config breve_view_config_default(void) {
  breve_view_config config;
  breve_clear(&config, sizeof config);
  config.struct_size = sizeof config;
  config.width = 640;
  config.height = 480;
  config.samples = 4;
  return config;
}

/* What the last picture took. */
typedef struct breve_view_counters {
  size_t struct_size; /* as breve_view_counters_default gives it */
  uint64_t draw_calls; /* does not grow with the number of bodies of one shape */
  uint64_t instances, triangles;
  uint64_t uploads; /* meshes and textures that were new */
} breve_view_counters;

/* All zero, to be filled in. */
static inline breve_view_counters breve_view_counters_default(void) {
  breve_view_counters counters;
  breve_clear(&counters, sizeof counters);
  counters.struct_size = sizeof counters;
  return counters;
}

/* Make a view: this is when the graphics library is loaded.
   @param config  copied; NULL: the defaults
   @param view    to be given back to breve_view_destroy
   BREVE_OK; BREVE_ERROR_ARGUMENT: a size, a number of samples or a look that there is none of; BREVE_ERROR_FILE: no font;
   BREVE_ERROR_UNSUPPORTED: OSMesa is not installed, or the library was built without BREVE_WITH_RENDER. The text is in
   breve_runtime_last_error. */
BREVE_API breve_status breve_view_create(breve_runtime* runtime, const breve_view_config* config, breve_view** view);

/* NULL is nothing. */
BREVE_API void breve_view_destroy(breve_view* view);

/* Draw the world as it is now. As breve_scene_read.
   @param rgba    rows from the top, 4 bytes a pixel; alpha is 255
   @param stride  bytes from one row to the next; 0: they lie side by side
   BREVE_OK; BREVE_ERROR_ARGUMENT: `stride` is too small; BREVE_ERROR_MEMORY. */
BREVE_API breve_status breve_view_render(breve_view* view, breve_world* world, uint8_t* rgba, size_t stride);

/* How far each pixel of the last picture is away, in length units along the line of sight; infinite where nothing is.
   Inside a sub-window the numbers mean nothing.
   BREVE_OK; BREVE_ERROR_ARGUMENT: `stride` is too small or no multiple of 4; BREVE_ERROR_NOT_FOUND: no picture yet. */
BREVE_API breve_status breve_view_depth(const breve_view* view, float* depth, size_t stride);

/* Look through this camera from now on; NULL: through the program's.
   BREVE_OK; BREVE_ERROR_ARGUMENT: a number is not finite. */
BREVE_API breve_status breve_view_set_camera(breve_view* view, const breve_camera* camera);

/* The camera of the last picture, as it was placed.
   BREVE_OK; BREVE_ERROR_NOT_FOUND: no picture yet. */
BREVE_API breve_status breve_view_camera(const breve_view* view, breve_camera* camera);

/* BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_view_counts(const breve_view* view, breve_view_counters* counters);

/* The bytes of a PNG file.
   @param bytes  room for `capacity`; NULL only if capacity is 0
   @param size   how many there are, also where that is more than capacity: then nothing is written
   BREVE_OK; BREVE_ERROR_ARGUMENT: a side is not from 1 to 32768, or `stride` is too small. */
BREVE_API breve_status breve_png(uint32_t width, uint32_t height, const uint8_t* rgba, size_t stride, uint8_t* bytes,
                                 size_t capacity, size_t* size);

#ifdef __cplusplus
}
#endif

#endif
