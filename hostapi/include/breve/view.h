/* view.h: what scripts want to be seen: looks, cameras, lights, fog, texts, drawings, pictures, for hosts that draw a world
 * themselves. A part of breve.h, whose rules hold here.
 */
#ifndef BREVE_VIEW_H
#define BREVE_VIEW_H

#include "breve/breve.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- what is to be seen ------------------------------------------------------------------------------------------ */

/* Scripts say how their world is to look, and nothing here draws. Poses are in breve_objects_property, shapes in
   breve_object_shape, colours there as well, menus in breve_world_menu_items. Colours are red, green, blue from 0 to 1.
   Texts are owned by the world until script runs in it again. None of these functions runs script. */

/* How one body is drawn. */
typedef struct breve_look {
  size_t struct_size;    /* as breve_look_default gives it */
  double color[3];       /* 1, 1, 1 unless a script set it */
  double alpha;          /* 1 is opaque */
  const char* label;     /* to be written beside it; "" for none */
  breve_object texture;  /* an Image on its surface; null: none */
  breve_object bitmap;   /* an Image that faces the camera in place of the shape; null: none */
  breve_object lightmap; /* an Image that faces the camera as a glow; null: none */
  double texture_scale[2]; /* size of one tile of the texture, length units */
  double bitmap_heading;   /* rad, in the plane of the screen */
  bool visible;
  bool shadows;      /* it casts some */
  bool as_point;     /* a point in place of the shape */
  bool bounding_box; /* with its bounds */
  bool axes;         /* with its own axes */
  bool neighbors;    /* with lines to its neighbours */
  bool reserved[2];
} breve_look;

/* All zero, to be filled in. */
static inline breve_look breve_look_default(void) {
  breve_look look;
  breve_clear(&look, sizeof look);
  look.struct_size = sizeof look;
  return look;
}

/* BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_object_look(const breve_world* world, breve_object object, breve_look* look);

/* Where a camera stands and looks. */
typedef struct breve_camera {
  size_t struct_size; /* as breve_camera_default gives it */
  double location[3];
  double target[3];     /* the place that it looks at */
  double up[3];         /* unit, upright to its view */
  double field_of_view; /* rad, from top to bottom */
  double far_plane;     /* length units: what is beyond is not drawn */
  double corner[2];     /* of its part of the window, pixels; the main camera has the whole window, and 0, 0 here */
  double size[2];       /* of that part; 0, 0 for the main camera */
  bool enabled;
  bool text; /* with the texts of breve_world_text */
  bool reserved[6];
} breve_camera;

/* All zero, to be filled in. */
static inline breve_camera breve_camera_default(void) {
  breve_camera camera;
  breve_clear(&camera, sizeof camera);
  camera.struct_size = sizeof camera;
  return camera;
}

/* @param camera  an object of class Camera (breve_world_objects lists them); null: the main one
   BREVE_OK; BREVE_ERROR_TYPE: the object is not a camera; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_camera_state(const breve_world* world, breve_object camera, breve_camera* state);

/* What is around all bodies. */
typedef struct breve_view {
  size_t struct_size;       /* as breve_view_default gives it */
  double background[3];     /* its colour */
  breve_object backdrop;    /* an Image behind everything; null: none */
  double backdrop_scroll[2]; /* widths of it in each drawn frame */
  double fog_color[3];
  double fog_start, fog_end; /* length units from the camera */
  double fog_intensity;
  double blur; /* how much of the last frame stays, 0 to 1; 0 unless `blurs` */
  double text_scale;
  uint64_t clears;        /* how often a script has asked for an empty screen */
  breve_object selection; /* what was clicked last; null: nothing */
  bool fog, lighting, shadows, shadow_volumes, reflections, blurs, outlines, texts; /* what is switched on */
} breve_view;

/* All zero, to be filled in. */
static inline breve_view breve_view_default(void) {
  breve_view view;
  breve_clear(&view, sizeof view);
  view.struct_size = sizeof view;
  return view;
}

/* BREVE_OK; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_world_view(const breve_world* world, breve_view* view);

/* One of the eight lights. Frozen. */
typedef struct breve_light {
  double location[3];
  double ambient[3], diffuse[3], specular[3]; /* colours */
} breve_light;

/* The light at `index`, from 0. BREVE_OK; BREVE_ERROR_NOT_FOUND if index is not below 8. */
BREVE_API breve_status breve_world_light(const breve_world* world, size_t index, breve_light* light);

/* One of the eight lines of text over the view. Frozen. */
typedef struct breve_text {
  const char* text;   /* "" where there is none */
  double location[2]; /* -1 to 1 across the window, from the lower left */
  double color[3];
} breve_text;

/* The line at `index`, from 0. BREVE_OK; BREVE_ERROR_NOT_FOUND if index is not below 8. */
BREVE_API breve_status breve_world_text(const breve_world* world, size_t index, breve_text* text);

typedef enum breve_draw_kind {
  BREVE_DRAW_COLOR = 0,       /* from now on: `to` is red, green, blue, `value` alpha */
  BREVE_DRAW_LINE_WIDTH = 1,  /* from now on: `value` pixels */
  BREVE_DRAW_LINE_STYLE = 2,  /* from now on: the bits of `style` */
  BREVE_DRAW_LINE = 3,        /* from `from` to `to` */
  BREVE_DRAW_CORNER = 4,      /* the next corner of a polygon: `to` */
  BREVE_DRAW_END_POLYGON = 5  /* its corners since the last one of these make the polygon */
} breve_draw_kind;

/* One command of a drawing. Frozen. */
typedef struct breve_draw {
  uint32_t kind;  /* breve_draw_kind */
  uint32_t style; /* 16 bits: bit i is set where the pattern draws */
  double from[3], to[3];
  double value;
} breve_draw;

/* What an object of class Drawing draws, in order; a new drawing is white, 1 pixel wide, and draws whole lines.
   @param commands  room for `capacity`; NULL only if capacity is 0
   @param count     how many there are, also where that is more than capacity: at most capacity are written
   BREVE_OK; BREVE_ERROR_TYPE: the object is not a drawing. */
BREVE_API breve_status breve_drawing_commands(const breve_world* world, breve_object drawing, breve_draw* commands,
                                              size_t capacity, size_t* count);

/* A line between the centres of two bodies. Frozen. */
typedef struct breve_line {
  breve_object from, to; /* null if it is not connected, or the body is gone */
  double color[3], alpha;
  uint32_t style; /* as of breve_draw */
  uint32_t reserved;
} breve_line;

/* An object of class Line. BREVE_OK; BREVE_ERROR_TYPE: the object is not a line. */
BREVE_API breve_status breve_line_state(const breve_world* world, breve_object line, breve_line* state);

/* The pixels of an object of class Image: red, green, blue and alpha, a byte each, rows from the top.
   @param pixels         room for `capacity` bytes; NULL only if capacity is 0. Where the picture needs more nothing is
                         written to it: call again with room
   @param width, height  of the picture; 0, 0: it has none yet
   BREVE_OK; BREVE_ERROR_TYPE: the object is not an image. */
BREVE_API breve_status breve_image_pixels(const breve_world* world, breve_object image, void* pixels, size_t capacity,
                                          uint32_t* width, uint32_t* height);

/* ---- what was set ------------------------------------------------------------------------------------------------ */

/* The surface of a body as breve_object_set_material, set-friction and set-restitution have set it; static_friction,
   dynamic_friction and restitution are -1 where they have not, and set-mu and set-e decide. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_material(const breve_world* world, breve_object object, breve_material* material);

/* The force and torque that were set. @param force, torque  each may be NULL. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_force(const breve_world* world, breve_object object, double force[3],
                                          double torque[3]);

/* breve_world_set_sleeping. False for NULL. */
BREVE_API bool breve_world_sleeping(const breve_world* world);

/* breve_world_set_workers. 0 for NULL. */
BREVE_API uint32_t breve_world_workers(const breve_world* world);

/* The settings that are in force for a body: those of its assembly, or the world's.
   BREVE_OK; BREVE_ERROR_NO_BODY; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_object_accuracy(const breve_world* world, breve_object object, breve_accuracy* accuracy);

/* breve_object_set_self_collisions. BREVE_OK; BREVE_ERROR_NO_BODY. */
BREVE_API breve_status breve_object_self_collisions(const breve_world* world, breve_object object, bool* on);

/* What a spring was given. Its bodies are null where they are gone.
   BREVE_OK; BREVE_ERROR_TYPE: the object is not a spring; BREVE_ERROR_ARGUMENT: a wrong struct_size. */
BREVE_API breve_status breve_spring_description(const breve_world* world, breve_object spring,
                                                breve_spring* description);

/* Queue a click on the first body that a ray meets, or on nothing: what breve_world_ray_first finds, then
   breve_world_queue_click.
   @param start, way  as of breve_world_ray_first: from the camera's location through the pixel
   As breve_world_ray_first. */
BREVE_API breve_status breve_world_queue_click_ray(breve_world* world, const double start[3], const double way[3]);

#ifdef __cplusplus
}
#endif

#endif
