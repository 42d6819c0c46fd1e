// What there is to see, as rows that hosts read.
#include "scene.hpp"

#include <cmath>
#include <cstring>

#include "physical.hpp"
#include "steve/library/show.hpp"

using namespace breve::host;

namespace breve::host {

namespace {

template <std::size_t N, class Numbers>
void put(float (&out)[N], const Numbers& numbers) {
  std::copy_n(numbers.data(), N, out);
}

const char* text_or_empty(const std::string& text) { return text.c_str(); }

breve_instance row_of(const breve_world& world, const SceneInstance& one) {
  breve_instance row{};
  row.object = handle_of(world, one.object);
  put(row.transform, one.transform);
  put(row.color, one.color);
  put(row.texture_scale, one.texture_scale);
  row.mesh = one.mesh;
  row.texture = one.texture;
  row.casts_shadow = one.shadow;
  row.fixed = one.fixed;
  return row;
}

const float* numbers_of(const auto& rows) { return rows.empty() ? nullptr : rows.front().data(); }

breve_mesh row_of(const breve_world&, const SceneMesh& one) {
  return {numbers_of(one.positions),
          numbers_of(one.normals),
          numbers_of(one.uvs),
          numbers_of(one.colors),
          one.indices.empty() ? nullptr : one.indices.data(),
          one.positions.size(),
          one.indices.size(),
          one.revision};
}

breve_texture row_of(const breve_world& world, const SceneTexture& one) {
  const bool live = !one.rgba.empty() && world.world->alive(one.image);
  return {live ? handle_of(world, one.image) : breve_object{}, one.rgba.empty() ? nullptr : one.rgba.data(),
          static_cast<std::uint32_t>(one.width), static_cast<std::uint32_t>(one.height), one.revision};
}

breve_line row_of(const breve_world&, const SceneLine& one) {
  breve_line row{};
  put(row.from, one.from);
  put(row.to, one.to);
  put(row.color, one.color);
  row.width = one.width;
  row.pattern = one.pattern;
  return row;
}

breve_vertex row_of(const breve_world&, const SceneVertex& one) {
  breve_vertex row{};
  put(row.position, one.position);
  put(row.color, one.color);
  return row;
}

breve_sprite row_of(const breve_world& world, const SceneSprite& one) {
  breve_sprite row{};
  row.object = handle_of(world, one.object);
  put(row.center, one.center);
  row.size = one.size;
  row.heading = one.heading;
  put(row.color, one.color);
  row.texture = one.texture;
  row.glow = one.glow;
  row.point = one.point;
  return row;
}

breve_sheet row_of(const breve_world& world, const SceneSheet& one) {
  breve_sheet row{};
  row.object = handle_of(world, one.object);
  put(row.corner, one.corner);
  put(row.across, one.across);
  put(row.along, one.along);
  row.columns = static_cast<std::uint32_t>(one.columns);
  row.rows = static_cast<std::uint32_t>(one.rows);
  row.rgba = one.rgba.data();
  row.revision = one.revision;
  return row;
}

breve_label row_of(const breve_world& world, const SceneLabel& one) {
  breve_label row{};
  row.object = handle_of(world, one.object);
  put(row.place, one.location);
  row.text = text_or_empty(one.text);
  return row;
}

breve_overlay_text row_of(const breve_world&, const SceneText& one) {
  breve_overlay_text row{};
  row.text = text_or_empty(one.text);
  row.x = one.x;
  row.y = one.y;
  put(row.color, one.color);
  return row;
}

breve_camera row_of(const breve_world& world, const SceneCamera& one) {
  breve_camera row = to_host(one);
  if (one.object) row.object = handle_of(world, one.object);
  return row;
}

breve_light row_of(const breve_world&, const SceneLight& one) {
  breve_light row{};
  copy_to(row.position, one.position);
  put(row.ambient, one.ambient);
  put(row.diffuse, one.diffuse);
  put(row.specular, one.specular);
  return row;
}

/// The plots, and the lines of all of them.
void fill_plots(const breve_world& world, const Scene& scene, std::vector<breve_plot>& plots,
                std::vector<breve_plot_line>& lines) {
  plots.clear();
  lines.clear();
  for (const ScenePlot& plot : scene.plots) {
    const auto first = static_cast<std::uint32_t>(lines.size()), number = static_cast<std::uint32_t>(plots.size());
    plots.push_back({handle_of(world, plot.object), plot.title.c_str(), plot.x_axis.c_str(), plot.y_axis.c_str(), first,
                     static_cast<std::uint32_t>(plot.lines.size())});
    for (const ScenePlot::Line& line : plot.lines) {
      breve_plot_line row{line.name.c_str(), line.values.data(), line.values.size(), {}, number};
      put(row.color, line.color);
      lines.push_back(row);
    }
  }
}

template <class Row, class All>
void fill(std::vector<Row>& rows, const breve_world& world, const All& all) {
  rows.clear();
  for (const auto& one : all) rows.push_back(row_of(world, one));
}

template <class Row>
breve_rows rows_of(const std::vector<Row>& rows) {
  return {rows.empty() ? nullptr : rows.data(), rows.size(), sizeof(Row)};
}

}  // namespace

breve_camera to_host(const SceneCamera& camera) {
  breve_camera row{};
  copy_to(row.target, camera.target);
  copy_to(row.offset, camera.offset);
  row.pitch = camera.pitch;
  row.yaw = camera.yaw;
  row.field_of_view = camera.field_of_view;
  row.far_plane = camera.far_plane;
  const double window[] = {camera.x, camera.y, camera.width, camera.height};
  std::copy_n(window, 4, row.window);
  row.automatic = camera.automatic;
  row.orthographic = camera.orthographic;
  return row;
}

SceneCamera from_host(const breve_camera& camera) {
  SceneCamera is;
  is.target = vector_of(camera.target, "target");
  is.offset = vector_of(camera.offset, "offset");
  const double others[] = {camera.pitch, camera.yaw, camera.field_of_view, camera.far_plane};
  need_finite(others, 4, "a number of the camera");
  is.pitch = camera.pitch;
  is.yaw = camera.yaw;
  is.field_of_view = camera.field_of_view;
  is.far_plane = std::max(1e-3, camera.far_plane);
  is.orthographic = camera.orthographic != 0;
  return is;
}

}  // namespace breve::host

struct breve_scene {
  breve::SceneBuilder builder;
  breve::Framing framing;
  std::vector<breve_instance> instances;
  std::vector<breve_mesh> meshes;
  std::vector<breve_texture> textures;
  std::vector<breve_line> lines;
  std::vector<breve_vertex> triangles;
  std::vector<breve_sprite> sprites;
  std::vector<breve_sheet> sheets;
  std::vector<breve_label> labels;
  std::vector<breve_overlay_text> texts;
  std::vector<breve_camera> cameras;
  std::vector<breve_light> lights;
  std::vector<breve_plot> plots;
  std::vector<breve_plot_line> plot_lines;

  void read(breve_world& world) {
    const breve::Scene& scene = builder.scene();
    breve::steve::show(*world.machine, builder);
    fill(instances, world, scene.instances);
    fill(meshes, world, scene.meshes);
    fill(textures, world, scene.textures);
    fill(lines, world, scene.lines);
    fill(triangles, world, scene.triangles);
    fill(sprites, world, scene.sprites);
    fill(sheets, world, scene.sheets);
    fill(labels, world, scene.labels);
    fill(texts, world, scene.texts);
    fill(cameras, world, scene.cameras);
    fill(lights, world, scene.lights);
    fill_plots(world, scene, plots, plot_lines);
  }
  void clear() {
    instances.clear();
    meshes.clear();
    textures.clear();
    lines.clear();
    triangles.clear();
    sprites.clear();
    sheets.clear();
    labels.clear();
    texts.clear();
    cameras.clear();
    lights.clear();
    plots.clear();
    plot_lines.clear();
  }
};

breve_status breve_scene_create(breve_scene** scene) {
  return guard([&] {
    need(scene, "scene");
    *scene = new breve_scene;
  });
}

void breve_scene_destroy(breve_scene* scene) { delete scene; }

breve_status breve_scene_read(breve_scene* scene, breve_world* world) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(scene, "scene");
    try {
      scene->read(*world);
    } catch (...) {
      scene->clear();
      throw;
    }
  });
}

breve_status breve_scene_rows(const breve_scene* scene, uint32_t part, breve_rows* rows) {
  return guard([&] {
    need(scene, "scene");
    need(rows, "rows");
    switch (part) {
      case BREVE_SCENE_INSTANCES: *rows = rows_of(scene->instances); break;
      case BREVE_SCENE_MESHES: *rows = rows_of(scene->meshes); break;
      case BREVE_SCENE_TEXTURES: *rows = rows_of(scene->textures); break;
      case BREVE_SCENE_LINES: *rows = rows_of(scene->lines); break;
      case BREVE_SCENE_TRIANGLES: *rows = rows_of(scene->triangles); break;
      case BREVE_SCENE_SPRITES: *rows = rows_of(scene->sprites); break;
      case BREVE_SCENE_SHEETS: *rows = rows_of(scene->sheets); break;
      case BREVE_SCENE_LABELS: *rows = rows_of(scene->labels); break;
      case BREVE_SCENE_TEXTS: *rows = rows_of(scene->texts); break;
      case BREVE_SCENE_CAMERAS: *rows = rows_of(scene->cameras); break;
      case BREVE_SCENE_LIGHTS: *rows = rows_of(scene->lights); break;
      case BREVE_SCENE_PLOTS: *rows = rows_of(scene->plots); break;
      case BREVE_SCENE_PLOT_LINES: *rows = rows_of(scene->plot_lines); break;
      default: fail(BREVE_ERROR_ARGUMENT, "part is " + std::to_string(part) + ", which is not a breve_scene_kind");
    }
  });
}

breve_status breve_scene_backdrop(const breve_scene* scene, breve_backdrop* backdrop) {
  return guard([&] {
    need(scene, "scene");
    const breve::Scene& is = scene->builder.scene();
    breve_backdrop filled{};
    put(filled.color, is.backdrop.color);
    filled.texture = is.backdrop.texture;
    filled.scroll[0] = is.backdrop.scroll_x;
    filled.scroll[1] = is.backdrop.scroll_y;
    filled.mountains = is.backdrop.mountains;
    filled.fog = is.fog.enabled;
    filled.fog_start = is.fog.start;
    filled.fog_end = is.fog.end;
    filled.fog_intensity = is.fog.intensity;
    put(filled.fog_color, is.fog.color);
    filled.dimension = static_cast<std::uint32_t>(is.dimension);
    filled.lighting = is.flags.lighting;
    filled.shadows = is.flags.shadows;
    filled.reflections = is.flags.reflections;
    filled.outline = is.flags.outline;
    filled.text = is.flags.text;
    filled.time = is.time;
    filled.iteration = is.iteration;
    std::copy(is.backdrop.skybox.begin(), is.backdrop.skybox.end(), filled.skybox);
    filled.every_frame = is.flags.every_frame;
    write_struct(backdrop, filled, "breve_backdrop");
  });
}

breve_status breve_scene_camera(breve_scene* scene, uint32_t width, uint32_t height, breve_camera* camera) {
  return guard([&] {
    need(scene, "scene");
    need(camera, "camera");
    if (width == 0 || height == 0) fail(BREVE_ERROR_ARGUMENT, "a side of the picture is 0");
    const breve::Scene& is = scene->builder.scene();
    if (is.cameras.empty()) fail(BREVE_ERROR_ARGUMENT, "the scene was not read yet");
    breve_camera row = to_host(breve::framed(is, is.cameras[0], static_cast<double>(width) / height, scene->framing));
    *camera = row;
  });
}

breve_status breve_camera_project(const breve_camera* camera, uint32_t width, uint32_t height, const double point[3],
                                  double seen[3]) {
  return guard([&] {
    need(camera, "camera");
    need(point, "point");
    need(seen, "seen");
    if (width == 0 || height == 0 || width > INT32_MAX || height > INT32_MAX)
      fail(BREVE_ERROR_ARGUMENT, "a side of the picture is 0 or too large");
    const breve::Lens lens = breve::lens_of(from_host(*camera), static_cast<double>(width) / height);
    double found[3];
    if (!breve::project(lens, vector_of(point, "point"), static_cast<int>(width), static_cast<int>(height), found))
      fail(BREVE_ERROR_NOT_FOUND, "the point is behind the camera");
    std::copy_n(found, 3, seen);
  });
}
