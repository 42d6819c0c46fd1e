// The native data behind CMAEvolutionStrategy objects.
#pragma once

#include "runtime/learn/evolution/cma_es.hpp"
#include "runtime/world/resource.hpp"

namespace breve::steve {

class CmaEsResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "cma-es";
  explicit CmaEsResource(std::pmr::memory_resource* memory) : search(memory) {}
  learn::CmaEs search;

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override { search.save(out); }
  void hash(Hasher& hasher) const override { search.hash(hasher); }
  static std::unique_ptr<Resource> load(ByteReader& in) {
    auto resource = make_in<CmaEsResource>(in.memory(), in.memory());
    resource->search.load(in);
    return resource;
  }
};

}  // namespace breve::steve
