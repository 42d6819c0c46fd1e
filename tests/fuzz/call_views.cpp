// Calls of scenes and views. Making a view takes long, so that most calls have none, which is refused.
#include <algorithm>

#include "breve/view.h"
#include "call_functions.hpp"

namespace breve::fuzz {

namespace call_views {

constexpr std::uint32_t kSide = 8;

struct SceneHolder {
  breve_scene* scene = nullptr;
  explicit SceneHolder(Caller& c, breve_world* world = nullptr) {
    if (c.chance(5)) {
      c.expect_refusal();
      return;
    }
    require(breve_scene_create(&scene) == BREVE_OK, "no scene");
    if (world) (void)breve_scene_read(scene, world);
  }
  ~SceneHolder() { breve_scene_destroy(scene); }
  SceneHolder(const SceneHolder&) = delete;
  SceneHolder& operator=(const SceneHolder&) = delete;
};

struct ViewHolder {
  breve_view* view = nullptr;
  std::uint8_t rgba[4 * kSide * kSide] = {};
  ViewHolder(Caller& c, breve_world* world = nullptr) {
    breve_runtime* runtime = c.runtimes()[0];
    breve_view_config config = breve_view_config_default();
    config.width = config.height = kSide;
    config.samples = 1;
    if (!runtime || !c.chance(8) || breve_view_create(runtime, &config, &view) != BREVE_OK) {
      c.expect_refusal();
      return;
    }
    if (world) (void)breve_view_render(view, world, rgba, 0);
  }
  ~ViewHolder() { breve_view_destroy(view); }
  ViewHolder(const ViewHolder&) = delete;
  ViewHolder& operator=(const ViewHolder&) = delete;
};

/// Of which nothing is demanded, as any of its numbers may be.
breve_camera draw_camera(Caller& c) {
  breve_camera camera{};
  for (double* number : {&camera.target[0], &camera.target[2], &camera.offset[1], &camera.offset[2], &camera.pitch,
                         &camera.yaw, &camera.field_of_view, &camera.far_plane})
    *number = c.chance(90) ? c.finite() : c.number();
  camera.orthographic = c.word() % 2;
  return camera;
}

// --- scenes ----------------------------------------------------------------------------------------------------------

breve_status scene_create(Caller& c) {
  Out<breve_scene*> made(c);
  const breve_status status = made.after(breve_scene_create(made.to()));
  if (made) breve_scene_destroy(*made);
  return status;
}
breve_status scene_destroy(Caller&) { return breve_scene_destroy(nullptr), BREVE_OK; }

breve_status scene_read(Caller& c) {
  breve_world* world = c.world();
  const SceneHolder holder(c);
  return breve_scene_read(holder.scene, world);
}

/// Reads all bytes of all rows, and what texts and meshes point at.
void read_rows(const breve_rows& rows, std::uint32_t kind) {
  unsigned sum = 0;
  const auto* bytes = static_cast<const unsigned char*>(rows.data);
  for (std::size_t i = 0; i < rows.count * rows.stride; ++i) sum += bytes[i];
  for (std::size_t i = 0; i < rows.count; ++i) {
    const unsigned char* row = bytes + i * rows.stride;
    if (kind == BREVE_SCENE_LABELS) read_text(reinterpret_cast<const breve_label*>(row)->text);
    if (kind == BREVE_SCENE_TEXTS) read_text(reinterpret_cast<const breve_overlay_text*>(row)->text);
    if (kind != BREVE_SCENE_MESHES) continue;
    const auto* mesh = reinterpret_cast<const breve_mesh*>(row);
    for (std::size_t k = 0; k < mesh->index_count; ++k)
      require(mesh->indices[k] < mesh->vertex_count, "a triangle has no corner");
  }
  require(sum != 1, "a sum that no rows have");
}

breve_status scene_rows(Caller& c) {
  const SceneHolder holder(c, c.worlds().empty() ? nullptr : c.worlds().front());
  const std::uint32_t kind = c.word() % 14;
  if (kind > BREVE_SCENE_PLOT_LINES) c.expect_refusal();
  Out<breve_rows> rows(c);
  const breve_status status = rows.after(breve_scene_rows(holder.scene, kind, rows.to()));
  if (rows) read_rows(*rows, kind);
  return status;
}

breve_status scene_backdrop(Caller& c) {
  const SceneHolder holder(c);
  Out<breve_backdrop> backdrop(c);
  backdrop.set_size(c.struct_size(sizeof(breve_backdrop)));
  return backdrop.after(breve_scene_backdrop(holder.scene, backdrop.to()));
}

breve_status scene_camera(Caller& c) {
  const SceneHolder holder(c, c.worlds().empty() ? nullptr : c.worlds().front());
  Out<breve_camera> camera(c);
  return camera.after(breve_scene_camera(holder.scene, c.word() % 100, c.word() % 100, camera.to()));
}

breve_status camera_project(Caller& c) {
  const breve_camera camera = draw_camera(c);
  double point[3], seen[3];
  const double* at = c.numbers(point);
  return breve_camera_project(&camera, c.word() % 100, c.word() % 100, at, seen);
}

// --- views -----------------------------------------------------------------------------------------------------------

breve_status view_create(Caller& c) {
  breve_runtime* runtime = c.runtime();
  breve_view_config config = breve_view_config_default();
  config.width = c.chance(95) ? kSide : c.word();
  config.height = kSide;
  if (c.chance(90)) config.samples = 3, c.expect_refusal();  // so that few are made
  breve_view* view = nullptr;
  const breve_status status = breve_view_create(runtime, &config, &view);
  breve_view_destroy(view);
  return status;
}
breve_status view_destroy(Caller&) { return breve_view_destroy(nullptr), BREVE_OK; }

breve_status view_render(Caller& c) {
  breve_world* world = c.world();
  ViewHolder holder(c);
  return breve_view_render(holder.view, world, holder.rgba, 0);
}

breve_status view_depth(Caller& c) {
  const ViewHolder holder(c, c.worlds().empty() ? nullptr : c.worlds().front());
  float depth[kSide * kSide];
  return breve_view_depth(holder.view, depth, 0);
}

breve_status view_set_camera(Caller& c) {
  const ViewHolder holder(c);
  const breve_camera camera = draw_camera(c);
  return breve_view_set_camera(holder.view, c.chance(20) ? nullptr : &camera);
}

breve_status view_camera(Caller& c) {
  const ViewHolder holder(c, c.worlds().empty() ? nullptr : c.worlds().front());
  Out<breve_camera> camera(c);
  return camera.after(breve_view_camera(holder.view, camera.to()));
}

breve_status view_counts(Caller& c) {
  const ViewHolder holder(c);
  Out<breve_view_counters> counters(c);
  counters.set_size(c.struct_size(sizeof(breve_view_counters)));
  return counters.after(breve_view_counts(holder.view, counters.to()));
}

breve_status png(Caller& c) {
  const std::uint8_t rgba[4 * kSide * kSide] = {};
  const std::uint32_t width = c.word() % (kSide + 1);
  if (width == 0) c.expect_refusal();
  std::size_t size = 0;
  return breve_png(width, kSide, rgba, c.chance(50) ? 0 : 4 * kSide, nullptr, 0, &size);
}

// --- arrows, plots and movies ----------------------------------------------------------------------------------------

breve_status view_set_arrows(Caller& c) {
  const ViewHolder holder(c);
  const double scale = c.chance(80) ? 1.5 : c.number();
  return breve_view_set_arrows(holder.view, c.word() % 10, scale);
}

breve_status view_arrows(Caller& c) {
  const ViewHolder holder(c);
  Out<std::uint32_t> arrows(c);
  double scale = 0;
  return arrows.after(breve_view_arrows(holder.view, arrows.to(), &scale));
}

breve_status plot_file(Caller& c) {
  double xs[kSide], values[kSide];
  for (double& x : xs) x = c.number();
  for (double& value : values) value = c.number();
  breve_plot_line line{};
  line.name = c.chance(50) ? nullptr : "<a&b, \"c\"";
  line.values = values;
  line.count = c.word() % (kSide + 1);
  for (float& part : line.color) part = static_cast<float>(c.number());
  breve_plot_config config = breve_plot_config_default();
  config.struct_size = c.struct_size(sizeof config);
  config.title = c.chance(50) ? nullptr : "title";
  config.xs = c.chance(50) ? nullptr : xs;
  config.x_count = config.xs ? c.word() % (kSide + 1) : 0;
  config.lines = &line;
  config.line_count = c.word() % 2;
  const std::uint32_t format = c.chance(90) ? 2 * (c.word() % 2) : c.word();  // a PNG file takes long
  std::size_t size = 0;
  return breve_plot_file(&config, format, nullptr, 0, &size);
}

struct MovieHolder {
  breve_movie* movie = nullptr;
  std::uint8_t rgba[4 * kSide * kSide] = {};
  explicit MovieHolder(Caller& c) {
    breve_runtime* runtime = c.runtimes()[0];
    breve_movie_config config = breve_movie_config_default();
    config.width = config.height = kSide;
    config.format = "gif";
    config.write = [](void*, const void*, std::size_t) { return true; };
    if (!runtime || c.chance(10) || breve_movie_create(runtime, &config, &movie) != BREVE_OK) c.expect_refusal();
  }
  ~MovieHolder() { breve_movie_destroy(movie); }
  MovieHolder(const MovieHolder&) = delete;
  MovieHolder& operator=(const MovieHolder&) = delete;
};

breve_status movie_create(Caller& c) {
  breve_runtime* runtime = c.runtime();
  breve_movie_config config = breve_movie_config_default();
  config.struct_size = c.struct_size(sizeof config);
  config.width = c.chance(90) ? kSide : c.word();
  config.height = c.chance(90) ? kSide : c.word();
  config.fps = c.chance(80) ? 25 : c.number();
  config.format = c.chance(80) ? "gif" : c.chance(50) ? "xyz" : nullptr;
  if (c.chance(90)) config.write = [](void*, const void*, std::size_t) { return true; };
  breve_movie* movie = nullptr;
  const breve_status status = breve_movie_create(runtime, &config, &movie);
  breve_movie_destroy(movie);
  return status;
}
breve_status movie_destroy(Caller&) { return breve_movie_destroy(nullptr), BREVE_OK; }

breve_status movie_add(Caller& c) {
  const MovieHolder holder(c);
  return breve_movie_add(holder.movie, holder.rgba, c.chance(50) ? 0 : 4 * kSide);
}

breve_status movie_finish(Caller& c) {
  const MovieHolder holder(c);
  if (holder.movie && c.chance(50)) (void)breve_movie_add(holder.movie, holder.rgba, 0);
  return breve_movie_finish(holder.movie);
}

constexpr Function kFunctions[] = {
    {"breve_scene_create", scene_create},
    {"breve_scene_destroy", scene_destroy},
    {"breve_scene_read", scene_read, kScriptError},
    {"breve_scene_rows", scene_rows},
    {"breve_scene_backdrop", scene_backdrop},
    {"breve_scene_camera", scene_camera},
    {"breve_camera_project", camera_project, kNotFound},
    {"breve_view_create", view_create, kUnsupported | kFile},
    {"breve_view_destroy", view_destroy},
    {"breve_view_render", view_render, kScriptError},
    {"breve_view_depth", view_depth, kNotFound},
    {"breve_view_set_camera", view_set_camera},
    {"breve_view_camera", view_camera, kNotFound},
    {"breve_view_counts", view_counts},
    {"breve_png", png},
    {"breve_view_set_arrows", view_set_arrows},
    {"breve_view_arrows", view_arrows},
    {"breve_plot_file", plot_file},
    {"breve_movie_create", movie_create, kUnsupported | kFile},
    {"breve_movie_destroy", movie_destroy},
    {"breve_movie_add", movie_add, kNotFound | kFile},
    {"breve_movie_finish", movie_finish, kNotFound | kFile},
};

}  // namespace call_views

std::span<const Function> view_functions() { return call_views::kFunctions; }

}  // namespace breve::fuzz
