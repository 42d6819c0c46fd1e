/* What there is to see, as rows: scenes without a renderer. */
#include <math.h>

#include "show.h"

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
  CHECK_NEAR(8 * acos(-1), six_volumes(sphere), PERCENT * 8 * acos(-1));
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
    CHECK_NEAR(shapes[i].volume, scale * six_volumes(row(&meshes, one->mesh)) / 6, 2 * PERCENT * shapes[i].volume);
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

void scene_rows_suite(void) {
  RUN(bodies_that_look_alike_share_a_mesh);
  RUN(triangles_of_every_shape_face_outward);
  RUN(lines_texts_and_lights_are_rows);
  RUN(a_sky_box_is_six_textures);
  RUN(a_point_is_seen_where_the_camera_says);
  RUN(a_camera_that_the_program_places_is_not_automatic);
  RUN(a_graph_is_rows_that_a_host_can_draw);
}
