// The native data behind CMAEvolutionStrategy and MultiObjectiveSearch objects.
#pragma once

#include "runtime/learn/evolution/cma_es.hpp"
#include "runtime/learn/evolution/nsga2.hpp"
#include "runtime/world/resource.hpp"

namespace breve::steve {

/// A search of runtime/learn/evolution.
template <class Search>
class SearchResource final : public Resource {
 public:
  static const std::string_view kKind;
  explicit SearchResource(std::pmr::memory_resource* memory) : search(memory) {}
  Search search;

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override { search.save(out); }
  void hash(Hasher& hasher) const override { search.hash(hasher); }
  static std::unique_ptr<Resource> load(ByteReader& in) {
    auto resource = make_in<SearchResource>(in.memory(), in.memory());
    resource->search.load(in);
    return resource;
  }
};

using CmaEsResource = SearchResource<learn::CmaEs>;
using Nsga2Resource = SearchResource<learn::Nsga2>;
template <>
inline constexpr std::string_view CmaEsResource::kKind = "cma-es";
template <>
inline constexpr std::string_view Nsga2Resource::kKind = "multi-objective-search";

}  // namespace breve::steve
