/* Bodies with physics, built and driven by a host without a script, and beside scripts. */
#include <math.h>
#include <stdlib.h>

#include "scene.h"

static const breve_object nobody = {0, 0};

static bool same(breve_object a, breve_object b) { return a.index == b.index && a.generation == b.generation; }

/* A world of the class library alone. */
static bool open_library(scene* s) {
  memset(s, 0, sizeof *s);
  breve_runtime_config config = breve_runtime_config_default();
  config.user = &s->said;
  config.print = remember;
  return CHECK_STATUS(BREVE_OK, breve_runtime_create(&config, &s->runtime)) &&
         CHECK_STATUS(BREVE_OK, breve_program_create_library(s->runtime, NULL, &s->program)) &&
         CHECK_STATUS(BREVE_OK, breve_world_create(s->runtime, s->program, NULL, &s->world));
}

static breve_object make(scene* s, const char* class_name) {
  breve_object made = nobody;
  CHECK_STATUS(BREVE_OK, breve_object_create(s->world, class_name, &made));
  return made;
}

/* A hinge about z at the top of a link, held by `parent` at its lower end, or by the world at (0, 5, 0). */
static breve_object hinge(scene* s, breve_object parent, breve_object child) {
  breve_joint_description d = breve_joint_description_default(BREVE_JOINT_REVOLUTE);
  breve_object joint = nobody;
  d.parent = parent;
  d.child = child;
  d.parent_point[1] = parent.generation ? -0.5 : 5;
  d.child_point[1] = 0.5;
  d.normal[0] = 0;
  d.normal[2] = 1;
  CHECK_STATUS(BREVE_OK, breve_joint_create(s->world, &d, &joint));
  return joint;
}

static double height_of(scene* s, breve_object object) {
  breve_pose pose = {{0}, {1, 0, 0, 0}};
  CHECK_STATUS(BREVE_OK, breve_object_pose(s->world, object, &pose));
  return pose.location[1];
}

static void a_creature_is_built_and_driven_without_a_script(void) {
  scene s;
  if (!open_library(&s)) return;
  CHECK_TEXT("PhysicalControl", breve_object_class(s.world, breve_world_controller(s.world)));
  const breve_object upper = make(&s, "Link"), lower = make(&s, "Link");
  const breve_object shoulder = hinge(&s, nobody, upper), elbow = hinge(&s, upper, lower);
  CHECK_NEAR(4.5, height_of(&s, upper), 1e-12);
  CHECK_NEAR(3.5, height_of(&s, lower), 1e-12);
  breve_joint_info info;
  CHECK_STATUS(BREVE_OK, breve_joint_state(s.world, elbow, &info));
  CHECK(info.kind == BREVE_JOINT_REVOLUTE && info.linked && !info.loop);
  CHECK(same(info.parent, upper) && same(info.child, lower));
  CHECK_NEAR(5, info.hard_limit, 1e-12);
  breve_object parts[4];
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_object_links(s.world, lower, parts, 4, &count));
  CHECK(count == 2 && same(parts[0], upper) && same(parts[1], lower));
  CHECK_STATUS(BREVE_OK, breve_object_joints(s.world, lower, parts, 1, &count));
  CHECK(count == 2 && same(parts[0], shoulder));

  const double weightless[3] = {0, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_world_set_gravity(s.world, weightless));
  breve_drive drive = breve_drive_default();
  CHECK_STATUS(BREVE_OK, breve_joint_drive(s.world, elbow, &drive));
  CHECK(drive.strength_limit == 0 && drive.high[0] == INFINITY && drive.low[0] == -INFINITY);
  drive.strength_limit = 1e6;
  drive.motor_speed[0] = 2;
  CHECK_STATUS(BREVE_OK, breve_joint_set_drive(s.world, elbow, &drive));
  CHECK_STATUS(BREVE_OK, breve_joint_drive(s.world, elbow, &drive));
  CHECK_NEAR(5, drive.strength_limit, 1e-12); /* cut to the hard limit */
  for (int i = 0; i < 20; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_joint_state(s.world, elbow, &info));
  CHECK_NEAR(2, info.velocity[0], 1e-3);
  CHECK_NEAR(2, info.position[0], 0.05);
  breve_energy energy = breve_energy_default();
  CHECK_STATUS(BREVE_OK, breve_object_energy(s.world, upper, &energy));
  CHECK(energy.kinetic > 0 && energy.motor_work > 0);

  const double straight[3] = {0}, still[3] = {0};
  CHECK_STATUS(BREVE_OK, breve_joint_set_state(s.world, elbow, straight, still));
  CHECK_STATUS(BREVE_OK, breve_joint_state(s.world, elbow, &info));
  CHECK_NEAR(0, info.position[0], 1e-12);
  const breve_pose pose = {{1, 2, 3}, {2, 0, 0, 0}};
  CHECK_STATUS(BREVE_OK, breve_object_set_assembly_pose(s.world, upper, &pose));
  CHECK_NEAR(2, height_of(&s, upper), 1e-12);
  CHECK_NEAR(1, height_of(&s, lower), 1e-9);

  CHECK_STATUS(BREVE_OK, breve_joint_break(s.world, elbow));
  CHECK_STATUS(BREVE_OK, breve_joint_state(s.world, elbow, &info));
  CHECK(!info.linked && info.hard_limit == 0);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_joint_drive(s.world, elbow, &drive));
  CHECK_STATUS(BREVE_OK, breve_object_links(s.world, upper, NULL, 0, &count));
  CHECK(count == 1);
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, shoulder)); /* breaks it */
  CHECK_STATUS(BREVE_OK, breve_object_joints(s.world, upper, NULL, 0, &count));
  CHECK(count == 0);
  scene_close(&s);
}

static void every_kind_of_joint_has_its_axes(void) {
  scene s;
  if (!open_library(&s)) return;
  static const char* const classes[] = {"RevoluteJoint", "PrismaticJoint", "FixedJoint", "UniversalJoint", "BallJoint"};
  for (int kind = 0; kind < 5; ++kind) {
    breve_joint_description d = breve_joint_description_default((breve_joint_kind)kind);
    d.child = make(&s, "Link");
    d.parent_point[1] = 1;
    breve_object joint;
    breve_joint_info info;
    CHECK_STATUS(BREVE_OK, breve_joint_create(s.world, &d, &joint));
    CHECK_TEXT(classes[kind], breve_object_class(s.world, joint));
    CHECK_STATUS(BREVE_OK, breve_joint_state(s.world, joint, &info));
    CHECK(info.kind == (breve_joint_kind)kind && info.linked);
    breve_drive drive = breve_drive_default();
    CHECK_STATUS(BREVE_OK, breve_joint_drive(s.world, joint, &drive));
    if (kind == BREVE_JOINT_PRISMATIC) CHECK(drive.low[0] == -2 && drive.high[0] == 2);
    if (kind == BREVE_JOINT_BALL) CHECK_NEAR(1.2207963267948966, drive.high[1], 1e-12);
  }
  scene_close(&s);
}

static void what_cannot_be_joined_is_refused_and_nothing_changes(void) {
  scene s;
  if (!open_library(&s)) return;
  const breve_object link = make(&s, "Link"), rock = make(&s, "Stationary");
  const double nan = strtod("nan", NULL);
  uint64_t before, after;
  breve_object joint = {7, 7}, all[32];
  size_t count, again;
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &before));
  CHECK_STATUS(BREVE_OK, breve_world_objects(s.world, NULL, all, 32, &count));
  breve_joint_description good = breve_joint_description_default(BREVE_JOINT_REVOLUTE);
  good.child = link;
  breve_joint_description bad[8];
  for (int i = 0; i < 8; ++i) bad[i] = good;
  bad[0].parent = link; /* itself */
  bad[1].child = rock;  /* cannot move */
  bad[2].child_point[0] = nan;
  bad[3].normal[0] = 0;   /* no direction */
  bad[4].rotation[0] = 0; /* no rotation */
  bad[5].kind = (breve_joint_kind)9;
  bad[6].struct_size = 3;
  bad[7].reserved[0] = true;
  for (int i = 0; i < 8; ++i) {
    if (!CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_joint_create(s.world, &bad[i], &joint))) printf("  number %d\n", i);
    CHECK(breve_world_last_error(s.world)->message[0] != '\0');
  }
  good.child = breve_world_controller(s.world);
  CHECK_STATUS(BREVE_ERROR_NO_BODY, breve_joint_create(s.world, &good, &joint));
  CHECK(joint.index == 7);
  CHECK_STATUS(BREVE_OK, breve_world_objects(s.world, NULL, all, 32, &again));
  CHECK(again == count);
  breve_joint_info info;
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_joint_state(s.world, link, &info));
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_joint_break(s.world, link));
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_spring_state(s.world, link, NULL, NULL));

  const breve_object elbow = hinge(&s, nobody, link);
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &before));
  breve_drive drive = breve_drive_default();
  CHECK_STATUS(BREVE_OK, breve_joint_drive(s.world, elbow, &drive));
  drive.damping = -1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_joint_set_drive(s.world, elbow, &drive));
  drive.damping = 0;
  drive.low[0] = 2;
  drive.high[0] = 1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_joint_set_drive(s.world, elbow, &drive));
  drive.low[0] = nan;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_joint_set_drive(s.world, elbow, &drive));
  const double wrong[3] = {nan, 0, 0};
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_joint_set_state(s.world, elbow, wrong, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_joint_set_state(s.world, elbow, NULL, wrong));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_gravity(s.world, wrong));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_space(s.world, 0, BREVE_EDGE_WRAP, 1, 1));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_space(s.world, 0, BREVE_EDGE_WALL, nan, 1));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_space(s.world, 0, (breve_edge)3, 0, 1));
  breve_edge edge = BREVE_EDGE_WALL;
  double low = 7, high = 7;
  CHECK_STATUS(BREVE_OK, breve_world_space(s.world, 0, &edge, &low, &high));
  CHECK(edge == BREVE_EDGE_OPEN && low == 0 && high == 0);
  CHECK_STATUS(BREVE_OK, breve_world_set_space(s.world, 2, BREVE_EDGE_WRAP, -1000, 1000));
  CHECK_STATUS(BREVE_OK, breve_world_space(s.world, 2, &edge, &low, &high));
  CHECK(edge == BREVE_EDGE_WRAP && low == -1000 && high == 1000);
  CHECK_STATUS(BREVE_OK, breve_world_set_space(s.world, 2, BREVE_EDGE_OPEN, 0, 0));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_force(s.world, link, wrong, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_workers(s.world, 0));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_guard(s.world, (breve_guard)9));
  const breve_material slippery = {-1, 0, 0, 0, 0};
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_material(s.world, link, &slippery));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &after));
  CHECK(before == after);
  scene_close(&s);
}

static void shapes_of_every_kind_are_made_and_weighed(void) {
  scene s;
  if (!open_library(&s)) return;
  const breve_object body = make(&s, "Mobile");
  static const double corners[] = {-1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0, 1, 0, 1, 0};
  static const uint32_t sizes[] = {4, 3, 3, 3, 3}, indices[] = {0, 1, 2, 3, 0, 4, 1, 1, 4, 2, 2, 4, 3, 3, 4, 0};
  breve_geometry g[7];
  for (int i = 0; i < 7; ++i) {
    g[i] = breve_geometry_default();
    g[i].kind = (breve_shape_kind)i;
    g[i].density = 2;
  }
  g[1].size[0] = 3;
  g[3].vertices = corners;
  g[3].vertex_count = 5;
  g[3].face_sizes = sizes;
  g[3].face_count = 5;
  g[3].indices = indices;
  g[3].index_count = 16;
  g[2] = g[3];
  g[2].kind = BREVE_SHAPE_CONVEX;
  static const double raised[] = {-1, -0.5, -1, 1, -0.5, -1, 1, -0.5, 1, -1, -0.5, 1, 0, 0.5, 0};
  g[2].vertices = raised;
  static const double heights[6] = {0, 1, 0, 0, 2, 0};
  g[4].heights = heights;
  g[4].columns = 3;
  g[4].rows = 2;
  g[5].height = 3;
  g[6].height = 3;
  const double pi = 3.14159265358979323846;
  const double masses[] = {2 * 4.0 / 3 * pi, 6, 2 * 4.0 / 3, 2 * 4.0 / 3, 0, 6 * pi, 6 * pi + 2 * 4.0 / 3 * pi};
  for (int i = 0; i < 7; ++i) {
    breve_object shape;
    breve_shape drawn;
    double mass = 0;
    if (!CHECK_STATUS(BREVE_OK, breve_shape_create(s.world, &g[i], &shape))) {
      printf("  %s\n", breve_world_last_error(s.world)->message);
      continue;
    }
    CHECK_STATUS(BREVE_OK, breve_object_set_shape(s.world, body, shape));
    CHECK_STATUS(BREVE_OK, breve_object_mass(s.world, body, &mass));
    if (i != 4) CHECK_NEAR(masses[i], mass, 1e-9);
    CHECK_STATUS(BREVE_OK, breve_object_shape(s.world, body, &drawn));
    CHECK(drawn.kind == g[i].kind);
    if (i >= 5) CHECK(drawn.vertex_count >= 64 && drawn.face_count >= 34);
    if (i == 6) CHECK_NEAR(5, drawn.size[1], 1e-12);
  }
  breve_object shape = nobody;
  g[1].size[2] = 0;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_shape_create(s.world, &g[1], &shape));
  g[0].density = -1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_shape_create(s.world, &g[0], &shape));
  g[5].height = 0;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_shape_create(s.world, &g[5], &shape));
  g[6].radius = -1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_shape_create(s.world, &g[6], &shape));
  g[3].index_count = 15;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_shape_create(s.world, &g[3], &shape));
  g[2].vertex_count = 4;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_shape_create(s.world, &g[2], &shape));
  g[4].columns = 1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_shape_create(s.world, &g[4], &shape));
  g[4].kind = (breve_shape_kind)11;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_shape_create(s.world, &g[4], &shape));
  CHECK_STATUS(BREVE_ERROR_SCRIPT, breve_object_set_shape(s.world, body, body));
  scene_close(&s);
}

static void what_has_a_target_carries(void) {
  scene s;
  if (!open_library(&s)) return;
  const breve_object plate = make(&s, "Stationary"), ball = make(&s, "Mobile");
  breve_geometry box = breve_geometry_default();
  breve_object shape;
  box.kind = BREVE_SHAPE_BOX;
  box.size[0] = box.size[2] = 4;
  CHECK_STATUS(BREVE_OK, breve_shape_create(s.world, &box, &shape));
  CHECK_STATUS(BREVE_OK, breve_object_set_shape(s.world, plate, shape));
  box.size[0] = box.size[2] = 1;
  CHECK_STATUS(BREVE_OK, breve_shape_create(s.world, &box, &shape));
  CHECK_STATUS(BREVE_OK, breve_object_set_shape(s.world, ball, shape));
  const breve_material rough = {1, 1, 0, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_object_set_material(s.world, plate, &rough));
  CHECK_STATUS(BREVE_OK, breve_object_set_material(s.world, ball, &rough));
  breve_pose pose = {{0, 1, 0}, {1, 0, 0, 0}};
  CHECK_STATUS(BREVE_OK, breve_object_set_pose(s.world, ball, &pose));
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(s.world, ball, true));
  pose.location[1] = 0;
  double x = 0;
  for (int i = 0; i < 60; ++i) {
    x += 0.02;
    pose.location[0] = x;
    CHECK_STATUS(BREVE_OK, breve_object_set_target(s.world, plate, &pose));
    CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  }
  CHECK_STATUS(BREVE_OK, breve_object_pose(s.world, plate, &pose));
  CHECK_NEAR(x, pose.location[0], 1e-15);
  CHECK_STATUS(BREVE_OK, breve_object_pose(s.world, ball, &pose));
  CHECK(pose.location[0] > 0.9 * x && pose.location[0] <= x);
  CHECK_NEAR(1, pose.location[1], 1e-3);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_target(s.world, ball, &pose));
  memset(pose.rotation, 0, sizeof pose.rotation);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set_target(s.world, plate, &pose));
  scene_close(&s);
}

static void springs_pull(void) {
  scene s;
  if (!open_library(&s)) return;
  const breve_object a = make(&s, "Mobile"), b = make(&s, "Mobile");
  const double weightless[3] = {0, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_world_set_gravity(s.world, weightless));
  const breve_pose pose = {{0, 5, 0}, {1, 0, 0, 0}};
  CHECK_STATUS(BREVE_OK, breve_object_set_pose(s.world, b, &pose));
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(s.world, a, true));
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(s.world, b, true));
  breve_spring d = breve_spring_default();
  breve_object spring;
  double length = 0, force = 0, v[3];
  d.from = a;
  d.to = b;
  d.length = 1;
  d.damping = 0;
  CHECK_STATUS(BREVE_OK, breve_spring_create(s.world, &d, &spring));
  CHECK_STATUS(BREVE_OK, breve_spring_state(s.world, spring, &length, NULL));
  CHECK_NEAR(5, length, 1e-12);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_spring_state(s.world, spring, &length, &force));
  CHECK(length < 5 && force > 100);
  CHECK_STATUS(BREVE_OK, breve_object_velocity(s.world, b, v));
  CHECK(v[1] < 0);
  d.mode = BREVE_SPRING_EXPAND_ONLY;
  CHECK_STATUS(BREVE_OK, breve_spring_set_description(s.world, spring, &d));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_spring_state(s.world, spring, NULL, &force));
  CHECK_NEAR(0, force, 0);
  d.strength = -1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_spring_set_description(s.world, spring, &d));
  d.strength = 1;
  d.to = a;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_spring_create(s.world, &d, &spring));
  d.to = breve_world_controller(s.world);
  CHECK_STATUS(BREVE_ERROR_NO_BODY, breve_spring_create(s.world, &d, &spring));
  scene_close(&s);
}

static void accuracy_is_a_rung_or_single_settings(void) {
  scene s;
  if (!open_library(&s)) return;
  breve_accuracy accuracy = breve_accuracy_default();
  breve_rung rung = BREVE_RUNG_FAST;
  const char* text = NULL;
  CHECK_STATUS(BREVE_OK, breve_world_accuracy(s.world, &accuracy));
  CHECK(accuracy.rung == BREVE_RUNG_BALANCED);
  CHECK_STATUS(BREVE_OK, breve_rung_find("precise", &rung));
  CHECK(rung == BREVE_RUNG_PRECISE);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_rung_find("sloppy", &rung));
  CHECK_STATUS(BREVE_OK, breve_rung_accuracy(rung, &accuracy));
  CHECK(accuracy.rung == rung && accuracy.tolerance > 0);
  accuracy.integrator = BREVE_INTEGRATOR_VELOCITY_VERLET;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_rung_accuracy((breve_rung)17, &accuracy));
  accuracy.step = 1e-3;
  CHECK_STATUS(BREVE_OK, breve_world_set_accuracy(s.world, &accuracy));
  CHECK_STATUS(BREVE_OK, breve_world_accuracy(s.world, &accuracy));
  CHECK(accuracy.rung == BREVE_RUNG_PRECISE && accuracy.step == 1e-3 &&
        accuracy.integrator == BREVE_INTEGRATOR_VELOCITY_VERLET);
  CHECK_STATUS(BREVE_OK, breve_world_accuracy_text(s.world, &text));
  CHECK(strstr(text, "Verlet") != NULL);
  accuracy.tolerance = -1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_accuracy(s.world, &accuracy));
  const breve_object link = make(&s, "Link");
  CHECK_STATUS(BREVE_OK, breve_rung_accuracy(BREVE_RUNG_FAST, &accuracy));
  CHECK_STATUS(BREVE_OK, breve_object_set_accuracy(s.world, link, &accuracy));
  CHECK_STATUS(BREVE_OK, breve_object_set_accuracy(s.world, link, NULL));
  CHECK_STATUS(BREVE_OK, breve_world_set_guard(s.world, BREVE_GUARD_REPORT));
  CHECK(breve_world_guard(s.world) == BREVE_GUARD_REPORT);
  CHECK_STATUS(BREVE_OK, breve_world_set_workers(s.world, 2));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_set_workers(s.world, 0));
  CHECK_STATUS(BREVE_OK, breve_world_set_sleeping(s.world, true));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  scene_close(&s);
}

/* Its second axis is what the host says, not what the point gives. */
static void a_universal_joint_turns_about_the_axis_that_is_given(void) {
  scene s;
  if (!scene_open_text(&s, scene_text, NULL)) return;
  breve_joint_description d = breve_joint_description_default(BREVE_JOINT_UNIVERSAL);
  d.child = make(&s, "Link");
  d.normal[0] = 1;
  d.other_axis[0] = 3; /* along the normal: taken off */
  d.other_axis[2] = 2;
  breve_object joint;
  CHECK_STATUS(BREVE_OK, breve_joint_create(s.world, &d, &joint));
  const double position[3] = {0, 0.5, 0};
  CHECK_STATUS(BREVE_OK, breve_joint_set_state(s.world, joint, position, NULL));
  breve_pose pose;
  CHECK_STATUS(BREVE_OK, breve_object_pose(s.world, d.child, &pose));
  /* Positive: the child turns along -z. */
  CHECK(fabs(pose.rotation[0] - cos(0.25)) < 1e-12 && fabs(pose.rotation[3] + sin(0.25)) < 1e-12);
  d.other_axis[1] = NAN;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_joint_create(s.world, &d, &joint));
  scene_close(&s);
}

static void the_config_chooses_a_rung(void) {
  scene s;
  breve_world_config config = breve_world_config_default();
  CHECK(config.accuracy == NULL);
  config.accuracy = "precise";
  if (!scene_open_text(&s, scene_text, &config)) return;
  breve_accuracy accuracy = breve_accuracy_default();
  CHECK_STATUS(BREVE_OK, breve_world_accuracy(s.world, &accuracy));
  CHECK(accuracy.rung == BREVE_RUNG_PRECISE);
  breve_world* other = NULL;
  config.accuracy = "sloppy";
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_create(s.runtime, s.program, &config, &other));
  CHECK(strstr(breve_runtime_last_error(s.runtime)->message, "balanced") != NULL);
  scene_close(&s);
}

static void impacts_energy_and_counters_are_told(void) {
  scene s;
  if (!open_library(&s)) return;
  const breve_object floor = make(&s, "Floor"), ball = make(&s, "Mobile");
  const breve_pose pose = {{0, 1.5, 0}, {1, 0, 0, 0}};
  const breve_material bouncy = {0.5, 0.5, 0.5, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_object_set_pose(s.world, ball, &pose));
  CHECK_STATUS(BREVE_OK, breve_object_set_physics(s.world, ball, true));
  CHECK_STATUS(BREVE_OK, breve_object_set_material(s.world, ball, &bouncy));
  CHECK_STATUS(BREVE_OK, breve_object_set_material(s.world, floor, &bouncy));
  double mass = 0, impulse = 0;
  CHECK_STATUS(BREVE_OK, breve_object_mass(s.world, ball, &mass));
  size_t count = 0, of_any = 0;
  for (int i = 0; i < 10; ++i) {
    breve_impact impacts[8];
    CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
    CHECK_STATUS(BREVE_OK, breve_world_impacts(s.world, impacts, 8, &count));
    if (count == 0) continue;
    CHECK(same(impacts[0].a, ball) || same(impacts[0].b, ball));
    CHECK_NEAR(1, fabs(impacts[0].normal[1]), 1e-9);
    CHECK_NEAR(0, impacts[0].point[1], 1e-6);
    if (of_any == 0) impulse = fabs(impacts[0].impulse[1]);
    of_any += count;
  }
  CHECK(of_any != 0);
  /* It falls half a length: v^2 = 2 g / 2, and comes back at half that speed. */
  CHECK_NEAR(1.5 * mass * sqrt(9.8), impulse, 1e-2 * impulse);
  breve_energy energy = breve_energy_default();
  CHECK_STATUS(BREVE_OK, breve_world_energy(s.world, &energy));
  CHECK_NEAR(0.75 * mass * 9.8 * 0.5, energy.contact_loss, 0.02 * energy.contact_loss);
  CHECK_NEAR(0, energy.residual, 1e-3 * mass * 9.8);
  energy.struct_size = 3;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_energy(s.world, &energy));
  breve_physics_counters counters = breve_physics_counters_default();
  CHECK_STATUS(BREVE_OK, breve_world_physics_counters(s.world, &counters));
  CHECK(counters.islands != 0);
  CHECK_STATUS(BREVE_OK, breve_world_interventions(s.world, NULL, 0, &count));
  bool asleep = true, enabled = false;
  CHECK_STATUS(BREVE_OK, breve_object_asleep(s.world, ball, &asleep));
  CHECK_STATUS(BREVE_OK, breve_object_physics(s.world, ball, &enabled));
  CHECK(!asleep && enabled);
  scene_close(&s);
}

static void how_exactly_rows_were_solved_is_told(void) {
  static const char* const rungs[] = {"fast", "balanced", "precise"};
  for (size_t i = 0; i < 3; ++i) {
    scene s;
    breve_world_config config = breve_world_config_default();
    config.accuracy = rungs[i];
    if (!scene_open_text(&s, scene_text, &config)) return;
    make(&s, "Floor");
    const breve_object ball = make(&s, "Mobile");
    const breve_pose pose = {{0, 1, 0}, {1, 0, 0, 0}};
    CHECK_STATUS(BREVE_OK, breve_object_set_pose(s.world, ball, &pose));
    CHECK_STATUS(BREVE_OK, breve_object_set_physics(s.world, ball, true));
    for (int k = 0; k < 60; ++k) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
    breve_physics_counters counters = breve_physics_counters_default();
    CHECK_STATUS(BREVE_OK, breve_world_physics_counters(s.world, &counters));
    CHECK(counters.contacts != 0 && counters.direct != 0);
    CHECK(counters.residual >= 0 && counters.residual <= 1e-8);
    scene_close(&s);
  }
}

static void script_and_host_see_the_same_joints(void) {
  static const char* const text =
      "@use PhysicalControl.\n@use MultiBody.\nController Lab.\n"
      "PhysicalControl : Lab {\n"
      "  + variables:\n    arm, elbow (object).\n"
      "  + to init:\n    self zero-gravity.\n    arm = new Link.\n"
      "  + to drive joint j (object):\n    elbow = j.\n    elbow set-strength-limit to 5.\n    elbow "
      "set-joint-velocity to 1.\n"
      "  + to get-angle:\n    return (elbow get-joint-angle).\n"
      "}\n";
  scene s;
  if (!scene_open_text(&s, text, NULL)) return;
  const breve_object lab = breve_world_controller(s.world), arm = value_of(&s, "arm").as.object;
  const breve_object elbow = hinge(&s, nobody, arm);
  const breve_keyword keyword = {"joint", breve_value_object(elbow)};
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, lab, "drive", &keyword, 1, NULL));
  size_t size = 0;
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, NULL, 0, &size));
  char* image = malloc(size);
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, image, size, &size));
  uint64_t hash = 0, again = 0;
  for (int i = 0; i < 20; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &hash));
  breve_value angle;
  breve_joint_info info;
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, lab, "get-angle", NULL, 0, &angle));
  CHECK_STATUS(BREVE_OK, breve_joint_state(s.world, elbow, &info));
  CHECK_NEAR(1, angle.as.number, 0.05);
  CHECK(angle.as.number == info.position[0]);
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, image, size));
  for (int i = 0; i < 20; ++i) CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_OK, breve_world_hash(s.world, &again));
  CHECK(hash == again);
  free(image);
  scene_close(&s);
}

static void a_class_that_the_program_lacks_is_named(void) {
  scene s;
  if (!scene_open_text(&s, "@use Control.\n@use Mobile.\nController C.\nControl : C { }\n", NULL)) return;
  breve_object joint;
  breve_joint_description d = breve_joint_description_default(BREVE_JOINT_BALL);
  CHECK_STATUS(BREVE_OK, breve_object_create(s.world, "Mobile", &d.child));
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_joint_create(s.world, &d, &joint));
  CHECK(strstr(breve_world_last_error(s.world)->message, "BallJoint") != NULL);
  breve_program* program = NULL;
  CHECK_STATUS(BREVE_ERROR_COMPILE, breve_program_create_library(s.runtime, "Unicorn", &program));
  scene_close(&s);
}

void solid_suite(void) {
  RUN(a_creature_is_built_and_driven_without_a_script);
  RUN(every_kind_of_joint_has_its_axes);
  RUN(what_cannot_be_joined_is_refused_and_nothing_changes);
  RUN(shapes_of_every_kind_are_made_and_weighed);
  RUN(springs_pull);
  RUN(accuracy_is_a_rung_or_single_settings);
  RUN(a_universal_joint_turns_about_the_axis_that_is_given);
  RUN(the_config_chooses_a_rung);
  RUN(impacts_energy_and_counters_are_told);
  RUN(how_exactly_rows_were_solved_is_told);
  RUN(script_and_host_see_the_same_joints);
  RUN(what_has_a_target_carries);
  RUN(a_class_that_the_program_lacks_is_named);
}
