/* What there is to see: scenes without a renderer, and pictures whose shapes, depths and colours have closed forms. */
#include "breve/view.h"

#include <math.h>
#include <stdlib.h>

#include "scene.h"

enum { kWidth = 640, kHeight = 480, kPixels = kWidth * kHeight };
static const double kPercent = 0.01;

static const char* const start =
    "@use Control.\n@use Mobile.\n@use Stationary.\n@use Shape.\n@use Image.\n@use Camera.\n@use Graph.\n"
    "Mobile : Thing {\n"
    "\t+ to become from shape (object) at place (vector) in color (vector):\n"
    "\t\tself set-shape to shape. self move to place. self set-color to color. return self.\n"
    "}\n"
    "Controller Show.\nControl : Show {\n"
    "\t+ variables: ball, box, thing, picture, eye (object). count (int).\n"
    "\t+ to init:\n"
    "\t\tball = ((new Sphere) init-with radius 2). box = ((new Cube) init-with size (10, 10, 1)).\n"
    "\t\tself set-background-color to (0, 0, 0).\n";

/* A world whose controller does `body` at the end of its init. */
static bool open_show(scene* s, const char* body) {
  char text[4096];
  snprintf(text, sizeof text, "%s%s}\n", start, body);
  return scene_open_text(s, text, NULL);
}

typedef struct shot {
  breve_view* view;
  uint8_t* rgba;
  float* depth;
} shot;

static bool take(scene* s, shot* p) {
  breve_view_config config = breve_view_config_default();
  config.look = BREVE_LOOK_PLAIN;
  memset(p, 0, sizeof *p);
  p->rgba = malloc(4 * kPixels);
  p->depth = malloc(sizeof(float) * kPixels);
  return CHECK_STATUS(BREVE_OK, breve_view_create(s->runtime, &config, &p->view)) &&
         CHECK_STATUS(BREVE_OK, breve_view_render(p->view, s->world, p->rgba, 0)) &&
         CHECK_STATUS(BREVE_OK, breve_view_depth(p->view, p->depth, 0));
}

static void drop(shot* p) {
  breve_view_destroy(p->view);
  free(p->rgba);
  free(p->depth);
}

static const uint8_t* pixel(const shot* p, int x, int y) { return p->rgba + 4 * (y * kWidth + x); }

static double slope(void) { return tan(20 * acos(-1) / 180); }

static double encoded(double c) { return 255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055); }

/* The light of a pixel: the edges of shadows are mixed as light, not as encoded colours. */
static double light_of(const uint8_t* p) {
  const double c = p[0] / 255.0;
  return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

/* --- scenes --------------------------------------------------------------------------------------------------------- */

static breve_rows rows_of(breve_scene* scene, uint32_t kind) {
  breve_rows rows = {NULL, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_scene_rows(scene, kind, &rows));
  return rows;
}

static const void* row(const breve_rows* rows, size_t i) { return (const char*)rows->data + i * rows->stride; }

/* Six times the volume, by the divergence theorem: above 0 if the triangles are counter-clockwise seen from outside. */
static double six_volumes(const breve_mesh* mesh) {
  double six = 0;
  for (size_t i = 0; i < mesh->index_count; i += 3) {
    const float* a = mesh->positions + 3 * mesh->indices[i];
    const float* b = mesh->positions + 3 * mesh->indices[i + 1];
    const float* c = mesh->positions + 3 * mesh->indices[i + 2];
    six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return six;
}

static void bodies_that_look_alike_share_a_mesh(void) {
  scene s;
  if (!open_show(&s,
                 "\t\t(new Thing) become from ball at (1, 2, 3) in (1, 0, 0).\n"
                 "\t\t(new Thing) become from (new Sphere init-with radius 5) at (0, 0, 0) in (0, 1, 0).\n"
                 "\t\t(new Thing) become from box at (0, 0, 0) in (0, 0, 1).\n"
                 "\t\t(new Thing) become from (new PolygonCone init-with sides 5 height 2 radius 1) at (0, 0, 0) in "
                 "(1, 1, 1).\n"
                 "\t\t(new Thing) become from (new PolygonCone init-with sides 5 height 2 radius 1) at (4, 0, 0) in "
                 "(1, 1, 1).\n"))
    return;
  breve_scene* scene = NULL;
  CHECK_STATUS(BREVE_OK, breve_scene_create(&scene));
  CHECK_STATUS(BREVE_OK, breve_scene_read(scene, s.world));
  const breve_rows all = rows_of(scene, BREVE_SCENE_INSTANCES), meshes = rows_of(scene, BREVE_SCENE_MESHES);
  CHECK(all.count == 5);
  const breve_instance* first = row(&all, 0);
  const breve_instance* second = row(&all, 1);
  CHECK(first->mesh == second->mesh);
  CHECK(((const breve_instance*)row(&all, 3))->mesh == ((const breve_instance*)row(&all, 4))->mesh);
  CHECK(((const breve_instance*)row(&all, 2))->mesh != first->mesh);
  CHECK(first->transform[0] == 2 && first->transform[3] == 1 && first->transform[7] == 2 && first->transform[11] == 3);
  CHECK(second->transform[5] == 5 && second->color[1] == 1 && second->color[3] == 1);
  const breve_mesh* sphere = row(&meshes, first->mesh);
  CHECK(sphere->vertex_count > 100 && sphere->index_count % 3 == 0);
  for (size_t i = 0; i < sphere->index_count; ++i) CHECK(sphere->indices[i] < sphere->vertex_count);
  CHECK_NEAR(8 * acos(-1), six_volumes(sphere), kPercent * 8 * acos(-1));
  breve_scene_destroy(scene);
  scene_close(&s);
}

static void triangles_of_every_shape_face_outward(void) {
  scene s;
  const double pi = acos(-1);
  const struct {
    const char* shape;
    double volume; /* a ball is a little larger than its mesh */
  } shapes[] = {{"(new Cube) init-with size (1, 2, 3)", 6},
                {"(new Sphere) init-with radius 2", pi * 32 / 3},
                {"(new Cylinder) init-with radius 1 height 3", 3 * pi},
                {"(new Capsule) init-with radius 1 length 2", 2 * pi + pi * 4 / 3},
                {"(new PolygonDisk) init-with sides 4 height 3 radius 1", 6},
                {"(new PolygonCone) init-with sides 4 height 3 radius 1", 2}};
  for (size_t i = 0; i < sizeof shapes / sizeof shapes[0]; ++i) {
    char body[256];
    snprintf(body, sizeof body, "\t\t(new Thing) become from (%s) at (1, 2, 3) in (1, 1, 1).\n", shapes[i].shape);
    if (!open_show(&s, body)) return;
    breve_scene* scene = NULL;
    CHECK_STATUS(BREVE_OK, breve_scene_create(&scene));
    CHECK_STATUS(BREVE_OK, breve_scene_read(scene, s.world));
    const breve_rows all = rows_of(scene, BREVE_SCENE_INSTANCES), meshes = rows_of(scene, BREVE_SCENE_MESHES);
    const breve_instance* one = row(&all, 0);
    const double scale = one->transform[0] * one->transform[5] * one->transform[10];
    CHECK_NEAR(shapes[i].volume, scale * six_volumes(row(&meshes, one->mesh)) / 6, 2 * kPercent * shapes[i].volume);
    breve_scene_destroy(scene);
    scene_close(&s);
  }
}

static void lines_texts_and_lights_are_rows(void) {
  scene s;
  if (!open_show(&s,
                 "\t\tthing = ((new Thing) become from ball at (1, 2, 3) in (1, 0, 0)).\n"
                 "\t\tthing set-label to \"the ball\". thing show-axis. thing show-bounding-box.\n"
                 "\t\tself set-display-text to \"hello\" at-x 0.5 at-y -0.5 number 3 with-color (1, 0, 1).\n"
                 "\t\tself move-light to (1, 2, 3) for-light 4.\n"
                 "\t\tself set-background-color to (.25, .5, .75).\n"))
    return;
  breve_scene* scene = NULL;
  CHECK_STATUS(BREVE_OK, breve_scene_create(&scene));
  CHECK_STATUS(BREVE_OK, breve_scene_read(scene, s.world));
  CHECK(rows_of(scene, BREVE_SCENE_LINES).count == 3 + 12);
  const breve_rows labels = rows_of(scene, BREVE_SCENE_LABELS), texts = rows_of(scene, BREVE_SCENE_TEXTS);
  const breve_rows lights = rows_of(scene, BREVE_SCENE_LIGHTS);
  CHECK(labels.count == 1 && texts.count == 1 && lights.count == 2);
  CHECK_TEXT("the ball", ((const breve_label*)row(&labels, 0))->text);
  CHECK_NEAR(4, ((const breve_label*)row(&labels, 0))->place[1], 1e-6);
  CHECK_TEXT("hello", ((const breve_overlay_text*)row(&texts, 0))->text);
  CHECK(((const breve_light*)row(&lights, 1))->position[2] == 3);
  breve_backdrop backdrop = breve_backdrop_default();
  CHECK_STATUS(BREVE_OK, breve_scene_backdrop(scene, &backdrop));
  CHECK(backdrop.color[2] == 0.75F && backdrop.dimension == 3 && backdrop.texture == BREVE_NO_TEXTURE);
  CHECK(backdrop.skybox[0] == BREVE_NO_TEXTURE && backdrop.every_frame == 1);
  breve_rows rows;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_scene_rows(scene, 13, &rows));
  breve_scene_destroy(scene);
  scene_close(&s);
}

static void a_sky_box_is_six_textures(void) {
  scene s;
  if (!open_show(&s,
                 "\t\tself set-skybox-images to {\"images/sky.png\", \"images/clouds.png\", \"images/sky.png\", "
                 "\"images/sky.png\", \"images/sky.png\", \"images/ground.png\"}.\n"
                 "\t\tself disable-draw-every-frame.\n"))
    return;
  breve_scene* scene = NULL;
  CHECK_STATUS(BREVE_OK, breve_scene_create(&scene));
  CHECK_STATUS(BREVE_OK, breve_scene_read(scene, s.world));
  breve_backdrop backdrop = breve_backdrop_default();
  CHECK_STATUS(BREVE_OK, breve_scene_backdrop(scene, &backdrop));
  const breve_rows textures = rows_of(scene, BREVE_SCENE_TEXTURES);
  for (int i = 0; i < 6; ++i) {
    if (!CHECK(backdrop.skybox[i] < textures.count)) continue;
    CHECK(((const breve_texture*)row(&textures, backdrop.skybox[i]))->width == (i == 5 ? 64 : 128));
  }
  CHECK(backdrop.every_frame == 0);
  breve_scene_destroy(scene);
  scene_close(&s);
}

static void a_point_is_seen_where_the_camera_says(void) {
  breve_camera camera;
  breve_clear(&camera, sizeof camera);
  camera.offset[2] = 30;
  camera.field_of_view = 2 * atan(slope());
  camera.far_plane = 500;
  const double point[3] = {1, 2, -3}, behind[3] = {0, 0, 31};
  double seen[3];
  CHECK_STATUS(BREVE_OK, breve_camera_project(&camera, kWidth, kHeight, point, seen));
  CHECK_NEAR(320 + 240 * (1 / 33.0) / slope(), seen[0], 1e-3);
  CHECK_NEAR(240 - 240 * (2 / 33.0) / slope(), seen[1], 1e-3);
  CHECK_NEAR(33, seen[2], 1e-5);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_camera_project(&camera, kWidth, kHeight, behind, seen));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_camera_project(&camera, 0, kHeight, point, seen));
  camera.pitch = NAN;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_camera_project(&camera, kWidth, kHeight, point, seen));
}

static void a_camera_that_the_program_places_is_not_automatic(void) {
  scene s;
  if (!open_show(&s, "\t\t(new Thing) become from ball at (100, 0, 0) in (1, 0, 0).\n")) return;
  breve_scene* scene = NULL;
  breve_camera camera;
  CHECK_STATUS(BREVE_OK, breve_scene_create(&scene));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_scene_camera(scene, kWidth, kHeight, &camera));
  CHECK_STATUS(BREVE_OK, breve_scene_read(scene, s.world));
  CHECK_STATUS(BREVE_OK, breve_scene_camera(scene, kWidth, kHeight, &camera));
  CHECK(camera.automatic == 1);
  CHECK_NEAR(100, camera.target[0], 1e-6);
  const breve_keyword keywords[] = {{"at", breve_value_vector(1, 2, 3)}, {"from", breve_value_vector(0, 3, 4)}};
  CHECK_STATUS(BREVE_OK,
               breve_object_call(s.world, breve_world_controller(s.world), "point-camera", keywords, 2, NULL));
  CHECK_STATUS(BREVE_OK, breve_scene_read(scene, s.world));
  CHECK_STATUS(BREVE_OK, breve_scene_camera(scene, kWidth, kHeight, &camera));
  CHECK(camera.automatic == 0 && camera.target[2] == 3 && camera.offset[2] == 4);
  CHECK_NEAR(-asin(0.6), camera.pitch, 1e-12);
  breve_scene_destroy(scene);
  scene_close(&s);
}

/* --- pictures ------------------------------------------------------------------------------------------------------- */

static void a_camera_that_is_half_wrong_leaves_the_last_one(void) {
  scene s;
  if (!open_show(&s, "")) return;
  breve_view_config config = breve_view_config_default();
  config.width = config.height = 8;
  uint8_t rgba[8 * 8 * 4];
  breve_view* view = NULL;
  breve_camera mine, read;
  breve_clear(&mine, sizeof mine);
  mine.offset[2] = 30, mine.yaw = 0.25, mine.field_of_view = 1, mine.far_plane = 500;
  if (CHECK_STATUS(BREVE_OK, breve_view_create(s.runtime, &config, &view))) {
    CHECK_STATUS(BREVE_OK, breve_view_set_camera(view, &mine));
    mine.offset[2] = 40, mine.pitch = NAN;
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_view_set_camera(view, &mine));
    CHECK_STATUS(BREVE_OK, breve_view_render(view, s.world, rgba, 0));
    CHECK_STATUS(BREVE_OK, breve_view_camera(view, &read));
    CHECK(read.offset[2] == 30 && read.yaw == 0.25 && read.pitch == 0);
  }
  breve_view_destroy(view);
  scene_close(&s);
}

static void the_silhouette_of_a_sphere_has_its_area_and_middle(void) {
  scene s;
  shot p;
  if (!open_show(&s,
                 "\t\tself point-camera at (0, 0, 0) from (0, 0, 20).\n"
                 "\t\t(new Thing) become from ball at (3, 0, 0) in (1, 1, 1).\n"))
    return;
  if (take(&s, &p)) {
    double area = 0, middle = 0;
    for (int i = 0; i < kPixels; ++i) {
      area += p.rgba[4 * i] / 255.0;
      middle += p.rgba[4 * i] / 255.0 * (i % kWidth + 0.5);
    }
    /* An ellipse: along x from tan(a - b) to tan(a + b), where a is the angle of the centre and b that of the radius.
     */
    const double distance = sqrt(409), a = atan(3 / 20.0), b = asin(2 / distance), unit = 240 / slope();
    const double low = unit * tan(a - b), high = unit * tan(a + b);
    const double along = (high - low) / 2, across = unit * sin(b) / sqrt(cos(b) * cos(b) - sin(a) * sin(a));
    CHECK_NEAR(acos(-1) * along * across, area, kPercent * area);
    CHECK_NEAR(320 + (low + high) / 2, middle / area, kPercent * 2 * along);
  }
  drop(&p);
  scene_close(&s);
}

static void a_plane_has_its_depth(void) {
  scene s;
  shot p;
  if (!open_show(&s,
                 "\t\tself point-camera at (0, 0, 0) from (0, 0, 20).\n"
                 "\t\t(new Thing) become from box at (0, 0, -5) in (1, 1, 1).\n"))
    return;
  if (take(&s, &p)) {
    for (int y = 200; y < 280; y += 20)
      for (int x = 260; x < 380; x += 20) CHECK_NEAR(24.5, p.depth[y * kWidth + x], kPercent * 24.5 / 10);
    CHECK(isinf(p.depth[0]));
  }
  drop(&p);
  scene_close(&s);
}

static void a_lit_face_has_its_colour(void) {
  scene s;
  shot p;
  if (!open_show(&s,
                 "\t\tself point-camera at (0, 0, 0) from (0, 0, 20). self enable-lighting.\n"
                 "\t\tself move-light to (0, 0, 100000). self set-light-diffuse-color to (.5, .4, .3).\n"
                 "\t\t(new Thing) become from box at (0, 0, 0) in (1, 1, .5).\n"))
    return;
  if (take(&s, &p)) {
    const double half = pow((0.5 + 0.055) / 1.055, 2.4);
    const double wanted[3] = {encoded(0.6), encoded(0.5), encoded(half * 0.4)};
    for (int c = 0; c < 3; ++c) CHECK_NEAR(wanted[c], pixel(&p, 320, 240)[c], 2.55);
    CHECK(pixel(&p, 2, 2)[0] == 0);
  }
  drop(&p);
  scene_close(&s);
}

static void a_shadow_lies_where_the_light_throws_it(void) {
  scene s;
  shot p;
  if (!open_show(&s,
                 "\t\tthing = new Stationary.\n"
                 "\t\tthing register with-shape ((new Cube) init-with size (60, 2, 60)) at-location (0, -1, 0) "
                 "with-rotation [(1, 0, 0), (0, 1, 0), (0, 0, 1)].\n"
                 "\t\tthing set-texture-image to 0. thing catch-shadows.\n"
                 "\t\tself enable-lighting. self enable-shadows. self move-light to (10, 20, 0).\n"
                 "\t\tself point-camera at (0, 0, 0) from (0, 40, 0.001).\n"
                 "\t\t(new Thing) become from ((new Sphere) init-with radius 1) at (6, 12, 0) in (1, 1, 1).\n"))
    return;
  if (take(&s, &p)) {
    /* The cone about the sphere meets the floor in an ellipse, from x = 10 - 20 tan(a + b) to 10 - 20 tan(a - b). */
    const double a = atan(0.5), b = asin(1 / sqrt(80)), unit = 240 / slope() / 40;
    const double low = 10 - 20 * tan(a + b), high = 10 - 20 * tan(a - b), middle = (low + high) / 2;
    const double along = (200 - 4 * middle) / sqrt(80) / cos(b); /* from the light to the ellipse's widest place */
    const double width = sqrt(along * along - (middle - 10) * (middle - 10) - 400);
    const double area = acos(-1) * (high - low) / 2 * width;
    const double lit = light_of(pixel(&p, 320, 60)), shade = light_of(pixel(&p, 320 + (int)(unit * middle), 240));
    double dark = 0, sum = 0, longest = 0;
    CHECK(lit > 2 * shade);
    for (int y = 240 - 60; y < 240 + 60; ++y) {
      double row_dark = 0;
      for (int x = 320 + (int)(unit * low) - 12; x < 320 + (int)(unit * high) + 12; ++x) {
        const double part = fmin(1, fmax(0, (lit - light_of(pixel(&p, x, y))) / (lit - shade)));
        row_dark += part;
        sum += part * (x + 0.5 - 320);
      }
      dark += row_dark;
      longest = fmax(longest, row_dark);
    }
    CHECK_NEAR(area, dark / unit / unit, kPercent * area);
    CHECK_NEAR(middle, sum / dark / unit, kPercent * (high - low));
    CHECK_NEAR(high - low, longest / unit, kPercent * (high - low));
  }
  drop(&p);
  scene_close(&s);
}

/* Is a shared library in this process whose name has this part? */
static bool has_loaded(const char* part) {
  char line[512];
  bool found = false;
  FILE* maps = fopen("/proc/self/maps", "r");
  if (!CHECK(maps != NULL)) return false;
  while (fgets(line, sizeof line, maps)) found = found || strstr(line, part) != NULL;
  fclose(maps);
  return found;
}

/* It goes first: libraries stay loaded. Scenes are made of meshes and textures, which nobody has asked for either. */
static void a_world_that_nobody_looks_at_loads_no_graphics(void) {
  scene s;
  shot p;
  breve_view_counters counters = breve_view_counters_default();
  if (!open_show(&s,
                 "\t\tthing = new Stationary.\n"
                 "\t\tthing register with-shape ((new Cube) init-with size (60, 2, 60)) at-location (0, -1, 0) "
                 "with-rotation [(1, 0, 0), (0, 1, 0), (0, 0, 1)].\n"
                 "\t\tself enable-lighting. self enable-shadows. self set-display-text to \"text\" at-x 0 at-y 0.\n"
                 "\t\teye = new Camera. eye set-size with-height 60 with-width 80.\n"
                 "\t\t(new Thing) become from ball at (0, 5, 0) in (1, 1, 1).\n"))
    return;
  for (int i = 0; i < 5; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(!has_loaded("OSMesa") && !has_loaded("LLVM"));
  if (take(&s, &p)) {
    CHECK(has_loaded("OSMesa"));
    CHECK_STATUS(BREVE_OK, breve_view_counts(p.view, &counters));
    CHECK(counters.uploads >= 3); /* a box, a sphere, the texture of the box: the first time they are needed */
  }
  drop(&p);
  scene_close(&s);
}

static void a_window_leaves_the_rest_of_the_picture(void) {
  scene s;
  shot p;
  if (!open_show(&s,
                 "\t\tself set-background-color to (0, .5, 0). self point-camera at (0, 0, 0) from (0, 0, 20).\n"
                 "\t\t(new Thing) become from box at (0, 0, 0) in (1, 1, 1).\n"
                 "\t\teye = new Camera. eye look at (50, 0, 0) from (0, 0, 5). eye set-position with-x 10 with-y 20.\n"
                 "\t\teye set-size with-height 60 with-width 80.\n"))
    return;
  if (take(&s, &p)) {
    CHECK(pixel(&p, 320, 240)[0] == 255);                            /* the box */
    CHECK(pixel(&p, 5, 5)[1] > 100 && pixel(&p, 600, 470)[1] > 100); /* the background around */
    CHECK(pixel(&p, 12, 480 - 22)[1] > 100 &&
          pixel(&p, 12, 480 - 22)[0] == 0); /* and in the window, which sees no box */
    CHECK_NEAR(19.5, p.depth[240 * kWidth + 320], kPercent * 19.5);
  }
  drop(&p);
  scene_close(&s);
}

static uint64_t draw_calls(int bodies) {
  scene s;
  shot p;
  char body[256];
  breve_view_counters counters = breve_view_counters_default();
  snprintf(
      body, sizeof body,
      "\t\tfor count = 0, count < %d, count++: (new Thing) become from ball at random[(40, 40, 40)] in (1, 1, 1).\n",
      bodies);
  if (!open_show(&s, body)) return 0;
  if (take(&s, &p)) CHECK_STATUS(BREVE_OK, breve_view_counts(p.view, &counters));
  CHECK(counters.instances == (uint64_t)bodies);
  drop(&p);
  scene_close(&s);
  return counters.draw_calls;
}

static void draw_calls_do_not_grow_with_bodies(void) {
  const uint64_t few = draw_calls(50), many = draw_calls(2000);
  CHECK(few > 0 && many <= few + 2); /* spheres of three sizes in the picture are three meshes */
}

static void a_picture_changes_nothing(void) {
  scene s;
  shot p, again;
  uint64_t before = 0, after = 1;
  if (!open_show(&s, "\t\t(new Thing) become from ball at (0, 0, 0) in (1, .5, 0).\n")) return;
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &before));
  if (take(&s, &p) && take(&s, &again)) CHECK(memcmp(p.rgba, again.rgba, 4 * kPixels) == 0);
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &after));
  CHECK(before == after);
  drop(&p);
  drop(&again);
  scene_close(&s);
}

static void what_cannot_be_drawn_is_refused(void) {
  scene s;
  breve_view* view = NULL;
  if (!open_show(&s, "")) return;
  const uint32_t sizes[][2] = {{0, 10}, {10, 0}, {1000000, 10}, {10, 1000000}, {16385, 16385}};
  for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
    breve_view_config config = breve_view_config_default();
    config.width = sizes[i][0];
    config.height = sizes[i][1];
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_view_create(s.runtime, &config, &view));
  }
  breve_view_config config = breve_view_config_default();
  config.samples = 3;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_view_create(s.runtime, &config, &view));
  config = breve_view_config_default();
  config.look = 2;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_view_create(s.runtime, &config, &view));
  config = breve_view_config_default();
  config.font = "/dev/null";
  CHECK_STATUS(BREVE_ERROR_FILE, breve_view_create(s.runtime, &config, &view));
  config = breve_view_config_default();
  config.width = config.height = 8;
  uint8_t rgba[8 * 8 * 4];
  float depth[64];
  CHECK_STATUS(BREVE_OK, breve_view_create(s.runtime, &config, &view));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_view_depth(view, depth, 0));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_view_render(view, s.world, rgba, 31));
  CHECK_STATUS(BREVE_OK, breve_view_render(view, s.world, rgba, 32));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_view_depth(view, depth, 33));
  breve_view_destroy(view);
  size_t size = 0;
  CHECK_STATUS(BREVE_OK, breve_png(8, 8, rgba, 0, NULL, 0, &size));
  CHECK(size > 60);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_png(0, 8, rgba, 0, NULL, 0, &size));
  scene_close(&s);
}

/* --- plots and movies ----------------------------------------------------------------------------------------------- */

static void a_graph_is_rows_that_a_host_can_draw(void) {
  scene s;
  breve_scene* seen = NULL;
  if (!open_show(&s,
                 "\t\tthing = new Graph. thing set-title to \"waves\". thing set-x-axis-name to \"step\".\n"
                 "\t\tthing add-line with-color (1, .5, 0). thing add-line with-color (0, 0, 1).\n"
                 "\t\tfor count = 0, count < 3, count++: thing add-point on-line 1 with-value count * .5.\n"))
    return;
  CHECK_STATUS(BREVE_OK, breve_scene_create(&seen));
  CHECK_STATUS(BREVE_OK, breve_scene_read(seen, s.world));
  const breve_rows plots = rows_of(seen, BREVE_SCENE_PLOTS), lines = rows_of(seen, BREVE_SCENE_PLOT_LINES);
  CHECK(plots.count == 1 && lines.count == 2);
  const breve_plot* plot = row(&plots, 0);
  CHECK_TEXT("waves", plot->title);
  CHECK_TEXT("step", plot->x_axis);
  CHECK_TEXT("", plot->y_axis);
  CHECK(plot->first_line == 0 && plot->line_count == 2 && breve_object_alive(s.world, plot->object));
  const breve_plot_line *first = row(&lines, 0), *second = row(&lines, 1);
  CHECK(first->count == 0 && first->color[1] == 0.5F && second->count == 3 && second->plot == 0);
  CHECK(second->values[2] == 1.0);
  breve_scene_destroy(seen);
  scene_close(&s);
}

/* The plot as a file, which is freed by the caller. */
static char* plot_text(const breve_plot_config* config, uint32_t format, size_t* size) {
  CHECK_STATUS(BREVE_OK, breve_plot_file(config, format, NULL, 0, size));
  char* text = calloc(*size + 1, 1);
  CHECK_STATUS(BREVE_OK, breve_plot_file(config, format, (uint8_t*)text, *size, size));
  return text;
}

static void a_plot_is_a_table_and_pictures(void) {
  const double xs[] = {0, 2, 4}, ups[] = {1, 2, 3}, holes[] = {5, NAN, 1e300};
  const breve_plot_line lines[] = {{"a,b", ups, 3, {1, 0, 0}, 0}, {NULL, holes, 3, {0, 0, 1}, 0}};
  breve_plot_config config = breve_plot_config_default();
  config.title = "<title>";
  config.x_axis = "time, s";
  config.xs = xs;
  config.x_count = 3;
  config.lines = lines;
  config.line_count = 2;
  size_t size = 0;
  char* csv = plot_text(&config, BREVE_PLOT_FORMAT_CSV, &size);
  CHECK_TEXT("\"time, s\",\"a,b\",line 1\n0,1,5\n2,2,\n4,3,1e+300\n", csv);
  char* svg = plot_text(&config, BREVE_PLOT_FORMAT_SVG, &size);
  CHECK(strstr(svg, "&lt;title&gt;") && strstr(svg, "time, s") && strstr(svg, "a,b") && strstr(svg, "#ff0000"));
  CHECK(!strstr(svg, "nan") && !strstr(svg, "inf") && strstr(svg, "</svg>"));
  char* png = plot_text(&config, BREVE_PLOT_FORMAT_PNG, &size);
  CHECK(size > 1000 && memcmp(png, "\x89PNG", 4) == 0);
  free(csv);
  free(svg);
  free(png);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_plot_file(&config, 3, NULL, 0, &size));
  config.lines = NULL;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_plot_file(&config, BREVE_PLOT_FORMAT_SVG, NULL, 0, &size));
  config = breve_plot_config_default();
  CHECK_STATUS(BREVE_OK, breve_plot_file(&config, BREVE_PLOT_FORMAT_SVG, NULL, 0, &size));
}

static bool keep(void* user, const void* bytes, size_t size) {
  *(size_t*)user = memcmp(bytes, "GIF89a", 6) == 0 ? size : 0;
  return true;
}

static void a_movie_of_a_world_is_a_file(void) {
  scene s;
  breve_view* view = NULL;
  breve_movie* movie = NULL;
  size_t size = 0;
  uint8_t rgba[32 * 24 * 4];
  if (!open_show(
          &s,
          "\t\tthing = ((new Thing) become from ball at (0, 0, 0) in (1, .5, 0)). thing set-velocity to (9, 0, 0).\n"))
    return;
  breve_view_config look = breve_view_config_default();
  look.width = 32;
  look.height = 24;
  breve_movie_config config = breve_movie_config_default();
  config.width = 32;
  config.height = 24;
  config.format = "gif";
  config.user = &size;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_movie_create(s.runtime, &config, &movie));
  config.write = keep;
  CHECK_STATUS(BREVE_OK, breve_movie_create(s.runtime, &config, &movie));
  CHECK_STATUS(BREVE_OK, breve_view_create(s.runtime, &look, &view));
  CHECK_STATUS(BREVE_OK, breve_view_set_arrows(view, BREVE_ARROWS_VELOCITIES, 1));
  for (int i = 0; i < 4; ++i) {
    CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
    CHECK_STATUS(BREVE_OK, breve_view_render(view, s.world, rgba, 0));
    CHECK_STATUS(BREVE_OK, breve_movie_add(movie, rgba, 0));
  }
  CHECK_STATUS(BREVE_OK, breve_movie_finish(movie));
  CHECK(size > 3000); /* each picture has a palette */
  breve_movie_destroy(movie);
  breve_view_destroy(view);
  scene_close(&s);
}

void view_suite(void) {
  RUN(a_world_that_nobody_looks_at_loads_no_graphics);
  RUN(bodies_that_look_alike_share_a_mesh);
  RUN(triangles_of_every_shape_face_outward);
  RUN(lines_texts_and_lights_are_rows);
  RUN(a_sky_box_is_six_textures);
  RUN(a_point_is_seen_where_the_camera_says);
  RUN(a_camera_that_the_program_places_is_not_automatic);
  RUN(a_camera_that_is_half_wrong_leaves_the_last_one);
  RUN(the_silhouette_of_a_sphere_has_its_area_and_middle);
  RUN(a_plane_has_its_depth);
  RUN(a_lit_face_has_its_colour);
  RUN(a_shadow_lies_where_the_light_throws_it);
  RUN(a_window_leaves_the_rest_of_the_picture);
  RUN(draw_calls_do_not_grow_with_bodies);
  RUN(a_picture_changes_nothing);
  RUN(what_cannot_be_drawn_is_refused);
  RUN(a_graph_is_rows_that_a_host_can_draw);
  RUN(a_plot_is_a_table_and_pictures);
  RUN(a_movie_of_a_world_is_a_file);
}
