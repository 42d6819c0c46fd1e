// What the library consists of, and what is not there yet; kinds of native data.
#include "steve/library/library.hpp"

#include "runtime/store/image_resource.hpp"
#include "runtime/world/camera.hpp"
#include "runtime/world/drawing.hpp"
#include "runtime/world/menu.hpp"
#include "steve/library/evolution_resource.hpp"
#include "steve/library/grids.hpp"
#include "steve/library/joints.hpp"
#include "steve/library/neural_resource.hpp"
#include "steve/library/push_resources.hpp"
#include "steve/library/resources.hpp"
#include "steve/library/sounds.hpp"

namespace breve::steve {

namespace {

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
    {SoundResource::kKind, &SoundResource::load},
    {ToneResource::kKind, &ToneResource::load},
    {NeuralNetworkResource::kKind, &NeuralNetworkResource::load},
    {CmaEsResource::kKind, &CmaEsResource::load},
    {Nsga2Resource::kKind, &Nsga2Resource::load},
};

}  // namespace

const LibrarySource& library_source() {
  static const LibrarySource source{library_files(), library_natives(), functions()};
  return source;
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
