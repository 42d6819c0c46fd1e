/* Questions about where bodies are, against closed forms and against a look at every body. */
#include <math.h>

#include "bodies.h"

static bool ray(scene* s, const double start[3], const double way[3], const breve_query* query, breve_hit* hit) {
  bool found = false;
  CHECK_STATUS(BREVE_OK, breve_world_ray_first(s->world, start, way, query, &found, hit));
  return found;
}

static void is_hit(const breve_hit* hit, breve_object object, double distance, double x, double y, double z, double nx,
                   double ny, double nz) {
  CHECK(same_object(hit->object, object));
  CHECK_NEAR(distance, hit->distance, 1e-12);
  CHECK_NEAR(x, hit->point[0], 1e-12);
  CHECK_NEAR(y, hit->point[1], 1e-12);
  CHECK_NEAR(z, hit->point[2], 1e-12);
  CHECK_NEAR(nx, hit->normal[0], 1e-9);
  CHECK_NEAR(ny, hit->normal[1], 1e-9);
  CHECK_NEAR(nz, hit->normal[2], 1e-9);
}

static void rays_meet_shapes_where_geometry_says(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_geometry ball = ball_of_radius(2), box = box_of_size(2, 4, 6);
  breve_geometry round = breve_geometry_default();
  round.kind = BREVE_SHAPE_CYLINDER;
  round.radius = 1;
  round.height = 4;
  const breve_object a = add_body(&s, "Mobile", &ball, 10, 0, 0), b = add_body(&s, "Stationary", &box, 0, 20, 0);
  rotate_about_z(&s, b, acos(-1) / 4);
  const breve_object c = add_body(&s, "Mobile", &round, 0, 0, 30);
  round.kind = BREVE_SHAPE_CAPSULE;
  const breve_object d = add_body(&s, "Mobile", &round, 0, 0, -30);
  breve_hit hit;
  /* A ball, one unit off its centre: 10 - sqrt(4 - 1). */
  const double origin[3] = {0, 0, 0}, beside[3] = {0, 1, 0}, along_x[3] = {40, 0, 0};
  if (CHECK(ray(&s, beside, along_x, NULL, &hit)))
    is_hit(&hit, a, 10 - sqrt(3), 10 - sqrt(3), 1, 0, -sqrt(3) / 2, 0.5, 0);
  /* A box turned by 45 degrees: the face with x = -1 is the line x + y = 20 - sqrt(2). */
  const double up[3] = {0, 50, 0}, left[3] = {-1, 0, 0};
  if (CHECK(ray(&s, left, up, NULL, &hit)))
    is_hit(&hit, b, 21 - sqrt(2), -1, 21 - sqrt(2), 0, -sqrt(0.5), -sqrt(0.5), 0);
  /* The side of a cylinder, and its cap. */
  const double forth[3] = {0, 0, 60};
  if (CHECK(ray(&s, beside, forth, NULL, &hit))) is_hit(&hit, c, 29, 0, 1, 29, 0, 0, -1);
  const double above[3] = {0.5, 10, 30}, down[3] = {0, -10, 0};
  if (CHECK(ray(&s, above, down, NULL, &hit))) is_hit(&hit, c, 8, 0.5, 2, 30, 0, 1, 0);
  /* The round end of a capsule: half a unit off its axis. */
  const double over[3] = {0.5, 10, -30};
  if (CHECK(ray(&s, over, down, NULL, &hit)))
    is_hit(&hit, d, 8 - sqrt(0.75), 0.5, 2 + sqrt(0.75), -30, 0.5, sqrt(0.75), 0);
  /* Too short, beside, the other way, and of no length. */
  const double short_way[3] = {7.9, 0, 0}, back[3] = {-40, 0, 0}, none[3] = {0, 0, 0};
  CHECK(!ray(&s, origin, short_way, NULL, &hit));
  CHECK(!ray(&s, origin, back, NULL, &hit));
  CHECK(!ray(&s, origin, none, NULL, &hit));
  const double just[3] = {8, 0, 0};
  CHECK(ray(&s, origin, just, NULL, NULL));
  /* From inside. */
  const double inside[3] = {10, 0, 0};
  if (CHECK(ray(&s, inside, up, NULL, &hit))) is_hit(&hit, a, 0, 10, 0, 0, 0, -1, 0);
  if (CHECK(ray(&s, inside, none, NULL, &hit))) CHECK(hit.distance == 0);
  scene_close(&s);
}

static void hits_come_by_distance_and_then_by_creation(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_geometry ball = ball_of_radius(1);
  breve_object far = add_body(&s, "Mobile", &ball, 20, 0, 0), twin[3];
  for (int i = 0; i < 3; ++i) twin[i] = add_body(&s, "Mobile", &ball, 10, 0, 0);
  const breve_object near = add_body(&s, "Mobile", &ball, 5, 0, 0);
  const double origin[3] = {0, 0, 0}, way[3] = {30, 0, 0};
  breve_hit hits[8];
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_world_ray_all(s.world, origin, way, NULL, hits, 8, &count));
  if (CHECK(count == 5)) {
    CHECK(same_object(hits[0].object, near) && same_object(hits[4].object, far));
    for (int i = 0; i < 3; ++i) CHECK(same_object(hits[1 + i].object, twin[i]));
    CHECK(hits[0].distance == 4 && hits[1].distance == 9 && hits[4].distance == 19);
  }
  /* At most as many as there is room for. */
  memset(hits, 0, sizeof hits);
  CHECK_STATUS(BREVE_OK, breve_world_ray_all(s.world, origin, way, NULL, hits, 2, &count));
  CHECK(count == 5 && hits[1].distance == 9 && hits[2].distance == 0);
  /* Of twins the first, whoever stands first in the tree. */
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, near));
  CHECK(ray(&s, origin, way, NULL, hits) && same_object(hits->object, twin[0]));
  CHECK_STATUS(BREVE_OK, breve_object_free(s.world, twin[0]));
  CHECK(ray(&s, origin, way, NULL, hits) && same_object(hits->object, twin[1]));
  scene_close(&s);
}

static void overlaps_are_as_deep_as_geometry_says(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_geometry ball = ball_of_radius(1), box = box_of_size(2, 2, 2);
  const breve_object a = add_body(&s, "Mobile", &ball, 0, 0, 0), b = add_body(&s, "Mobile", &box, 4, 0, 0);
  breve_geometry asked = ball_of_radius(1.5);
  breve_pose pose = {{2, 0, 0}, {2, 0, 0, 0}};
  breve_hit hits[4];
  size_t count = 0;
  CHECK_STATUS(BREVE_OK, breve_world_overlap(s.world, &asked, &pose, NULL, hits, 4, &count));
  if (CHECK(count == 2)) {
    CHECK(same_object(hits[0].object, a) && same_object(hits[1].object, b));
    is_hit(&hits[0], a, -0.5, 1, 0, 0, 1, 0, 0);
    is_hit(&hits[1], b, -0.5, 3, 0, 0, -1, 0, 0);
  }
  /* To touch is enough; a hair less is not. */
  asked.radius = 1;
  CHECK_STATUS(BREVE_OK, breve_world_overlap(s.world, &asked, &pose, NULL, hits, 4, &count));
  CHECK(count == 2);
  asked.radius = 1 - 1e-9;
  CHECK_STATUS(BREVE_OK, breve_world_overlap(s.world, &asked, &pose, NULL, hits, 4, &count));
  CHECK(count == 0);
  /* A box along its diagonal. */
  asked = box_of_size(1, 1, 1);
  pose.location[0] = -1 - sqrt(0.5) + 0.1;
  pose.rotation[0] = cos(acos(-1) / 8);
  pose.rotation[3] = sin(acos(-1) / 8);
  CHECK_STATUS(BREVE_OK, breve_world_overlap(s.world, &asked, &pose, NULL, hits, 4, &count));
  if (CHECK(count == 1)) CHECK_NEAR(-0.1, hits[0].distance, 0.05);
  pose.location[0] -= 0.11;
  CHECK_STATUS(BREVE_OK, breve_world_overlap(s.world, &asked, &pose, NULL, hits, 4, &count));
  CHECK(count == 0);
  scene_close(&s);
}

static void what_is_swept_stops_where_it_touches(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_geometry ball = ball_of_radius(1), wall = box_of_size(1, 20, 20);
  const breve_object a = add_body(&s, "Mobile", &ball, 10, 0, 0);
  const breve_object b = add_body(&s, "Stationary", &wall, 20, 0, 0);
  breve_geometry asked = ball_of_radius(0.5);
  breve_pose pose = {{0, 0, 0}, {1, 0, 0, 0}};
  const double way[3] = {100, 0, 0};
  breve_hit hit;
  bool found = false;
  CHECK_STATUS(BREVE_OK, breve_world_cast(s.world, &asked, &pose, way, NULL, &found, &hit));
  CHECK(found && same_object(hit.object, a));
  CHECK_NEAR(8.5, hit.distance, 1e-8);
  CHECK_NEAR(-1, hit.normal[0], 1e-9);
  /* Off centre: 10 - sqrt(1.5^2 - 1.2^2). */
  pose.location[1] = 1.2;
  CHECK_STATUS(BREVE_OK, breve_world_cast(s.world, &asked, &pose, way, NULL, &found, &hit));
  CHECK_NEAR(10 - 0.9, hit.distance, 1e-8);
  /* Past the ball, to the wall. */
  pose.location[1] = 1.6;
  CHECK_STATUS(BREVE_OK, breve_world_cast(s.world, &asked, &pose, way, NULL, &found, &hit));
  CHECK(found && same_object(hit.object, b));
  CHECK_NEAR(19, hit.distance, 1e-8);
  CHECK_NEAR(19.5, hit.point[0], 1e-8);
  /* A box that is turned comes as far as its corner. */
  asked = box_of_size(2, 2, 2);
  pose.rotation[0] = cos(acos(-1) / 8);
  pose.rotation[3] = sin(acos(-1) / 8);
  pose.location[1] = 5;
  CHECK_STATUS(BREVE_OK, breve_world_cast(s.world, &asked, &pose, way, NULL, &found, &hit));
  CHECK_NEAR(19.5 - sqrt(2), hit.distance, 1e-7);
  /* What it meets to begin with, and nothing. */
  pose.location[0] = 19;
  CHECK_STATUS(BREVE_OK, breve_world_cast(s.world, &asked, &pose, way, NULL, &found, &hit));
  CHECK(found && hit.distance == 0 && same_object(hit.object, b));
  pose.location[0] = 40;
  CHECK_STATUS(BREVE_OK, breve_world_cast(s.world, &asked, &pose, way, NULL, &found, &hit));
  CHECK(!found);
  scene_close(&s);
}

static void the_nearest_surface_is_found_inside_and_outside(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_geometry ball = ball_of_radius(2), box = box_of_size(2, 2, 2), tiny = ball_of_radius(1e-6);
  const breve_object a = add_body(&s, "Mobile", &ball, 0, 0, 0), b = add_body(&s, "Mobile", &box, 10, 0, 0);
  const breve_object c = add_body(&s, "Mobile", &tiny, 0, 50, 0);
  double point[3] = {5, 0, 0};
  breve_hit hit;
  bool found = false;
  CHECK_STATUS(BREVE_OK, breve_world_closest(s.world, point, INFINITY, NULL, &found, &hit));
  if (CHECK(found)) is_hit(&hit, a, 3, 2, 0, 0, 1, 0, 0);
  point[0] = 7;
  CHECK_STATUS(BREVE_OK, breve_world_closest(s.world, point, 2, NULL, &found, &hit));
  if (CHECK(found)) is_hit(&hit, b, 2, 9, 0, 0, -1, 0, 0);
  CHECK_STATUS(BREVE_OK, breve_world_closest(s.world, point, 2 - 1e-9, NULL, &found, &hit));
  CHECK(!found);
  /* The corner of a box. */
  point[0] = 12, point[1] = 2, point[2] = 2;
  CHECK_STATUS(BREVE_OK, breve_world_closest(s.world, point, 100, NULL, &found, &hit));
  if (CHECK(found)) is_hit(&hit, b, sqrt(3), 11, 1, 1, sqrt(1 / 3.0), sqrt(1 / 3.0), sqrt(1 / 3.0));
  /* Inside: the face that is next. */
  point[0] = 10.75, point[1] = point[2] = 0;
  CHECK_STATUS(BREVE_OK, breve_world_closest(s.world, point, 100, NULL, &found, &hit));
  if (CHECK(found)) is_hit(&hit, b, -0.25, 11, 0, 0, 1, 0, 0);
  /* A small body keeps all digits of a small distance. */
  point[0] = 1.25e-6, point[1] = 50;
  CHECK_STATUS(BREVE_OK, breve_world_closest(s.world, point, 100, NULL, &found, &hit));
  CHECK(found && same_object(hit.object, c) && fabs(hit.distance - 0.25e-6) < 1e-20);
  /* If two bodies are around a point, the one that it is deeper in is found. */
  put_at(&s, b, 0, 0, 0);
  point[0] = 0.5, point[1] = point[2] = 0;
  CHECK_STATUS(BREVE_OK, breve_world_closest(s.world, point, 0, NULL, &found, &hit));
  if (CHECK(found)) is_hit(&hit, a, -1.5, 2, 0, 0, 1, 0, 0);
  scene_close(&s);
}

static void questions_are_about_classes_bits_and_others(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_geometry ball = ball_of_radius(1);
  const breve_object mobile = add_body(&s, "Mobile", &ball, 5, 0, 0);
  const breve_object block = add_body(&s, "Stationary", &ball, 10, 0, 0);
  const breve_object link = add_body(&s, "Link", &ball, 15, 0, 0);
  const double origin[3] = {0, 0, 0}, way[3] = {30, 0, 0};
  breve_query query = breve_query_default();
  breve_hit hits[4];
  size_t count = 0;
  query.class_name = "Stationary";
  CHECK(ray(&s, origin, way, &query, hits) && same_object(hits->object, block));
  query.class_name = "Mobiles"; /* an alias; a Link is one */
  CHECK_STATUS(BREVE_OK, breve_world_ray_all(s.world, origin, way, &query, hits, 4, &count));
  CHECK(count == 2 && same_object(hits[1].object, link));
  query.except = mobile;
  CHECK(ray(&s, origin, way, &query, hits) && same_object(hits->object, link));
  query = breve_query_default();
  breve_collision_filter filter = breve_collision_filter_default();
  filter.category = 6;
  CHECK_STATUS(BREVE_OK, breve_object_set_collision_filter(s.world, block, &filter));
  query.mask = 4;
  CHECK(ray(&s, origin, way, &query, hits) && same_object(hits->object, block));
  query.mask = 8;
  CHECK(!ray(&s, origin, way, &query, hits));
  query = breve_query_default();
  filter.sensor = true;
  filter.category = 1;
  CHECK_STATUS(BREVE_OK, breve_object_set_collision_filter(s.world, mobile, &filter));
  CHECK(ray(&s, origin, way, &query, hits) && same_object(hits->object, mobile));
  query.solid_only = true;
  CHECK(ray(&s, origin, way, &query, hits) && same_object(hits->object, block));
  const double middle[3] = {10, 0, 0};
  CHECK_STATUS(BREVE_OK, breve_world_near(s.world, middle, 5, NULL, hits, 4, &count));
  CHECK(count == 1 && hits->distance == 0); /* strictly nearer */
  CHECK_STATUS(BREVE_OK, breve_world_near(s.world, middle, 5.001, NULL, hits, 4, &count));
  CHECK(count == 3 && same_object(hits[1].object, mobile) && same_object(hits[2].object, link));
  CHECK(hits[1].distance == 5 && hits[1].normal[0] == 1);
  scene_close(&s);
}

/* --- many bodies, asked one by one -------------------------------------------------------------------------------- */

enum { kMany = 400 };

typedef struct crowd {
  scene s;
  breve_object balls[kMany];
  double centers[kMany][3], radius[kMany];
  bool gone[kMany];
} crowd;

static double along_ray(const crowd* c, int i, const double start[3], const double way[3]) {
  double a = 0, b = 0, k = -c->radius[i] * c->radius[i];
  for (int j = 0; j < 3; ++j) {
    const double to = start[j] - c->centers[i][j];
    a += way[j] * way[j], b += to * way[j], k += to * to;
  }
  if (k <= 0) return 0;
  const double root = b * b - a * k;
  if (root < 0) return INFINITY;
  const double t = (-b - sqrt(root)) / a;
  return t >= 0 && t <= 1 ? t * sqrt(a) : INFINITY;
}

static double to_center(const crowd* c, int i, const double point[3]) {
  double square = 0;
  for (int j = 0; j < 3; ++j) square += (point[j] - c->centers[i][j]) * (point[j] - c->centers[i][j]);
  return sqrt(square);
}

static void answers_are_those_of_a_look_at_each(crowd* c, bool flat) {
  for (int n = 0; n < 60; ++n) {
    double start[3], way[3];
    for (int j = 0; j < 3; ++j) start[j] = draw(-25, 25), way[j] = draw(-40, 40);
    if (flat) start[2] = way[2] = 0;
    double first = INFINITY, nearest = INFINITY;
    size_t met = 0, near = 0, touched = 0, count = 0;
    for (int i = 0; i < kMany; ++i) {
      if (c->gone[i]) continue;
      const double t = along_ray(c, i, start, way), center = to_center(c, i, start);
      if (t < first) first = t;
      if (t < INFINITY) ++met;
      if (center - c->radius[i] < nearest) nearest = center - c->radius[i];
      if (center < 6) ++near;
      if (center <= 3 + c->radius[i]) ++touched;
    }
    breve_hit hit, hits[kMany];
    bool found = false;
    breve_world* const w = c->s.world;
    CHECK_STATUS(BREVE_OK, breve_world_ray_first(w, start, way, NULL, &found, &hit));
    CHECK(found == (first < INFINITY));
    if (found) CHECK_NEAR(first, hit.distance, 1e-9);
    CHECK_STATUS(BREVE_OK, breve_world_ray_all(w, start, way, NULL, hits, kMany, &count));
    CHECK(count == met);
    for (size_t i = 1; i < count; ++i) CHECK(hits[i - 1].distance <= hits[i].distance);
    CHECK_STATUS(BREVE_OK, breve_world_closest(w, start, INFINITY, NULL, &found, &hit));
    CHECK(found);
    CHECK_NEAR(nearest, hit.distance, 1e-12);
    CHECK_STATUS(BREVE_OK, breve_world_near(w, start, 6, NULL, hits, kMany, &count));
    CHECK(count == near);
    const breve_geometry asked = ball_of_radius(3);
    const breve_pose pose = {{start[0], start[1], start[2]}, {1, 0, 0, 0}};
    CHECK_STATUS(BREVE_OK, breve_world_overlap(w, &asked, &pose, NULL, hits, kMany, &count));
    CHECK(count == touched);
  }
}

static void learn_places(crowd* c) {
  for (int i = 0; i < kMany; ++i) {
    if (c->gone[i]) continue;
    const breve_pose pose = pose_of(&c->s, c->balls[i]);
    memcpy(c->centers[i], pose.location, sizeof pose.location);
  }
}

static void a_crowd_is_asked(bool flat) {
  static crowd c;
  memset(&c, 0, sizeof c);
  memset(c.gone, true, sizeof c.gone);
  if (!open_bodies(&c.s, flat)) return;
  for (int i = 0; i < kMany; ++i) {
    c.radius[i] = draw(0.1, 1);
    const breve_geometry ball = ball_of_radius(c.radius[i]);
    c.balls[i] = add_body(&c.s, "Mobile", &ball, draw(-20, 20), draw(-20, 20), flat ? 0 : draw(-20, 20));
    if (i % 3 == 0) set_moving(&c.s, c.balls[i], draw(-5, 5), draw(-5, 5), 0);
    c.gone[i] = false;
    learn_places(&c);
    if (i % 80 == 0) answers_are_those_of_a_look_at_each(&c, flat);
  }
  answers_are_those_of_a_look_at_each(&c, flat);
  /* After steps, after some were put elsewhere, after some were freed, and after others came in their place. */
  step_times(&c.s, 5);
  learn_places(&c);
  answers_are_those_of_a_look_at_each(&c, flat);
  for (int i = 0; i < kMany; i += 7) put_at(&c.s, c.balls[i], draw(-20, 20), draw(-20, 20), 0);
  learn_places(&c);
  answers_are_those_of_a_look_at_each(&c, flat);
  for (int i = 0; i < kMany; i += 3) {
    CHECK_STATUS(BREVE_OK, breve_object_free(c.s.world, c.balls[i]));
    c.gone[i] = true;
  }
  answers_are_those_of_a_look_at_each(&c, flat);
  for (int i = 0; i < kMany; i += 6) {
    c.radius[i] = draw(1, 2);
    const breve_geometry ball = ball_of_radius(c.radius[i]);
    c.balls[i] = add_body(&c.s, "Mobile", &ball, draw(-20, 20), draw(-20, 20), 0);
    c.gone[i] = false;
  }
  learn_places(&c);
  answers_are_those_of_a_look_at_each(&c, flat);
  step_times(&c.s, 1);
  learn_places(&c);
  answers_are_those_of_a_look_at_each(&c, flat);
  scene_close(&c.s);
}

static void a_crowd_in_space_answers_as_a_look_at_each(void) { a_crowd_is_asked(false); }
static void a_crowd_in_a_plane_answers_as_a_look_at_each(void) { a_crowd_is_asked(true); }

/* --- what is around ----------------------------------------------------------------------------------------------- */

static void questions_reach_across_edges_that_wrap(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  CHECK_STATUS(BREVE_OK, breve_world_set_space(s.world, 0, BREVE_EDGE_WRAP, -10, 10));
  const breve_geometry ball = ball_of_radius(1), asked = ball_of_radius(2);
  const breve_object a = add_body(&s, "Mobile", &ball, 9.5, 0, 0);
  const double point[3] = {-9, 0, 0};
  const breve_pose pose = {{-9, 0, 0}, {1, 0, 0, 0}};
  breve_hit hit;
  size_t count = 0;
  bool found = false;
  CHECK_STATUS(BREVE_OK, breve_world_near(s.world, point, 2, NULL, &hit, 1, &count));
  CHECK(count == 1 && hit.distance == 1.5 && hit.point[0] == 9.5);
  CHECK_STATUS(BREVE_OK, breve_world_closest(s.world, point, 1, NULL, &found, &hit));
  CHECK(found && same_object(hit.object, a));
  CHECK_NEAR(0.5, hit.distance, 1e-12);
  CHECK_NEAR(10.5, hit.point[0], 1e-12);
  CHECK_STATUS(BREVE_OK, breve_world_overlap(s.world, &asked, &pose, NULL, &hit, 1, &count));
  CHECK(count == 1);
  CHECK_NEAR(-1.5, hit.distance, 1e-12);
  scene_close(&s);
}

static void who_only_asks_changes_nothing(void) {
  scene s;
  if (!open_bodies(&s, false)) return;
  const breve_geometry ball = ball_of_radius(1);
  add_body(&s, "Mobile", &ball, 5, 0, 0);
  static char before[1 << 20], after[1 << 20];
  size_t size = 0, again = 0;
  step_times(&s, 1);
  CHECK(!effect_of(&s, "queries")->active && effect_of(&s, "queries")->bytes == 0);
  const uint64_t hash = hash_of_world(&s);
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, before, sizeof before, &size));
  const double origin[3] = {0, 0, 0}, way[3] = {30, 0, 0};
  breve_hit hit;
  CHECK(ray(&s, origin, way, NULL, &hit));
  CHECK(ray(&s, origin, way, NULL, &hit));
  CHECK(hash_of_world(&s) == hash);
  CHECK_STATUS(BREVE_OK, breve_world_snapshot(s.world, after, sizeof after, &again));
  CHECK(size == again && memcmp(before, after, size) == 0);
  const breve_effect* effect = effect_of(&s, "queries");
  CHECK(effect->active && effect->calls == 2);
  /* Queries in a restored world find its bodies. */
  const breve_object mobile = hit.object;
  put_at(&s, mobile, 0, 0, 20);
  CHECK(!ray(&s, origin, way, NULL, &hit));
  CHECK_STATUS(BREVE_OK, breve_world_restore(s.world, before, size));
  CHECK(ray(&s, origin, way, NULL, &hit) && same_object(hit.object, mobile) && hit.distance == 4);
  scene_close(&s);
}

static void bad_questions_are_refused(void) {
  scene s;
  if (!open_bodies(&s, true)) return;
  const breve_geometry ball = ball_of_radius(1);
  const breve_object a = add_body(&s, "Mobile", &ball, 5, 0, 0);
  breve_world* const w = s.world;
  const double fine[3] = {0, 0, 0}, way[3] = {1, 0, 0}, out[3] = {0, 0, 1}, wrong[3] = {NAN, 0, 0};
  breve_pose pose = {{0, 0, 0}, {1, 0, 0, 0}};
  breve_hit hit;
  size_t count = 77;
  bool found = true;
  hit.distance = 5;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_ray_first(w, wrong, way, NULL, &found, &hit));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_ray_first(w, fine, wrong, NULL, &found, &hit));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_ray_first(w, out, way, NULL, &found, &hit));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_ray_first(w, fine, out, NULL, &found, &hit));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_ray_first(w, NULL, way, NULL, &found, &hit));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_ray_first(w, fine, way, NULL, NULL, &hit));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_ray_all(w, fine, way, NULL, NULL, 1, &count));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_ray_all(w, fine, way, NULL, &hit, 1, NULL));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_closest(w, fine, -1, NULL, &found, &hit));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_closest(w, fine, NAN, NULL, &found, &hit));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_near(w, fine, NAN, NULL, &hit, 1, &count));
  breve_geometry bad = ball_of_radius(-1);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_overlap(w, &bad, &pose, NULL, &hit, 1, &count));
  bad = ball_of_radius(1);
  bad.kind = 99;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_cast(w, &bad, &pose, way, NULL, &found, &hit));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_cast(w, NULL, &pose, way, NULL, &found, &hit));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_cast(w, &ball, NULL, way, NULL, &found, &hit));
  pose.location[2] = 1;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_overlap(w, &ball, &pose, NULL, &hit, 1, &count));
  pose.location[2] = 0;
  breve_query query = breve_query_default();
  query.class_name = "Nobody";
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_world_ray_first(w, fine, way, &query, &found, &hit));
  query = breve_query_default();
  query.struct_size = 7;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_ray_first(w, fine, way, &query, &found, &hit));
  query = breve_query_default();
  query.reserved[1] = true;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_ray_first(w, fine, way, &query, &found, &hit));
  query = breve_query_default();
  query.except = a;
  CHECK_STATUS(BREVE_OK, breve_object_free(w, a));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_world_ray_first(w, fine, way, &query, &found, &hit));
  CHECK(found && hit.distance == 5 && count == 77);
  /* An empty world has nothing to find. */
  CHECK_STATUS(BREVE_OK, breve_world_ray_first(w, fine, way, NULL, &found, &hit));
  CHECK(!found);
  CHECK_STATUS(BREVE_OK, breve_world_closest(w, fine, INFINITY, NULL, &found, &hit));
  CHECK(!found);
  scene_close(&s);
}

void queries_suite(void) {
  RUN(rays_meet_shapes_where_geometry_says);
  RUN(hits_come_by_distance_and_then_by_creation);
  RUN(overlaps_are_as_deep_as_geometry_says);
  RUN(what_is_swept_stops_where_it_touches);
  RUN(the_nearest_surface_is_found_inside_and_outside);
  RUN(questions_are_about_classes_bits_and_others);
  RUN(a_crowd_in_space_answers_as_a_look_at_each);
  RUN(a_crowd_in_a_plane_answers_as_a_look_at_each);
  RUN(questions_reach_across_edges_that_wrap);
  RUN(who_only_asks_changes_nothing);
  RUN(bad_questions_are_refused);
}
