/* Debug draw: what is drawn of a scene, in numbers; nothing for parts that were not asked for. */
#include <math.h>

#include "bodies.h"

typedef struct picture {
  int lines, points, texts;
  double longest;        /* of the lines */
  double from[3], to[3]; /* of the last line */
  double at[3];          /* of the last point */
  double rgba[4];        /* of the last line */
  char text[64];         /* the last one */
} picture;

static void line(void* user, const double from[3], const double to[3], const double rgba[4]) {
  picture* p = user;
  double length = 0;
  for (int i = 0; i < 3; ++i) length += (to[i] - from[i]) * (to[i] - from[i]);
  p->longest = fmax(p->longest, sqrt(length));
  memcpy(p->from, from, sizeof p->from);
  memcpy(p->to, to, sizeof p->to);
  memcpy(p->rgba, rgba, sizeof p->rgba);
  ++p->lines;
}
static void point(void* user, const double at[3], const double rgba[4]) {
  picture* p = user;
  (void)rgba;
  memcpy(p->at, at, sizeof p->at);
  ++p->points;
}
static void text(void* user, const double at[3], const char* words, const double rgba[4]) {
  picture* p = user;
  (void)at, (void)rgba;
  snprintf(p->text, sizeof p->text, "%s", words);
  ++p->texts;
}

static const char* const program =
    "@use PhysicalControl.\n@use Mobile.\n@use Stationary.\n@use Shape.\n@use MultiBody.\n@use Spring.\n"
    "Controller Yard.\n"
    "PhysicalControl : Yard {\n"
    "  + variables: box, ball (object).\n"
    "  + to init:\n"
    "    box = new Mobile.\n"
    "    box set-shape to (new Shape init-with-cube size (1, 2, 3)).\n"
    "    box move to (10, 0, 0).\n"
    "    box set-color to (0.5, 0.25, 1).\n"
    "    box set-velocity to (0, 4, 0).\n"
    "    box set-neighborhood-size to 5.\n"
    "    box set-label to \"crate\".\n"
    "}\n";

static picture drawn(const scene* s, uint32_t parts) {
  picture p = {0};
  breve_debug_draw draw = breve_debug_draw_default();
  draw.user = &p;
  draw.parts = parts;
  draw.line = line;
  draw.point = point;
  draw.text = text;
  CHECK_STATUS(BREVE_OK, breve_world_debug_draw(s->world, &draw));
  return p;
}

static void a_box_is_its_twelve_edges_in_its_colour(void) {
  scene s;
  if (!scene_open_text(&s, program, NULL)) return;
  const picture p = drawn(&s, BREVE_DEBUG_SHAPES);
  CHECK(p.lines == 12 && p.points == 0 && p.texts == 0);
  CHECK_NEAR(3, p.longest, 1e-12);
  CHECK(fabs(p.from[0] - 10) <= 0.5 + 1e-12 && fabs(p.from[1]) <= 1 + 1e-12);
  CHECK(p.rgba[0] == 0.5 && p.rgba[1] == 0.25 && p.rgba[2] == 1 && p.rgba[3] == 1);
  scene_close(&s);
}

static void axes_velocities_neighbourhoods_and_names_are_drawn_at_the_body(void) {
  scene s;
  if (!scene_open_text(&s, program, NULL)) return;
  picture p = drawn(&s, BREVE_DEBUG_AXES);
  CHECK(p.lines == 3);
  CHECK_NEAR(sqrt(0.25 + 1 + 2.25), p.longest, 1e-12);
  p = drawn(&s, BREVE_DEBUG_VELOCITIES);
  CHECK(p.lines == 1 && p.from[0] == 10 && p.to[1] == 4);
  p = drawn(&s, BREVE_DEBUG_NEIGHBORHOODS);
  CHECK(p.lines == 48); /* two circles of 24 segments */
  CHECK_NEAR(2 * 5 * sin(3.14159265358979323846 / 24), p.longest, 1e-9);
  p = drawn(&s, BREVE_DEBUG_NAMES);
  CHECK(p.texts == 1);
  CHECK_TEXT("Mobile: crate", p.text);
  p = drawn(&s, 0);
  CHECK(p.lines + p.points + p.texts == 0);
  scene_close(&s);
}

static breve_object body(scene* s, double x, double y, double z) {
  breve_object object = {0, 0};
  const breve_pose pose = {{x, y, z}, {1, 0, 0, 0}};
  CHECK_STATUS(BREVE_OK, breve_object_create(s->world, "Link", &object));
  CHECK_STATUS(BREVE_OK, breve_object_set_pose(s->world, object, &pose));
  return object;
}

static void joints_and_springs_are_drawn_from_centre_to_pivot(void) {
  scene s;
  breve_joint_description joint = breve_joint_description_default(BREVE_JOINT_REVOLUTE);
  breve_spring spring = breve_spring_default();
  breve_object made;
  if (!scene_open_text(&s, program, NULL)) return;
  joint.parent = body(&s, 0, 0, 0);
  joint.child = body(&s, 0, 0, 0);
  joint.parent_point[1] = 2;
  joint.child_point[1] = -2;
  CHECK_STATUS(BREVE_OK, breve_joint_create(s.world, &joint, &made));
  picture p = drawn(&s, BREVE_DEBUG_JOINTS);
  CHECK(p.lines == 3 && p.points == 1); /* to both centres, and the axis */
  CHECK_NEAR(2, p.at[1], 1e-12);
  CHECK(fabs(p.to[0]) > 0.1 && fabs(p.to[1] - 2) < 1e-12); /* the axis is along x */
  spring.from = joint.child;
  spring.to = body(&s, 0, 9, 0);
  CHECK_STATUS(BREVE_OK, breve_spring_create(s.world, &spring, &made));
  p = drawn(&s, BREVE_DEBUG_JOINTS);
  CHECK(p.lines == 4);
  CHECK_NEAR(9, p.to[1], 1e-12);
  scene_close(&s);
}

static void contacts_are_those_of_the_list_and_impacts_need_no_list(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_geometry round = ball_of_radius(0.5), slab = box_of_size(10, 1, 10);
  add_body(&s, "Stationary", &slab, 0, 0, 0);
  const breve_object ball = add_body(&s, "Mobile", &round, 0, 1.2, 0);
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(s.world, ball, true));
  CHECK_STATUS(BREVE_OK, breve_world_set_events(s.world, BREVE_EVENT_CONTACT));
  CHECK_STATUS(BREVE_OK, breve_object_watch_contacts(s.world, ball, true));
  int contacts = 0, impacts = 0;
  for (int i = 0; i < 60; ++i) {
    breve_contact listed[4];
    size_t count = 0;
    CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
    CHECK_STATUS(BREVE_OK, breve_world_contacts(s.world, listed, 4, &count));
    const picture p = drawn(&s, BREVE_DEBUG_CONTACTS);
    if (count != 0 && listed[0].phase != BREVE_PHASE_END) {
      CHECK(p.points == (int)count && p.lines == (int)count);
      CHECK(memcmp(p.at, listed[count - 1].point, sizeof p.at) == 0);
    } else {
      CHECK(p.points == 0);
    }
    contacts += p.points;
    impacts += drawn(&s, BREVE_DEBUG_IMPACTS).points;
  }
  CHECK(contacts > 0 && impacts > 0);
  scene_close(&s);
}

static void what_is_out_of_range_is_refused(void) {
  scene s;
  breve_debug_draw draw = breve_debug_draw_default();
  if (!scene_open_text(&s, program, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_debug_draw(s.world, &draw)); /* without functions nothing is drawn */
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_debug_draw(s.world, NULL));
  draw.parts = 256;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_debug_draw(s.world, &draw));
  draw = breve_debug_draw_default();
  draw.segments = 2;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_debug_draw(s.world, &draw));
  draw.segments = 257;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_debug_draw(s.world, &draw));
  draw = breve_debug_draw_default();
  draw.impulse_scale = NAN;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_debug_draw(s.world, &draw));
  draw = breve_debug_draw_default();
  draw.struct_size = 3;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_debug_draw(s.world, &draw));
  scene_close(&s);
}

void debug_draw_suite(void) {
  RUN(a_box_is_its_twelve_edges_in_its_colour);
  RUN(axes_velocities_neighbourhoods_and_names_are_drawn_at_the_body);
  RUN(joints_and_springs_are_drawn_from_centre_to_pivot);
  RUN(contacts_are_those_of_the_list_and_impacts_need_no_list);
  RUN(what_is_out_of_range_is_refused);
}
