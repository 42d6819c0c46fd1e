// Finding a library file by its name or by a class in it; what is not there yet; kinds of native data.
#include "steve/library/library.hpp"

#include <algorithm>

#include "runtime/store/image_resource.hpp"
#include "runtime/world/camera.hpp"
#include "runtime/world/drawing.hpp"
#include "runtime/world/menu.hpp"
#include "steve/library/grids.hpp"
#include "steve/library/joints.hpp"
#include "steve/library/push_resources.hpp"
#include "steve/library/resources.hpp"

namespace breve::steve {

namespace {

constexpr std::string_view kLaterClasses[] = {"Graph",          "IRSensor", "IRSensors", "Movie", "NetworkServer",
                                              "NetworkServers", "QProgram", "QSystem",   "Sound", "Sounds",
                                              "Tone",           "Tones",    "URL"};

constexpr std::string_view kLaterFiles[] = {"QGAME"};

struct ResourceKind {
  std::string_view name;
  ResourceLoader loader;
};
constexpr ResourceKind kResourceKinds[] = {
    {CameraResource::kKind, &CameraResource::load},
    {MenuItemResource::kKind, &MenuItemResource::load},
    {DrawingResource::kKind, &DrawingResource::load},
    {LineResource::kKind, &LineResource::load},
    {ShapeResource::kKind, &ShapeResource::load},
    {ImageResource::kKind, &ImageResource::load},
    {FieldResource::kKind, &FieldResource::load},
    {JointResource::kKind, &JointResource::load},
    {SpringResource::kKind, &SpringResource::load},
    {GridResource::kKind, &GridResource::load},
    {ReactionResource::kKind, &ReactionResource::load},
    {PushInterpreterResource::kKind, &PushInterpreterResource::load},
    {PushProgramResource::kKind, &PushProgramResource::load},
    {PushPoolResource::kKind, &PushPoolResource::load},
};

/// Is `word` one of the space-separated words of `list`?
bool holds_word(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    const std::size_t space = std::min(list.find(' '), list.size());
    if (list.substr(0, space) == word) return true;
    list.remove_prefix(std::min(space + 1, list.size()));
  }
  return false;
}

}  // namespace

const LibraryFile* find_library_file(std::string_view name) {
  std::string_view stem = name;
  if (stem.ends_with(".tz")) stem.remove_suffix(3);
  if (stem.empty()) return nullptr;
  for (const LibraryFile& file : library_files())
    if (file.name.substr(0, file.name.size() - 3) == stem) return &file;
  for (const LibraryFile& file : library_files())
    if (holds_word(file.classes, stem)) return &file;
  return nullptr;
}

std::span<const std::string_view> later_classes() { return kLaterClasses; }

bool is_later_file(std::string_view name) {
  return std::find(std::begin(kLaterFiles), std::end(kLaterFiles), name) != std::end(kLaterFiles);
}

bool is_later_class(std::string_view name_or_alias) {
  return std::find(std::begin(kLaterClasses), std::end(kLaterClasses), name_or_alias) != std::end(kLaterClasses);
}

void register_resource_kinds(World& world) {
  for (const ResourceKind& kind : kResourceKinds) world.add_resource_kind(kind.name, kind.loader);
}

std::unique_ptr<Resource> load_resource(std::string_view name, ByteReader& in) {
  for (const ResourceKind& kind : kResourceKinds)
    if (kind.name == name) return kind.loader(in);
  ByteReader::fail();
}

}  // namespace breve::steve
