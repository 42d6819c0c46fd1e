/* Objects: enumeration, classes, making and freeing, poses, motion, colour, shapes. */
#include <math.h>
#include <stdlib.h>

#include "scene.h"

static bool same(breve_object a, breve_object b) { return a.index == b.index && a.generation == b.generation; }

static void objects_come_in_order_of_creation(void) {
  scene s;
  if (!scene_open(&s)) return;
  breve_object made[3], all[64];
  for (int i = 0; i < 3; ++i) CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Ball", &made[i]));
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, made[1]));
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Ball", &made[1])); /* may take the freed one's place */
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_world_objects(s.world, "Ball", all, 64, &count));
  CHECK(count == 4);
  CHECK(same(all[0], ball_of(&s)) && same(all[1], made[0]) && same(all[2], made[2]) && same(all[3], made[1]));
  size_t again = 0;
  CHECK_STATUS(BREVE_OK, breve_world_objects(s.world, "Balls", NULL, 0, &again)); /* the alias */
  CHECK(again == 4);
  breve_object one[2] = {{77, 77}, {77, 77}};
  CHECK_STATUS(BREVE_OK, breve_world_objects(s.world, "Mobile", one, 1, &again));
  CHECK(again == 4 && same(one[0], all[0]) && one[1].index == 77);
  CHECK_STATUS(BREVE_OK, breve_world_objects(s.world, NULL, all, 64, &again));
  CHECK(again > 4 && same(all[0], breve_world_controller(s.world)));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_world_objects(s.world, "Unicorn", all, 64, &again));
  scene_close(&s);
}

static void objects_know_their_class(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object ball = ball_of(&s);
  bool is = false;
  CHECK_TEXT("Ball", breve_object_class(s.world, ball));
  CHECK_TEXT("Stage", breve_object_class(s.world, breve_world_controller(s.world)));
  CHECK_STATUS(BREVE_OK, breve_object_is_a(s.world, ball, "Mobile", &is));
  CHECK(is);
  CHECK_STATUS(BREVE_OK, breve_object_is_a(s.world, ball, "Control", &is));
  CHECK(!is);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_object_is_a(s.world, ball, "Unicorn", &is));
  scene_close(&s);
}

static void a_freed_object_is_stale_everywhere(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object ball = ball_of(&s);
  CHECK(breve_object_alive(s.world, ball));
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, ball));
  CHECK_TEXT("gone\n", s.said.print); /* its destroy ran */
  CHECK(!breve_object_alive(s.world, ball));
  CHECK(breve_object_class(s.world, ball) == NULL);
  double v[4] = {0};
  size_t count;
  bool is;
  breve_pose pose = {{0}, {1, 0, 0, 0}};
  breve_shape shape;
  breve_value value = breve_value_object(ball);
  const breve_keyword keyword = {"value", value};
  breve_selector selector;
  CHECK_STATUS(BREVE_OK, breve_world_prepare(s.world, "touch", NULL, 0, &selector));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_free(s.world, ball));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_is_a(s.world, ball, "Ball", &is));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_pose(s.world, ball, &pose));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_set_pose(s.world, ball, &pose));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_set_target(s.world, ball, &pose));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_velocity(s.world, ball, v));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_set_velocity(s.world, ball, v));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_rotational_velocity(s.world, ball, v));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_set_rotational_velocity(s.world, ball, v));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_color(s.world, ball, v));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_set_color(s.world, ball, v));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_shape(s.world, ball, &shape));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_shape_vertices(s.world, ball, v, 1));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_shape_faces(s.world, ball, NULL, 0, NULL, 0));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_get(s.world, ball, "hits", &value));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_set(s.world, ball, "hits", &value));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_call(s.world, ball, "touch", NULL, 0, NULL));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_call_prepared(s.world, ball, selector, NULL, 0, NULL));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_world_queue_click(s.world, ball));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_world_queue_choice(s.world, ball));
  CHECK_STATUS(BREVE_ERROR_STALE,
               breve_object_call(s.world, breve_world_controller(s.world), "echo-object", &keyword, 1, NULL));
  for (int i = 0; i < 20; ++i) { /* whoever takes its place has another id */
    breve_object made;
    CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Ball", &made));
    CHECK(!same(made, ball));
  }
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(!breve_object_alive(s.world, ball));
  CHECK_STATUS(BREVE_OK, breve_world_objects(s.world, "Ball", NULL, 0, &count));
  CHECK(count == 20);
  scene_close(&s);
}

static void the_null_object_is_a_wrong_argument(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object null = {0, 0}, invented = {4000000000U, 7};
  breve_pose pose;
  CHECK(!breve_object_alive(s.world, null));
  CHECK(breve_object_class(s.world, null) == NULL);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_pose(s.world, null, &pose));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_free(s.world, null));
  CHECK(!breve_object_alive(s.world, invented));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_pose(s.world, invented, &pose));
  scene_close(&s);
}

static void an_object_whose_init_fails_is_not_made(void) {
  scene s;
  if (!scene_open(&s)) return;
  breve_object made = {5, 5};
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_object_create(s.world, "Broken", &made));
  CHECK(made.index == 5);
  CHECK(strstr(breve_world_last_error(s.world)->text, "cannot be made") != NULL);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_object_create(s.world, "Unicorn", &made));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  scene_close(&s);
}

static void poses_are_read_and_written(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object ball = ball_of(&s);
  breve_pose pose;
  CHECK_STATUS(BREVE_OK, breve_object_pose(s.world, ball, &pose));
  CHECK(pose.location[0] == 0 && pose.location[1] == 0 && pose.location[2] == 0);
  CHECK(pose.rotation[0] == 1 && pose.rotation[1] == 0 && pose.rotation[2] == 0 && pose.rotation[3] == 0);
  const breve_pose put = {{1, -2, 3}, {0, 0, 1e-200, 0}}; /* 180 degrees about y, not of unit length */
  CHECK_STATUS(BREVE_OK, breve_object_set_pose(s.world, ball, &put));
  CHECK_STATUS(BREVE_OK, breve_object_pose(s.world, ball, &pose));
  CHECK(pose.location[0] == 1 && pose.location[1] == -2 && pose.location[2] == 3);
  CHECK_NEAR(1, fabs(pose.rotation[2]), 1e-15);
  CHECK_NEAR(0, pose.rotation[0], 1e-15);
  const double nan = strtod("nan", NULL), infinity = strtod("inf", NULL);
  const breve_pose bad[] = {{{nan, 0, 0}, {1, 0, 0, 0}},
                            {{0, 0, infinity}, {1, 0, 0, 0}},
                            {{9, 9, 9}, {0, 0, 0, 0}},
                            {{9, 9, 9}, {nan, 0, 0, 0}}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i)
    CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_pose(s.world, ball, &bad[i]));
  CHECK_STATUS(BREVE_OK, breve_object_pose(s.world, ball, &pose));
  CHECK(pose.location[0] == 1); /* unchanged */
  CHECK_STATUS(BREVE_ERROR_NO_BODY, breve_object_pose(s.world, breve_world_controller(s.world), &pose));
  CHECK(strstr(breve_world_last_error(s.world)->message, "Stage") != NULL);
  scene_close(&s);
}

static void motion_and_colour_are_read_and_written(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object ball = ball_of(&s);
  double v[4] = {0};
  CHECK_STATUS(BREVE_OK, breve_object_velocity(s.world, ball, v));
  CHECK(v[0] == 1 && v[1] == 0 && v[2] == 0);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  breve_pose pose;
  CHECK_STATUS(BREVE_OK, breve_object_pose(s.world, ball, &pose));
  CHECK_NEAR(0.06, pose.location[0], 1e-15);
  const double velocity[3] = {0, 0, 2}, spin[3] = {0, 3, 0}, rgba[4] = {0.25, 0.5, 0.75, 0.125};
  CHECK_STATUS(BREVE_OK, breve_object_set_velocity(s.world, ball, velocity));
  CHECK_STATUS(BREVE_OK, breve_object_set_rotational_velocity(s.world, ball, spin));
  CHECK_STATUS(BREVE_OK, breve_object_velocity(s.world, ball, v));
  CHECK(v[2] == 2);
  CHECK_STATUS(BREVE_OK, breve_object_rotational_velocity(s.world, ball, v));
  CHECK(v[1] == 3);
  CHECK_STATUS(BREVE_OK, breve_object_color(s.world, ball, v));
  CHECK(v[0] == 1 && v[1] == 1 && v[2] == 1 && v[3] == 1);
  CHECK_STATUS(BREVE_OK, breve_object_set_color(s.world, ball, rgba));
  CHECK_STATUS(BREVE_OK, breve_object_color(s.world, ball, v));
  CHECK(memcmp(v, rgba, sizeof v) == 0);
  const double bad[4] = {0, 0, strtod("nan", NULL), 1};
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_velocity(s.world, ball, bad));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_rotational_velocity(s.world, ball, bad));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_color(s.world, ball, bad));
  CHECK_STATUS(BREVE_ERROR_NO_BODY, breve_object_color(s.world, breve_world_controller(s.world), v));
  scene_close(&s);
}

static void shapes_are_described_for_drawing(void) {
  scene s;
  if (!scene_open(&s)) return;
  breve_shape shape;
  CHECK_STATUS(BREVE_OK, breve_object_shape(s.world, ball_of(&s), &shape));
  CHECK(shape.kind == BREVE_SHAPE_SPHERE);
  CHECK_NEAR(1, shape.radius, 0);
  CHECK_NEAR(2, shape.size[1], 0);
  CHECK(shape.vertex_count == 0 && shape.face_count == 0 && shape.index_count == 0);
  breve_object block;
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Block", &block));
  CHECK_STATUS(BREVE_OK, breve_object_shape(s.world, block, &shape));
  CHECK(shape.kind == BREVE_SHAPE_BOX);
  CHECK_NEAR(2, shape.size[0], 1e-12);
  CHECK_NEAR(4, shape.size[1], 1e-12);
  CHECK_NEAR(6, shape.size[2], 1e-12);
  CHECK_NEAR(sqrt(1 + 4 + 9), shape.radius, 1e-9);
  CHECK(shape.vertex_count == 8 && shape.face_count == 6 && shape.index_count == 24);
  double vertices[24 + 3];
  uint32_t sizes[6], indices[24];
  vertices[24] = 99;
  CHECK_STATUS(BREVE_OK, breve_object_shape_vertices(s.world, block, vertices, 9));
  CHECK(vertices[24] == 99);
  CHECK_STATUS(BREVE_OK, breve_object_shape_faces(s.world, block, sizes, 6, indices, 24));
  double volume = 0; /* by the divergence theorem: right only if all faces are wound outward */
  for (size_t f = 0, next = 0; f < 6; next += sizes[f++]) {
    CHECK(sizes[f] == 4);
    for (size_t k = 1; k + 1 < sizes[f]; ++k) {
      const double *a = vertices + 3 * indices[next], *b = vertices + 3 * indices[next + k],
                   *c = vertices + 3 * indices[next + k + 1];
      volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                 a[2] * (b[0] * c[1] - b[1] * c[0])) /
                6;
    }
  }
  CHECK_NEAR(48, volume, 1e-9);
  uint32_t few[2] = {7, 7};
  CHECK_STATUS(BREVE_OK, breve_object_shape_faces(s.world, block, few, 1, NULL, 0));
  CHECK(few[0] == 4 && few[1] == 7);
  scene_close(&s);
}

void objects_suite(void) {
  RUN(objects_come_in_order_of_creation);
  RUN(objects_know_their_class);
  RUN(a_freed_object_is_stale_everywhere);
  RUN(the_null_object_is_a_wrong_argument);
  RUN(an_object_whose_init_fails_is_not_made);
  RUN(poses_are_read_and_written);
  RUN(motion_and_colour_are_read_and_written);
  RUN(shapes_are_described_for_drawing);
}
