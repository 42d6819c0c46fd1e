// The list of scenes, and what all of them need.
#include "tests/scenes/scene.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "tests/scenes/builders.hpp"

namespace breve::scenes {
namespace {

struct Entry {
  std::string name;
  std::function<Scene()> build;
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all{
      {"clump_80", [] { return clump(80, false); }},
      {"clump_160", [] { return clump(160, false); }},
      {"springs_27", [] { return springs(3, false); }},
      {"springs_125", [] { return springs(5, false); }},
      {"springs_343", [] { return springs(7, false); }},
      {"meshes", meshes},
      {"terrain_agents", terrain_agents},
      {"terrain_balls", [] { return terrain_balls(false); }},
      {"vehicle_prisms", [] { return vehicle(Wheels::Prisms, false); }},
      {"vehicle_balls", [] { return vehicle(Wheels::Balls, false); }},
      {"pyramid", [] { return pyramid(false); }},
      {"dominoes", [] { return dominoes(false); }},
      {"crowd", [] { return crowd(false); }},
      {"bowl", [] { return pour(false); }},
      {"walker", [] { return walkers(1, false); }},
      {"walkers_200", [] { return walkers(200, false); }},
      {"ragdoll", [] { return ragdoll(false); }},
      {"flat_clump_80", [] { return clump(80, true); }},
      {"flat_clump_160", [] { return clump(160, true); }},
      {"flat_springs_25", [] { return springs(5, true); }},
      {"flat_springs_121", [] { return springs(11, true); }},
      {"flat_springs_361", [] { return springs(19, true); }},
      {"flat_terrain_balls", [] { return terrain_balls(true); }},
      {"flat_vehicle_prisms", [] { return vehicle(Wheels::Prisms, true); }},
      {"flat_vehicle_balls", [] { return vehicle(Wheels::Balls, true); }},
      {"flat_pyramid", [] { return pyramid(true); }},
      {"flat_dominoes", [] { return dominoes(true); }},
      {"flat_crowd", [] { return crowd(true); }},
      {"flat_bowl", [] { return pour(true); }},
      {"flat_walker", [] { return walkers(1, true); }},
      {"flat_walkers_200", [] { return walkers(200, true); }},
      {"flat_ragdoll", [] { return ragdoll(true); }},
  };
  return all;
}

}  // namespace

int Scene::add(const Body& body) {
  bodies.push_back(body);
  return static_cast<int>(bodies.size()) - 1;
}

std::size_t Scene::add(Shape shape) {
  shapes.push_back(std::move(shape));
  return shapes.size() - 1;
}

bool Scene::has(Form form) const {
  return std::any_of(shapes.begin(), shapes.end(), [form](const Shape& shape) { return shape.form == form; });
}

void prepare(const Scene& scene, Side& side, int step, double time) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].born == step) side.appear(static_cast<int>(i));
  if (scene.act) scene.act(side, time);
}

const std::vector<std::string>& names() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> out;
    for (const Entry& entry : entries()) out.push_back(entry.name);
    return out;
  }();
  return all;
}

Scene make(std::string_view name) {
  for (const Entry& entry : entries())
    if (entry.name == name) {
      Scene scene = entry.build();
      scene.name = entry.name;
      return scene;
    }
  throw std::out_of_range("no scene \"" + std::string(name) + "\"");
}

Vector3 Draw::within(const Vector3& half) {
  const double x = between(-half.x(), half.x()), y = between(-half.y(), half.y());
  return {x, y, between(-half.z(), half.z())};
}

Quaternion Draw::orientation(bool flat) {
  const double a = between(-3, 3), b = between(-3, 3), c = between(-3, 3);
  const Quaternion about_z(Eigen::AngleAxisd(a, Vector3::UnitZ()));
  if (flat) return about_z;
  return about_z * Eigen::AngleAxisd(b, Vector3::UnitY()) * Eigen::AngleAxisd(c, Vector3::UnitX());
}

void add_floor(Scene& scene, double length) {
  Body floor;
  floor.shape = scene.add(box({length, 10, length}));
  floor.at = {0, -5, 0};
  floor.motion = Motion::Fixed;
  scene.add(floor);
}

}  // namespace breve::scenes
