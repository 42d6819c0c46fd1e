// The native data behind CMAEvolutionStrategy and MultiObjectiveSearch objects.
#pragma once

#include "runtime/learn/evolution/cma_es.hpp"
#include "runtime/learn/evolution/nsga2.hpp"
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

class Nsga2Resource final : public Resource {
 public:
  static constexpr std::string_view kKind = "multi-objective-search";
  explicit Nsga2Resource(std::pmr::memory_resource* memory) : search(memory) {}
  learn::Nsga2 search;

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override { search.save(out); }
  void hash(Hasher& hasher) const override { search.hash(hasher); }
  static std::unique_ptr<Resource> load(ByteReader& in) {
    auto resource = make_in<Nsga2Resource>(in.memory(), in.memory());
    resource->search.load(in);
    return resource;
  }
};

}  // namespace breve::steve
