/* What contacts carry: the weight of what rests, in space and in flat worlds, awake and asleep. */
#include <math.h>

#include "bodies.h"

static const double gravity = 9.81;

static double force_on(scene* s, breve_object object, breve_object other, int axis) {
  double force[3] = {9, 9, 9};
  CHECK_STATUS(BREVE_OK, breve_object_contact_force(s->world, object, other, force));
  return force[axis];
}

static double mass_of(scene* s, breve_object object) {
  double mass = 0;
  CHECK_STATUS(BREVE_OK, breve_object_mass(s->world, object, &mass));
  return mass;
}

/* Boxes that stand on one another; the lowest on a floor, whose top is at 0. */
static void put_a_tower(scene* s, bool flat, breve_object* floor, breve_object* boxes, int count) {
  const breve_geometry slab = box_of_size(20, 1, 20);
  if (!open_bodies(s, flat)) return;
  *floor = add_body(s, "Stationary", &slab, 0, -0.5, 0);
  for (int i = 0; i < count; ++i) {
    const breve_geometry box = box_of_size(1, 1, 1 + i);
    boxes[i] = add_body(s, "Mobile", &box, 0, 0.5 + i, 0);
    CHECK_STATUS(BREVE_OK, breve_object_set_physics(s->world, boxes[i], true));
  }
}

static void carries_its_weight(breve_rung rung, bool flat) {
  const breve_object all = {0, 0};
  breve_accuracy accuracy = breve_accuracy_default();
  breve_object floor, boxes[3];
  scene s;
  put_a_tower(&s, flat, &floor, boxes, 3);
  CHECK_STATUS(BREVE_OK, breve_rung_accuracy(rung, &accuracy));
  CHECK_STATUS(BREVE_OK, breve_world_set_accuracy(s.world, &accuracy));
  CHECK(force_on(&s, boxes[0], floor, 1) == 0); /* before the first step */
  step_times(&s, 60);
  double above = 0;
  for (int i = 2; i >= 0; --i) {
    const double weight = mass_of(&s, boxes[i]) * gravity;
    const breve_object below = i > 0 ? boxes[i - 1] : floor;
    above += weight;
    CHECK_NEAR(above, force_on(&s, boxes[i], below, 1), 0.01 * above);
    CHECK_NEAR(-above, force_on(&s, below, boxes[i], 1), 0.01 * above);
    CHECK_NEAR(0, force_on(&s, boxes[i], below, 0), 0.01 * above);
    CHECK_NEAR(weight, force_on(&s, boxes[i], all, 1), 0.02 * above); /* from below, less what is on top */
  }
  CHECK_NEAR(-above, force_on(&s, floor, all, 1), 0.01 * above);
  CHECK(force_on(&s, boxes[2], floor, 1) == 0);
  scene_close(&s);
}

static void each_box_of_a_tower_carries_what_is_above_it(void) {
  for (int flat = 0; flat < 2; ++flat)
    for (int rung = BREVE_RUNG_FAST; rung <= BREVE_RUNG_CONSERVING; ++rung)
      carries_its_weight((breve_rung)rung, flat != 0);
}

static void sleepers_carry_on(bool flat) {
  breve_object floor, box;
  scene s;
  put_a_tower(&s, flat, &floor, &box, 1);
  const double weight = mass_of(&s, box) * gravity;
  bool asleep = false;
  CHECK_STATUS(BREVE_OK, breve_world_set_sleeping(s.world, true));
  for (int i = 0; i < 200 && !asleep; ++i) {
    step_times(&s, 1);
    CHECK_STATUS(BREVE_OK, breve_object_asleep(s.world, box, &asleep));
  }
  CHECK(asleep);
  step_times(&s, 5);
  CHECK_NEAR(weight, force_on(&s, box, floor, 1), 0.01 * weight);
  /* An image keeps it, before the restored world has taken a step and after. */
  static char image[1 << 20];
  size_t size = 0;
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, image, sizeof image, &size));
  CHECK_NEAR(weight, force_on(&s, box, floor, 1), 0.01 * weight);
  put_at(&s, box, 0, 9, 0);
  step_times(&s, 2);
  CHECK(force_on(&s, box, floor, 1) == 0);
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  CHECK_NEAR(weight, force_on(&s, box, floor, 1), 0.01 * weight);
  step_times(&s, 1);
  CHECK_NEAR(weight, force_on(&s, box, floor, 1), 0.01 * weight);
  scene_close(&s);
}
static void a_sleeping_body_still_carries_its_weight(void) { sleepers_carry_on(false), sleepers_carry_on(true); }

/* On a slope of 0.3 rad with friction the normal force is m g cos, the friction m g sin; together m g, upward. */
static void rests_on_a_slope(breve_rung rung, bool flat) {
  const breve_material rough = {0.9, 0.9, 0.3, 0, 0.5};
  breve_accuracy accuracy = breve_accuracy_default();
  const breve_geometry cube = box_of_size(1, 1, 1), slab = box_of_size(20, 1, 20);
  scene s;
  if (!open_bodies(&s, flat)) return;
  CHECK_STATUS(BREVE_OK, breve_rung_accuracy(rung, &accuracy));
  CHECK_STATUS(BREVE_OK, breve_world_set_accuracy(s.world, &accuracy));
  const breve_object slope = add_body(&s, "Stationary", &slab, 0, 0, 0);
  const breve_object box = add_body(&s, "Mobile", &cube, -sin(0.3), cos(0.3), 0);
  rotate_about_z(&s, slope, 0.3);
  rotate_about_z(&s, box, 0.3);
  CHECK_STATUS(BREVE_OK, breve_object_set_material(s.world, box, &rough));
  CHECK_STATUS(BREVE_OK, breve_object_set_material(s.world, slope, &rough));
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(s.world, box, true));
  step_times(&s, 100);
  const double weight = mass_of(&s, box) * gravity;
  CHECK_NEAR(weight, force_on(&s, box, slope, 1), 0.01 * weight);
  CHECK_NEAR(0, force_on(&s, box, slope, 0), 0.01 * weight);
  scene_close(&s);
}
static void friction_is_part_of_what_a_slope_carries(void) {
  for (int rung = BREVE_RUNG_FAST; rung <= BREVE_RUNG_CONSERVING; ++rung) rests_on_a_slope((breve_rung)rung, false);
  rests_on_a_slope(BREVE_RUNG_BALANCED, true);
}

static void links_carry_too_and_strangers_do_not(void) {
  const breve_geometry ball = ball_of_radius(0.5), slab = box_of_size(10, 1, 10);
  const breve_object all = {0, 0};
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_object floor = add_body(&s, "Stationary", &slab, 0, -0.5, 0);
  const breve_object parent = add_body(&s, "Link", &ball, 0, 0.5, 0), child = add_body(&s, "Link", &ball, 1, 0.5, 0);
  breve_joint_description weld = breve_joint_description_default(BREVE_JOINT_FIXED);
  breve_object joint;
  weld.parent = parent;
  weld.child = child;
  weld.parent_point[0] = 1;
  CHECK_STATUS(BREVE_OK, breve_joint_create(s.world, &weld, &joint));
  step_times(&s, 80);
  const double weight = (mass_of(&s, parent) + mass_of(&s, child)) * gravity;
  CHECK_NEAR(weight / 2, force_on(&s, parent, floor, 1), 0.01 * weight);
  CHECK_NEAR(-weight, force_on(&s, floor, all, 1), 0.01 * weight);
  double force[3] = {7, 7, 7};
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_contact_force(s.world, floor, floor, force));
  CHECK_STATUS(BREVE_ERROR_NO_BODY, breve_object_contact_force(s.world, floor, breve_world_controller(s.world), force));
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, child));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_contact_force(s.world, floor, child, force));
  CHECK(force[0] == 7);
  scene_close(&s);
}

void contact_force_suite(void) {
  RUN(each_box_of_a_tower_carries_what_is_above_it);
  RUN(a_sleeping_body_still_carries_its_weight);
  RUN(friction_is_part_of_what_a_slope_carries);
  RUN(links_carry_too_and_strangers_do_not);
}
