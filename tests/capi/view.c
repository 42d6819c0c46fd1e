/* Pictures, whose shapes, depths and colours have closed forms; plots and movies. */
#include <math.h>
#include <stdlib.h>

#include "show.h"

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

static double encoded(double c) { return 255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055); }

/* The light of a pixel: the edges of shadows are mixed as light, not as encoded colours. */
static double light_of(const uint8_t* p) {
  const double c = p[0] / 255.0;
  return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
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
    CHECK_NEAR(acos(-1) * along * across, area, PERCENT * area);
    CHECK_NEAR(320 + (low + high) / 2, middle / area, PERCENT * 2 * along);
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
      for (int x = 260; x < 380; x += 20) CHECK_NEAR(24.5, p.depth[y * kWidth + x], PERCENT * 24.5 / 10);
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
    CHECK_NEAR(area, dark / unit / unit, PERCENT * area);
    CHECK_NEAR(middle, sum / dark / unit, PERCENT * (high - low));
    CHECK_NEAR(high - low, longest / unit, PERCENT * (high - low));
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
    CHECK_NEAR(19.5, p.depth[240 * kWidth + 320], PERCENT * 19.5);
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
  RUN(a_camera_that_is_half_wrong_leaves_the_last_one);
  RUN(the_silhouette_of_a_sphere_has_its_area_and_middle);
  RUN(a_plane_has_its_depth);
  RUN(a_lit_face_has_its_colour);
  RUN(a_shadow_lies_where_the_light_throws_it);
  RUN(a_window_leaves_the_rest_of_the_picture);
  RUN(draw_calls_do_not_grow_with_bodies);
  RUN(a_picture_changes_nothing);
  RUN(what_cannot_be_drawn_is_refused);
  RUN(a_plot_is_a_table_and_pictures);
  RUN(a_movie_of_a_world_is_a_file);
}
