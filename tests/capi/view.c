/* What a script wants to be seen, and what was set: hosts read all of it. */
#include <math.h>
#include <stdlib.h>

#include "bodies.h"

static const char* const painter_text =
    "@use Control.\n@use Mobile.\n@use Drawing.\n@use Image.\n@use Camera.\n"
    "Controller Main.\n"
    "Control : Main {\n"
    "  + variables:\n    ball, other, drawing, picture, extra, rope (object).\n"
    "  + to init:\n"
    "    ball = new Mobile. other = new Mobile. other move to (5, 0, 0).\n"
    "    picture = (new Image) init-with width 3 height 2.\n"
    "    picture set-red-pixel to 1.0 at-x 1 at-y 0.\n"
    "    ball set-color to (1, .5, .25). ball set-transparency to .75. ball set-label to \"a ball\".\n"
    "    ball set-texture-image to picture. ball set-texture-scale to 4. ball disable-shadows. ball show-axis.\n"
    "    rope = (ball add-line to other with-color (0, 1, 0) with-style \"-- -\").\n"
    "    drawing = new Drawing. drawing set-color to (1, 0, 0). drawing draw-line from (0, 0, 0) to (1, 2, 3).\n"
    "    extra = new Camera. extra set-size with-height 100 with-width 200. extra set-position with-x 20 with-y 10.\n"
    "    self offset-camera by (0, 3, 4). self aim-camera at (1, 0, 0).\n"
    "    self set-background-color to (.1, .2, .3). self enable-fog. self set-fog-color to (.4, .5, .6).\n"
    "    self set-fog-limits with-start 5 with-end 50. self enable-lighting.\n"
    "    self set-display-text to \"score\" at-x .5 at-y -.5 number 2 with-color (1, 1, 0).\n"
    "    self move-light to (1, 2, 3).\n"
    "}\n";

static breve_object object_of(scene* s, const char* variable) { return value_of(s, variable).as.object; }

static void a_host_sees_what_a_script_draws(void) {
  scene s;
  if (!scene_open_text(&s, painter_text, NULL)) return;
  breve_world* const w = s.world;
  const breve_object ball = object_of(&s, "ball"), picture = object_of(&s, "picture");
  breve_look look = breve_look_default();
  CHECK_STATUS(BREVE_OK, breve_object_look(w, ball, &look));
  CHECK(look.color[0] == 1 && look.color[2] == 0.25 && look.alpha == 0.75);
  CHECK_TEXT("a ball", look.label);
  CHECK(same_object(look.texture, picture) && look.bitmap.generation == 0);
  CHECK(look.texture_scale[0] == 4 && look.texture_scale[1] == 4);
  CHECK(look.visible && !look.shadows && look.axes && !look.bounding_box && !look.as_point);
  breve_line line;
  CHECK_STATUS(BREVE_OK, breve_line_state(w, object_of(&s, "rope"), &line));
  CHECK(same_object(line.from, ball) && line.color[1] == 1 && (line.style & 0xf) == 0xb);
  breve_draw commands[4];
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_drawing_commands(w, object_of(&s, "drawing"), commands, 4, &count));
  if (CHECK(count == 2)) {
    CHECK(commands[0].kind == BREVE_DRAW_COLOR && commands[0].to[0] == 1);
    CHECK(commands[1].kind == BREVE_DRAW_LINE && commands[1].to[2] == 3 && commands[1].from[2] == 0);
  }
  uint32_t width = 0, height = 0;
  unsigned char pixels[24] = {0};
  CHECK_STATUS(BREVE_OK, breve_image_pixels(w, picture, NULL, 0, &width, &height));
  CHECK(width == 3 && height == 2);
  CHECK_STATUS(BREVE_OK, breve_image_pixels(w, picture, pixels, sizeof pixels - 1, &width, &height));
  CHECK(pixels[3] == 0);
  CHECK_STATUS(BREVE_OK, breve_image_pixels(w, picture, pixels, sizeof pixels, &width, &height));
  CHECK(pixels[4] == 255 && pixels[5] == 0 && pixels[3] == 255);
  scene_close(&s);
}

static void a_host_sees_where_cameras_stand_and_what_is_around(void) {
  scene s;
  if (!scene_open_text(&s, painter_text, NULL)) return;
  breve_world* const w = s.world;
  const breve_object nobody = {0, 0};
  breve_camera camera = breve_camera_default();
  CHECK_STATUS(BREVE_OK, breve_camera_state(w, nobody, &camera));
  CHECK_NEAR(1, camera.location[0], 1e-12);
  CHECK_NEAR(3, camera.location[1], 1e-12);
  CHECK_NEAR(4, camera.location[2], 1e-12);
  CHECK(camera.target[0] == 1 && camera.enabled && camera.size[0] == 0);
  /* Upright to the view: (0, 3, 4) / 5 is the way to the camera. */
  CHECK_NEAR(0, camera.up[0], 1e-12);
  CHECK_NEAR(0.8, camera.up[1], 1e-12);
  CHECK_NEAR(-0.6, camera.up[2], 1e-12);
  CHECK_STATUS(BREVE_OK, breve_camera_state(w, object_of(&s, "extra"), &camera));
  CHECK(camera.size[0] == 200 && camera.size[1] == 100 && camera.corner[0] == 20 && camera.corner[1] == 10);
  breve_view view = breve_view_default();
  CHECK_STATUS(BREVE_OK, breve_world_view(w, &view));
  CHECK(view.background[1] == 0.2 && view.fog && view.fog_start == 5 && view.fog_end == 50 && view.fog_color[2] == 0.6);
  CHECK(view.lighting && !view.shadows && view.selection.generation == 0 && view.blur == 0);
  breve_light light;
  CHECK_STATUS(BREVE_OK, breve_world_light(w, 0, &light));
  CHECK(light.location[2] == 3);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_world_light(w, 8, &light));
  breve_text text;
  CHECK_STATUS(BREVE_OK, breve_world_text(w, 2, &text));
  CHECK_TEXT("score", text.text);
  CHECK(text.location[0] == 0.5 && text.color[1] == 1);
  CHECK_STATUS(BREVE_OK, breve_world_text(w, 3, &text));
  CHECK_TEXT("", text.text);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_world_text(w, 8, &text));
  /* Objects of other kinds, and structs of no size. */
  breve_draw command;
  breve_line line;
  size_t count;
  uint32_t width, height;
  const breve_object ball = object_of(&s, "ball");
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_camera_state(w, ball, &camera));
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_drawing_commands(w, ball, &command, 1, &count));
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_line_state(w, ball, &line));
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_image_pixels(w, ball, NULL, 0, &width, &height));
  camera.struct_size = 1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_camera_state(w, nobody, &camera));
  breve_look look = breve_look_default();
  CHECK_STATUS(BREVE_ERROR_NO_BODY, breve_object_look(w, breve_world_controller(w), &look));
  scene_close(&s);
}

static void what_is_set_is_read_back(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  breve_world* const w = s.world;
  const breve_geometry ball = ball_of_radius(1);
  const breve_object body = add_body(&s, "Mobile", &ball, 0, 0, 0), other = add_body(&s, "Mobile", &ball, 5, 0, 0);
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(w, body, true));
  breve_material material = {0.5, 0.25, 0.75, -0.5, 0.125}, read = {9, 9, 9, 9, 9};
  CHECK_STATUS(BREVE_OK, breve_object_material(w, body, &read));
  CHECK(read.static_friction == -1 && read.dynamic_friction == -1 && read.restitution == -1);
  CHECK_STATUS(BREVE_OK, breve_object_set_material(w, body, &material));
  CHECK_STATUS(BREVE_OK, breve_object_material(w, body, &read));
  CHECK(memcmp(&read, &material, sizeof read) == 0);
  const double force[3] = {1, 2, 3}, torque[3] = {4, 5, 6};
  double f[3], t[3];
  CHECK_STATUS(BREVE_OK, breve_object_set_force(w, body, force, torque));
  CHECK_STATUS(BREVE_OK, breve_object_force(w, body, f, t));
  CHECK(memcmp(f, force, sizeof f) == 0 && memcmp(t, torque, sizeof t) == 0);
  CHECK(!breve_world_sleeping(w) && breve_world_workers(w) == 1);
  CHECK_STATUS(BREVE_OK, breve_world_set_sleeping(w, true));
  CHECK_STATUS(BREVE_OK, breve_world_set_workers(w, 3));
  CHECK(breve_world_sleeping(w) && breve_world_workers(w) == 3);
  breve_accuracy accuracy = breve_accuracy_default(), own = breve_accuracy_default();
  CHECK_STATUS(BREVE_OK, breve_rung_accuracy(BREVE_RUNG_PRECISE, &accuracy));
  CHECK_STATUS(BREVE_OK, breve_object_set_accuracy(w, body, &accuracy));
  CHECK_STATUS(BREVE_OK, breve_object_accuracy(w, body, &own));
  CHECK(own.rung == BREVE_RUNG_PRECISE);
  CHECK_STATUS(BREVE_OK, breve_object_accuracy(w, other, &own));
  CHECK(own.rung == BREVE_RUNG_BALANCED);
  bool on = true;
  CHECK_STATUS(BREVE_OK, breve_object_self_collisions(w, body, &on));
  CHECK(!on);
  CHECK_STATUS(BREVE_OK, breve_object_set_self_collisions(w, body, true));
  CHECK_STATUS(BREVE_OK, breve_object_self_collisions(w, body, &on));
  CHECK(on);
  breve_spring spring = breve_spring_default(), is = breve_spring_default();
  breve_object made;
  spring.from = body;
  spring.to = other;
  spring.from_point[1] = 0.5;
  spring.length = 4;
  spring.mode = BREVE_SPRING_CONTRACT_ONLY;
  CHECK_STATUS(BREVE_OK, breve_spring_create(w, &spring, &made));
  CHECK_STATUS(BREVE_OK, breve_spring_description(w, made, &is));
  CHECK(memcmp(&is, &spring, sizeof is) == 0);
  CHECK_STATUS(BREVE_OK, breve_object_free(w, other));
  CHECK_STATUS(BREVE_OK, breve_spring_description(w, made, &is));
  CHECK(is.to.generation == 0 && is.length == 4);
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_spring_description(w, body, &is));
  scene_close(&s);
}

static void a_click_goes_to_what_a_ray_meets(void) {
  scene s;
  if (!scene_open(&s)) return;
  const double start[3] = {0, 0, 50}, way[3] = {0, 0, -100}, aside[3] = {0, 100, 0}, wrong[3] = {NAN, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_world_queue_click_ray(s.world, start, way));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "clicks") == 1 && same_object(value_of(&s, "clicked").as.object, ball_of(&s)));
  CHECK_STATUS(BREVE_OK, breve_world_queue_click_ray(s.world, start, aside));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "clicks") == 2 && value_of(&s, "clicked").as.object.generation == 0);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_queue_click_ray(s.world, wrong, way));
  scene_close(&s);
}

void view_suite(void) {
  RUN(a_host_sees_what_a_script_draws);
  RUN(a_host_sees_where_cameras_stand_and_what_is_around);
  RUN(what_is_set_is_read_back);
  RUN(a_click_goes_to_what_a_ray_meets);
}
