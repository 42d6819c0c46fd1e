/* breve/view.h: the visible scene of a world. A host with its own renderer reads the scene as data: instances of shared
 * meshes, lines, text, cameras, lights. Any other host lets the library draw it into an array of pixels, without a screen.
 *
 *     breve_scene* scene;                                   breve_view* view;
 *     breve_scene_create(&scene);                           breve_view_create(runtime, NULL, &view);
 *     breve_scene_read(scene, world);                       breve_view_render(view, world, pixels, 0);
 *     breve_scene_rows(scene, BREVE_SCENE_INSTANCES, &rows);
 *
 * The rules of breve.h also hold here. A scene or view does not belong to a world: it reads the world that it is given,
 * as it is at that moment, does not change it, and keeps only copies. Each scene or view is used by one thread at a time;
 * different ones may be used by different threads. Their memory comes from the C++ allocator. As long as none is created,
 * this costs nothing: no mesh is built, no picture is decoded, no graphics library is loaded.
 *
 * Numbers are float, as renderers use them; larger ones are clamped to 1e18. Colours are red, green, blue and alpha from
 * 0 to 1, encoded as sRGB, as in scripts.
 */
#ifndef BREVE_VIEW_H
#define BREVE_VIEW_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the scene --------------------------------------------------------------------------------------------------- */

typedef struct breve_scene breve_scene;

/* An array of the library: its first row, the number of rows, and the number of bytes from one row to the next. A later
   library may have longer rows, so a host must step by `stride`. Rows are valid until the next call of breve_scene_read on
   the same scene. */
typedef struct breve_rows {
  const void* data; /* NULL if there are none */
  size_t count;
  size_t stride;
} breve_rows;

/* The arrays of a scene. */
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
  BREVE_SCENE_LIGHTS = 10,   /* breve_light, the main one first */
  BREVE_SCENE_PLOTS = 11,    /* breve_plot: Graph objects, drawn over the picture from the lower right corner up */
  BREVE_SCENE_PLOT_LINES = 12 /* breve_plot_line, those of one plot after those of another */
} breve_scene_kind;

#define BREVE_NO_TEXTURE UINT32_MAX

/* A mesh, drawn with a pose. */
typedef struct breve_instance {
  breve_object object;    /* the body or grid that it shows */
  float transform[12];    /* three rows of four: world = transform * (x, y, z, 1) */
  float color[4];
  float texture_scale[2]; /* the size of one tile of the texture, across and along, in length units */
  uint32_t mesh;          /* row of BREVE_SCENE_MESHES */
  uint32_t texture;       /* row of BREVE_SCENE_TEXTURES, or BREVE_NO_TEXTURE */
  uint32_t casts_shadow;  /* 0 or 1 */
  uint32_t fixed;         /* 1: a Stationary or Terrain */
} breve_instance;

/* Triangles that instances share. Bodies whose shapes look alike have the same mesh; there is one for all spheres. */
typedef struct breve_mesh {
  const float* positions; /* 3 for each vertex; NULL in an unused row */
  const float* normals;   /* 3 for each vertex, of unit length */
  const float* uvs;       /* 2 for each vertex: 0 to 1 across a terrain, otherwise 0 */
  const float* colors;    /* 3 for each vertex, instead of the instance's colour; NULL: none */
  const uint32_t* indices; /* 3 for each triangle, counter-clockwise seen from outside */
  size_t vertex_count, index_count;
  uint64_t revision;      /* changes when the row holds another mesh, or a changed one */
} breve_mesh;

typedef struct breve_texture {
  breve_object image;  /* the Image object */
  const uint8_t* rgba; /* 4 for each pixel, rows from the top; NULL in an unused row */
  uint32_t width, height;
  uint64_t revision;   /* changes when the pixels change */
} breve_texture;

typedef struct breve_line {
  float from[3], to[3];
  float color[4];
  float width;      /* pixels */
  uint32_t pattern; /* 16 bits, repeated along the line: bit i draws the i-th pair of pixels */
} breve_line;

typedef struct breve_vertex {
  float position[3];
  float color[4];
} breve_vertex;

typedef struct breve_sprite {
  breve_object object;
  float center[3];
  float size;       /* the length of its side, in length units; for a point: its diameter, in pixels */
  float heading;    /* rad, counter-clockwise on the screen */
  float color[4];
  uint32_t texture; /* row of BREVE_SCENE_TEXTURES */
  uint32_t glow;    /* 1: its colour is added to the background */
  uint32_t point;   /* 1: a disc without a texture */
} breve_sprite;

typedef struct breve_sheet {
  breve_object object;
  float corner[3], across[3], along[3]; /* its low corner and its sides */
  uint32_t columns, rows;
  const uint8_t* rgba; /* one pixel for each cell; cells along `across` are contiguous */
  uint64_t revision;
} breve_sheet;

typedef struct breve_label {
  breve_object object;
  float place[3]; /* the text is drawn above this point */
  const char* text;
} breve_label;

typedef struct breve_overlay_text {
  const char* text;
  float x, y; /* the start of its baseline in the picture, -1 to 1 */
  float color[3];
} breve_overlay_text;

/* Lines of numbers over the picture. */
typedef struct breve_plot {
  breve_object object;
  const char *title, *x_axis, *y_axis;   /* "" for none */
  uint32_t first_line, line_count;       /* rows of BREVE_SCENE_PLOT_LINES */
} breve_plot;

/* A line of a plot. */
typedef struct breve_plot_line {
  const char* name;     /* for the key; NULL or "" for none. Those of a Graph have none */
  const double* values; /* value i is at x = i, unless the plot says otherwise. Where one is not finite, the line breaks */
  size_t count;
  float color[3];
  uint32_t plot;        /* row of BREVE_SCENE_PLOTS; breve_plot_file ignores it */
} breve_plot_line;

/* A camera stands at target + offset. Without rotation it looks along -z; it is pitched about x, then rotated about y. */
typedef struct breve_camera {
  breve_object object; /* null: the controller's */
  double target[3], offset[3];
  double pitch, yaw;      /* rad */
  double field_of_view;   /* rad, vertical */
  double far_plane;       /* length units */
  double window[4];       /* x, y, width, height in pixels from the lower left; all 0: the whole picture */
  uint32_t automatic;     /* 1: the program has not placed one, and the renderer should show the whole scene */
  uint32_t orthographic;  /* 1: half the height of the picture is distance * tan(field_of_view / 2) */
} breve_camera;

typedef struct breve_light {
  double position[3];
  float ambient[3], diffuse[3], specular[3]; /* factors, not encoded */
} breve_light;

/* Settings of the scene as a whole. */
typedef struct breve_backdrop {
  size_t struct_size; /* set by breve_backdrop_default */
  float color[3];
  uint32_t texture;   /* row of BREVE_SCENE_TEXTURES, or BREVE_NO_TEXTURE */
  float scroll[2];    /* its offset, in texture widths and heights */
  uint32_t mountains; /* 1: the built-in sky box */
  uint32_t fog;       /* 1: on */
  float fog_start, fog_end, fog_intensity; /* length units from the camera */
  float fog_color[3];
  uint32_t dimension; /* 2 or 3 */
  uint32_t lighting, shadows, reflections, outline, text; /* 0 or 1: enabled by the program */
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

/* Creates an empty scene.
   @param scene  destroy it with breve_scene_destroy
   BREVE_OK; BREVE_ERROR_MEMORY. */
BREVE_API breve_status breve_scene_create(breve_scene** scene);

/* Does nothing for NULL. */
BREVE_API void breve_scene_destroy(breve_scene* scene);

/* Reads the scene of a world as it is now. Meshes and textures keep their rows from one call to the next. Runs no script,
   and does not change anything that breve_world_hash covers. May be called from a callback while script runs.
   BREVE_OK; BREVE_ERROR_MEMORY: the scene is empty then. */
BREVE_API breve_status breve_scene_read(breve_scene* scene, breve_world* world);

/* One array of the scene, as it was read last.
   @param part  breve_scene_kind
   BREVE_OK; BREVE_ERROR_ARGUMENT. */
BREVE_API breve_status breve_scene_rows(const breve_scene* scene, uint32_t part, breve_rows* rows);

/* BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_scene_backdrop(const breve_scene* scene, breve_backdrop* backdrop);

/* The main camera for a picture with this aspect ratio: the program's camera, or one that shows everything that moves. An
   automatic camera moves smoothly from one call to the next.
   BREVE_OK; BREVE_ERROR_ARGUMENT: a side is 0. */
BREVE_API breve_status breve_scene_camera(breve_scene* scene, uint32_t width, uint32_t height, breve_camera* camera);

/* Projects a point into a camera's picture.
   @param seen  the pixels from the left and from the top of the picture, and the distance along the line of sight
   BREVE_OK; BREVE_ERROR_ARGUMENT; BREVE_ERROR_NOT_FOUND: the point is behind the camera. */
BREVE_API breve_status breve_camera_project(const breve_camera* camera, uint32_t width, uint32_t height,
                                            const double point[3], double seen[3]);

/* ---- pictures ---------------------------------------------------------------------------------------------------- */

/* Draws scenes by OpenGL: in main memory (OSMesa), or with a context of the host. */
typedef struct breve_view breve_view;

typedef enum breve_look {
  BREVE_LOOK_FULL = 0, /* soft light, sky and haze where the program does not set anything else */
  BREVE_LOOK_PLAIN = 1 /* only the colours and lights that the program sets */
} breve_look;

/* A function of OpenGL, to be cast to its type. */
typedef void (*breve_gl_function)(void);

/* An OpenGL context of the host, for breve_view_config.gl: 3.3 or later, core profile. It belongs to one view, which changes
   its state as it likes and draws into frame buffers of its own. Frozen. */
typedef struct breve_gl {
  void* user; /* passed to the functions, which must not call the library */
  /* Makes the context current in the calling thread, or, for false, releases it there. Returns false if this fails. */
  bool (*make_current)(void* user, bool current);
  /* The function called `name` ("glClear"); NULL: there is none. Called while the context is current. */
  breve_gl_function (*address)(void* user, const char* name);
} breve_gl;

typedef struct breve_view_config {
  size_t struct_size; /* set by breve_view_config_default */
  uint32_t width, height; /* pixels, 1 to 16384. Default 640 x 480 */
  uint32_t samples;   /* per pixel, for antialiasing: 1, 2 or 4. Default 4 */
  uint32_t look;      /* breve_look. Default BREVE_LOOK_FULL */
  const char* font;   /* a TrueType or OpenType file, read by breve_view_create. NULL: DejaVu Sans; if that is not installed,
                         no text is drawn. Default NULL */
  const breve_gl* gl; /* draw with this context, which outlives the view; copied. NULL: in main memory, with OSMesa.
                         Default NULL */
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

/* Costs of the last picture. */
typedef struct breve_view_counters {
  size_t struct_size; /* set by breve_view_counters_default */
  uint64_t draw_calls; /* independent of the number of bodies with the same shape */
  uint64_t instances, triangles;
  uint64_t uploads; /* new meshes and textures */
} breve_view_counters;

/* All zero, to be filled in. */
static inline breve_view_counters breve_view_counters_default(void) {
  breve_view_counters counters;
  breve_clear(&counters, sizeof counters);
  counters.struct_size = sizeof counters;
  return counters;
}

/* What arrows show in pictures, to be added. */
typedef enum breve_arrows {
  BREVE_ARROWS_NONE = 0,
  BREVE_ARROWS_CONTACTS = 1,  /* blue: the normal at each contact of a body with physics, as long as the smaller radius */
  BREVE_ARROWS_FORCES = 2,    /* what contacts (red) and springs (orange) exerted in the last sub-step, and what scripts set
                                 (violet). A force of 10 m/s^2 times the mass is as long as the body is wide */
  BREVE_ARROWS_VELOCITIES = 4, /* green: from the centre of each body to where it would be after one second */
  BREVE_ARROWS_JOINTS = 8     /* yellow: from the pivot of each joint along its first axis, as long as the child's radius;
                                 only a dot where a joint has no axis, or points at the camera */
} breve_arrows;

/* Creates a view. The first one without a context of the host loads OSMesa.
   @param config  copied; NULL: the defaults
   @param view    destroy it with breve_view_destroy
   BREVE_OK; BREVE_ERROR_ARGUMENT: an invalid size, number of samples or look, or `gl` lacks a function; BREVE_ERROR_FILE: the
   font cannot be read; BREVE_ERROR_UNSUPPORTED: OSMesa is not installed, the context of the host cannot be made current or
   has no OpenGL 3.3, or the library was built without BREVE_WITH_RENDER. The text is in breve_runtime_last_error. */
BREVE_API breve_status breve_view_create(breve_runtime* runtime, const breve_view_config* config, breve_view** view);

/* Does nothing for NULL. */
BREVE_API void breve_view_destroy(breve_view* view);

/* Draws the world as it is now. As breve_scene_read.
   @param rgba    rows from the top, 4 bytes per pixel; alpha is 255
   @param stride  bytes from one row to the next; 0: the rows are contiguous
   BREVE_OK; BREVE_ERROR_ARGUMENT: `stride` is too small; BREVE_ERROR_MEMORY. */
BREVE_API breve_status breve_view_render(breve_view* view, breve_world* world, uint8_t* rgba, size_t stride);

/* The depth of each pixel of the last picture: the distance along the line of sight, in length units; infinite where nothing
   is visible. Pixels of sub-windows have no meaningful depth.
   BREVE_OK; BREVE_ERROR_ARGUMENT: `stride` is too small or not a multiple of 4; BREVE_ERROR_NOT_FOUND: nothing has been
   drawn yet. */
BREVE_API breve_status breve_view_depth(const breve_view* view, float* depth, size_t stride);

/* Sets the camera of the following pictures; NULL: the program's camera.
   BREVE_OK; BREVE_ERROR_ARGUMENT: a number is not finite. */
BREVE_API breve_status breve_view_set_camera(breve_view* view, const breve_camera* camera);

/* Chooses the arrows in the following pictures, which are drawn over everything else. At first there are none.
   @param arrows  sum of breve_arrows
   @param scale   factor for all lengths; usually 1
   BREVE_OK; BREVE_ERROR_ARGUMENT: a bit that is not a breve_arrows, or a scale that is not finite and above 0. */
BREVE_API breve_status breve_view_set_arrows(breve_view* view, uint32_t arrows, double scale);

/* Reads what breve_view_set_arrows has set.
   BREVE_OK; BREVE_ERROR_ARGUMENT: a NULL pointer. */
BREVE_API breve_status breve_view_arrows(const breve_view* view, uint32_t* arrows, double* scale);

/* The camera of the last picture, with its actual position.
   BREVE_OK; BREVE_ERROR_NOT_FOUND: nothing has been drawn yet. */
BREVE_API breve_status breve_view_camera(const breve_view* view, breve_camera* camera);

/* BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_view_counts(const breve_view* view, breve_view_counters* counters);

/* Encodes a picture as a PNG file.
   @param bytes  room for `capacity` bytes; NULL only if capacity is 0
   @param size   the size of the file. If it exceeds capacity, nothing is written to bytes
   BREVE_OK; BREVE_ERROR_ARGUMENT: a side is not from 1 to 32768, or `stride` is too small. */
BREVE_API breve_status breve_png(uint32_t width, uint32_t height, const uint8_t* rgba, size_t stride, uint8_t* bytes,
                                 size_t capacity, size_t* size);

/* ---- plots ------------------------------------------------------------------------------------------------------- */

typedef enum breve_plot_format {
  BREVE_PLOT_FORMAT_SVG = 0, /* a picture of 900 x 520 units */
  BREVE_PLOT_FORMAT_PNG = 1, /* the same as pixels */
  BREVE_PLOT_FORMAT_CSV = 2  /* a table with a column for x and one for each line */
} breve_plot_format;

typedef struct breve_plot_config {
  size_t struct_size;     /* set by breve_plot_config_default */
  const char* title;      /* NULL for none; drawn if no line has a name. Default NULL */
  const char* x_axis;     /* name of the axis with its unit. Default NULL */
  const char* y_axis;     /* Default NULL */
  const double* xs;       /* of the values of all lines. NULL: 0, 1, 2 ... Default NULL */
  size_t x_count;         /* values beyond it are left out. Default 0 */
  const breve_plot_line* lines;
  size_t line_count;      /* Default 0 */
} breve_plot_config;

/* The defaults named above. */
static inline breve_plot_config breve_plot_config_default(void) {
  breve_plot_config config;
  breve_clear(&config, sizeof config);
  config.struct_size = sizeof config;
  return config;
}

/* Writes a plot as a file.
   @param format  breve_plot_format
   @param bytes   room for `capacity` bytes; NULL only if capacity is 0
   @param size    the size of the file. If it exceeds capacity, nothing is written to bytes
   BREVE_OK; BREVE_ERROR_ARGUMENT: not a breve_plot_format, or an array that is NULL though it has a count;
   BREVE_ERROR_MEMORY. */
BREVE_API breve_status breve_plot_file(const breve_plot_config* config, uint32_t format, uint8_t* bytes, size_t capacity,
                                       size_t* size);

/* ---- movies ------------------------------------------------------------------------------------------------------ */

/* Packs pictures into a movie file: animated GIF, and what ffmpeg's libraries write, which are loaded for the first such
   movie. A movie is used by one thread at a time, which also uses its runtime. */
typedef struct breve_movie breve_movie;

typedef struct breve_movie_config {
  size_t struct_size;     /* set by breve_movie_config_default */
  uint32_t width, height; /* pixels, 1 to 16384; codecs round them down to even numbers. Default 640 x 480 */
  double fps;         /* pictures in a second, 0.01 to 1000; a format that has a few rates only (.mpeg) repeats pictures or leaves
                         out some. Default 25 */
  const char* path;   /* the file that is written; it is removed if the movie is not finished. NULL: `write` receives it.
                         Default NULL */
  const char* format; /* "mp4", "mkv", "webm", "avi", "mpeg", "gif" ...; NULL: the ending of `path`. Default NULL */
  void* user;         /* passed to `write`. Default NULL */
  /* Receives the whole file, once, from breve_movie_finish, and returns false if it cannot keep it. It must not call the
     library. Ignored if there is a path. Default NULL */
  bool (*write)(void* user, const void* bytes, size_t size);
} breve_movie_config;

/* The defaults named above. */
static inline breve_movie_config breve_movie_config_default(void) {
  breve_movie_config config;
  breve_clear(&config, sizeof config);
  config.struct_size = sizeof config;
  config.width = 640;
  config.height = 480;
  config.fps = 25;
  return config;
}

/* Begins a movie.
   @param config  copied
   @param movie   destroy it with breve_movie_destroy
   BREVE_OK; BREVE_ERROR_ARGUMENT: a size, a rate or a format that does not exist, or neither a path nor `write`;
   BREVE_ERROR_FILE: the file cannot be written; BREVE_ERROR_UNSUPPORTED: ffmpeg's libraries or the codec are not installed,
   or the library was built without BREVE_WITH_MOVIES (GIF works); BREVE_ERROR_MEMORY. The text is in
   breve_runtime_last_error, also that of the following functions. */
BREVE_API breve_status breve_movie_create(breve_runtime* runtime, const breve_movie_config* config, breve_movie** movie);

/* Does nothing for NULL. */
BREVE_API void breve_movie_destroy(breve_movie* movie);

/* Adds a picture. Parameters are those of breve_view_render.
   BREVE_OK; BREVE_ERROR_ARGUMENT: `stride` is too small; BREVE_ERROR_FILE: it cannot be written, for example because the
   disk is full, and the movie has ended; BREVE_ERROR_NOT_FOUND: the movie has ended; BREVE_ERROR_MEMORY. */
BREVE_API breve_status breve_movie_add(breve_movie* movie, const uint8_t* rgba, size_t stride);

/* Writes what is left, and closes the file. Then the movie can only be destroyed.
   BREVE_OK; BREVE_ERROR_FILE: it cannot be written, or nothing was added; BREVE_ERROR_NOT_FOUND: the movie has ended;
   BREVE_ERROR_MEMORY. */
BREVE_API breve_status breve_movie_finish(breve_movie* movie);

#ifdef __cplusplus
}
#endif

#endif
