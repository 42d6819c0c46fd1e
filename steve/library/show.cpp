// Grids of cells, springs and terrains as parts of a scene.
#include "steve/library/show.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "runtime/scene/mesh.hpp"
#include "runtime/solid/height_grid.hpp"
#include "runtime/store/painted_pictures.hpp"
#include "runtime/world/drawing.hpp"
#include "runtime/world/show.hpp"
#include "steve/library/grids.hpp"
#include "steve/library/joints.hpp"
#include "steve/library/resources.hpp"
#include "steve/library/support.hpp"

namespace breve::steve {

namespace {

std::uint8_t byte_of(float part) { return static_cast<std::uint8_t>(std::lround(part * 255)); }

Vector4f cell_color(const GridResource& grid, CellIndex cell) {
  return color_of(grid.colors.empty() ? Vector3(1, 1, 1) : grid.colors[cell],
                  grid.alphas.empty() ? GridResource::kAlpha : grid.alphas[cell]);
}

/// Inks that differ in hue and brightness (Okabe and Ito 2008), on paper.
Vector4f ink(std::size_t number) {
  static constexpr std::array<std::array<float, 3>, 7> kInks{{{0.13F, 0.22F, 0.34F},
                                                              {0.84F, 0.37F, 0.00F},
                                                              {0.00F, 0.45F, 0.70F},
                                                              {0.00F, 0.62F, 0.45F},
                                                              {0.90F, 0.62F, 0.00F},
                                                              {0.80F, 0.47F, 0.65F},
                                                              {0.34F, 0.71F, 0.91F}}};
  const auto& c = kInks[number % kInks.size()];
  return {c[0], c[1], c[2], 1};
}

/// The colour of a cell if nobody set colours of the grid: with agents the ink of the first one's class, else that of
/// its state; 0 is paper.
Vector4f drawn_color(const World& world, const GridResource& resource, CellIndex cell) {
  const Occupants& agents = resource.occupants;
  if (agents.made() && agents.count(cell) > 0) return ink(1 + world.class_of(agents.agent(agents.first(cell)).id));
  const std::uint8_t state = resource.states.made() ? resource.states.get(cell) : std::uint8_t{0};
  return state != 0 ? ink(state - std::size_t{1}) : Vector4f(0.96F, 0.955F, 0.94F, 1);
}

/// A grid that is one cell deep is a picture in its plane. Cells whose transparency nobody set are opaque there.
void show_sheet(const World& world, ObjectId id, const GridResource& resource, bool colored, SceneBuilder& to) {
  const Grid& grid = *resource.grid;
  SceneSheet sheet;
  sheet.object = id;
  sheet.columns = grid.nx();
  sheet.rows = grid.ny();
  const Vector3 corner = grid.corner(0);
  const Vector3& size = grid.cell_size();
  sheet.corner = drawable(Vector3(corner + Vector3(0, 0, size.z() / 2)));
  sheet.across = Vector3f(drawable(size.x() * grid.nx()), 0, 0);
  sheet.along = Vector3f(0, drawable(size.y() * grid.ny()), 0);
  sheet.rgba.resize(4 * grid.cells());
  EveryFew often(to.poll);
  for (CellIndex cell = 0; cell < grid.cells(); ++cell) {
    often.count();
    const Cell3 at = grid.cell(cell);
    Vector4f color = colored ? cell_color(resource, cell) : drawn_color(world, resource, cell);
    if (resource.alphas.empty()) {
      color.w() = 1;
    } else if (colored && (resource.states.made() || resource.occupants.made())) {
      const Vector4f below = drawn_color(world, resource, cell);  // shows through
      color = Vector4f(below + color.w() * (color - below));
      color.w() = 1;
    }
    const auto pixel =
        static_cast<std::size_t>(at.y) * static_cast<std::size_t>(grid.nx()) + static_cast<std::size_t>(at.x);
    for (int part = 0; part < 4; ++part) sheet.rgba[4 * pixel + static_cast<std::size_t>(part)] = byte_of(color[part]);
  }
  sheet.revision = to.revision_of(sheet.rgba);
  sheet.clear = SceneBuilder::is_clear(sheet.rgba);
  to.scene().sheets.push_back(std::move(sheet));
}

/// If the grid has states, cells of state 0 are not to be seen.
/// @param colored  something has set colours; else cells are as in a sheet
/// @param solid    cells are opaque or not to be seen
void show_volume(const World& world, ObjectId id, const GridResource& resource, bool colored, bool solid,
                 SceneBuilder& to) {
  const Grid& grid = *resource.grid;
  const float least = solid ? 0.5F : 1.0F / 255;  // below that nothing is to be seen
  const bool states = resource.states.made();
  EveryFew often(to.poll);
  for (CellIndex cell = 0; cell < grid.cells(); ++cell) {
    often.count();
    if (states && resource.states.get(cell) == 0) continue;
    Vector4f color = colored ? cell_color(resource, cell) : drawn_color(world, resource, cell);
    if (color.w() < least) continue;
    if (solid) color.w() = 1;
    SceneInstance box{id, Transform::Zero(), color};
    box.transform.leftCols<3>() = drawable(grid.cell_size()).asDiagonal();
    box.transform.col(3) = drawable(grid.middle(cell));
    box.mesh = MeshCache::kBox;
    box.texture_scale = {1, 1};
    box.shadow = color.w() >= 1;
    to.scene().instances.push_back(box);
  }
}

/// Is this variable of a library class set to anything but 0?
bool is_set(Machine& machine, Instance* self, std::string_view owner, std::string_view name) {
  const Slot* slot = self ? library_slot(machine, *self, owner, name) : nullptr;
  return slot && slot->i != 0;
}

/// Shows nothing of a grid that has neither colours nor states nor agents.
void show_grid(Machine& machine, ObjectId id, const GridResource& resource, SceneBuilder& to) {
  const World& world = machine.world();
  if (!resource.grid) return;
  const bool colored = !resource.colors.empty() || !resource.alphas.empty();
  const bool drawn = resource.states.made() || resource.occupants.made();
  if (resource.grid->flat() && (colored || drawn))
    show_sheet(world, id, resource, colored, to);
  else if (colored || resource.states.made())
    show_volume(world, id, resource, colored, is_set(machine, machine.instance(id), "PatchGrid", "drawsSurface"), to);
}

void show_spring(Machine& machine, Instance& self, const SpringResource& resource, SceneBuilder& to) {
  const Mechanics& dynamics = dynamics_of(machine);
  if (resource.index == kNoSpring || !dynamics.has_spring(resource.index)) return;
  const SpringDescription& spring = dynamics.spring(resource.index);
  const Bodies& bodies = machine.world().bodies();
  const auto end = [&](BodyIndex body, const Vector3& point) {
    return drawable(Vector3(bodies.location(body) + bodies.rotation(body) * point));
  };
  const Slot* slot = library_slot(machine, self, "Spring", "springPattern");
  const std::string_view pattern = slot && slot->ref ? view(static_cast<const StringCell*>(slot->ref)) : "";
  to.scene().lines.push_back(
      {end(spring.a, spring.point_a), end(spring.b, spring.point_b), {0.15F, 0.15F, 0.18F, 1}, 2, line_style(pattern)});
}

Vector3f color_variable(Machine& machine, Instance& self, std::string_view name) {
  const Slot* slot = library_slot(machine, self, "Terrain", name);
  return slot ? color_of(Vector3(slot[0].d, slot[1].d, slot[2].d), 1).head<3>() : Vector3f(1, 1, 1);
}

/// The edges of a mesh, each once, in the colour of their first end.
void show_edges(const SceneInstance& instance, const SceneMesh& mesh, SceneBuilder& to) {
  EveryFew often(to.poll);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(mesh.indices.size());
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::uint32_t from = mesh.indices[i], end = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
    edges.emplace_back(std::min(from, end), std::max(from, end));
  }
  std::sort(edges.begin(), edges.end(), [&often](const auto& a, const auto& b) {
    often.count();
    return a < b;
  });
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const auto at = [&](std::uint32_t vertex) {
    return Vector3f(instance.transform * mesh.positions[vertex].homogeneous());
  };
  for (const auto& [from, end] : edges) {
    often.count();
    Vector4f color = instance.color;
    color.head<3>() = mesh.colors[from];
    to.scene().lines.push_back({at(from), at(end), color});
  }
}

/// The instance of a terrain gets a mesh that is coloured by height; of a wireframe there are lines in its place.
void show_terrains(Machine& machine, SceneBuilder& to) {
  std::vector<SceneInstance>& instances = to.scene().instances;
  const auto shown_as_lines = [&](const SceneInstance& instance) {
    const SceneMesh& mesh = to.mesh_data(instance.mesh);
    if (mesh.form != SceneMesh::Form::Ground || mesh.colors.empty()) return false;
    if (!is_set(machine, machine.instance(instance.object), "Terrain", "drawsWireframe")) return false;
    show_edges(instance, mesh, to);
    return true;
  };
  for (SceneInstance& instance : instances) {
    SceneMesh& mesh = to.mesh_data(instance.mesh);
    if (mesh.form != SceneMesh::Form::Ground) continue;
    Instance* self = machine.instance(instance.object);
    if (!self || !is_library_kind(*self, "Terrain")) continue;
    const Vector3f valley = color_variable(machine, *self, "valleyColor");
    const Vector3f peak = color_variable(machine, *self, "peakColor");
    // KEEP IN STEP: the colours in Terrain.tz.
    if (instance.texture == kNoTexture && valley == Vector3f(0, 0.8F, 0.1F) && peak == Vector3f(1, 1, 1))
      instance.unchosen = Unchosen::TextureAndColor;
    const std::vector<Vector3f> old = mesh.colors;
    color_by_height(mesh, valley, peak);
    if (old != mesh.colors) mesh.revision += std::uint64_t{1} << 32;
  }
  instances.erase(std::remove_if(instances.begin(), instances.end(), shown_as_lines), instances.end());
}

/// The checker of stationary bodies and the pattern of floors are the library's, unless the program loads them.
void mark_unchosen(Machine& machine, SceneBuilder& to) {
  Instance* controller = machine.controller();
  const Instance* checker = controller ? library_object(machine, *controller, "Control", "checkerTexture") : nullptr;
  for (SceneInstance& instance : to.scene().instances) {
    if (!instance.fixed || instance.texture == kNoTexture) continue;
    const SceneTexture& texture = to.scene().textures[instance.texture];
    const bool checkered = checker && texture.image == checker->id;
    if (!checkered && !to.ground_pattern) {
      const Image ground = paint_pattern("ground");
      to.ground_pattern = to.texture_revision(ground.width(), ground.bytes());
    }
    if (!checkered && texture.revision != *to.ground_pattern) continue;
    // KEEP IN STEP: the colours of Stationary and of Floor in Stationary.tz.
    const Vector4f first = checkered ? Vector4f(1, 1, 1, 1) : color_of(Vector3(0.35, 0.8, 0.45), 1);
    const bool same = instance.color.head<3>() == first.head<3>();
    instance.unchosen = same ? Unchosen::TextureAndColor : Unchosen::Texture;
  }
}

std::string text_variable(Machine& machine, Instance& self, std::string_view name) {
  const Slot* slot = library_slot(machine, self, "Graph", name);
  return slot && slot->ref ? std::string(view(static_cast<const StringCell*>(slot->ref))) : std::string();
}

const ListCell* list_variable(Machine& machine, Instance& self, std::string_view name) {
  const Slot* slot = library_slot(machine, self, "Graph", name);
  return slot ? static_cast<const ListCell*>(slot->ref) : nullptr;
}

/// The heights of a terrain whose edges are drawn, each of which takes as long as some numbers.
std::uint64_t wireframe_numbers(Machine& machine, Instance& instance) {
  constexpr std::uint64_t kOfHeight = 30;
  if (!is_library_kind(instance, "Terrain") || !is_set(machine, &instance, "Terrain", "drawsWireframe")) return 0;
  const auto* resource = resource_of<ShapeResource>(machine, &instance);
  const HeightGrid* heights = resource && resource->shape ? resource->shape->heights() : nullptr;
  if (!heights) return 0;
  return kOfHeight * static_cast<std::uint64_t>(heights->columns()) * static_cast<std::uint64_t>(heights->rows());
}

double number_of(const Value& value) {
  if (value.tag == Tag::Int) return value.i;
  return value.tag == Tag::Double ? value.d : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::uint64_t plot_size(Machine& machine, Instance& graph) {
  const ListCell* lines = list_variable(machine, graph, "lineValues");
  std::uint64_t size = 0;
  for (std::uint32_t i = 0; lines && i < lines->size; ++i) {
    const Value list = (*lines)[i];
    size += 1 + (list.tag == Tag::List && list.ref ? static_cast<const ListCell*>(list.ref)->size : 0);
  }
  return size;
}

ScenePlot plot_of(Machine& machine, Instance& graph, const Poll& poll) {
  ScenePlot plot;
  plot.object = graph.id;
  plot.title = text_variable(machine, graph, "graphTitle");
  plot.x_axis = text_variable(machine, graph, "xAxisName");
  plot.y_axis = text_variable(machine, graph, "yAxisName");
  const ListCell* colors = list_variable(machine, graph, "lineColors");
  const ListCell* values = list_variable(machine, graph, "lineValues");
  if (!colors || !values) return plot;
  EveryFew often(poll);
  for (std::uint32_t i = 0; i < std::min(colors->size, values->size); ++i) {
    often.count();
    const Value color = (*colors)[i], list = (*values)[i];
    ScenePlot::Line line;
    if (color.tag == Tag::Vector) line.color = color_of(color.vector(), 1).head<3>();
    if (list.tag == Tag::List && list.ref)
      for (const Value& value : *static_cast<const ListCell*>(list.ref)) {
        often.count();
        line.values.push_back(number_of(value));
      }
    plot.lines.push_back(std::move(line));
  }
  return plot;
}

std::uint64_t shown_numbers(Machine& machine) {
  std::uint64_t numbers = 0;
  for (const ObjectId id : machine.world().objects()) {
    Instance* instance = machine.instance(id);
    if (!instance) continue;
    if (is_library_kind(*instance, "Graph")) numbers += plot_size(machine, *instance);
    numbers += wireframe_numbers(machine, *instance);
    const auto* grid = resource_of<GridResource>(machine, instance);
    if (grid && grid->grid) numbers += grid->grid->cells();
  }
  return numbers;
}

void show(Machine& machine, SceneBuilder& scene, const Arrows& arrows) {
  scene.begin();
  World& world = machine.world();
  breve::show(world, scene);
  for (const ObjectId id : world.objects()) {
    Instance* instance = machine.instance(id);
    if (instance && is_library_kind(*instance, "Graph"))
      if (ScenePlot plot = plot_of(machine, *instance, scene.poll); !plot.lines.empty())
        scene.scene().plots.push_back(std::move(plot));
    if (const auto* grid = resource_of<GridResource>(machine, instance)) show_grid(machine, id, *grid, scene);
    if (const auto* spring = resource_of<SpringResource>(machine, instance))
      show_spring(machine, *instance, *spring, scene);
  }
  show_terrains(machine, scene);
  mark_unchosen(machine, scene);
  show_arrows(machine, arrows, scene);
  scene.end();
}

}  // namespace breve::steve
