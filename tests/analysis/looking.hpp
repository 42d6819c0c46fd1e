// A program as text in which a '~' marks a place, and questions about that place.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "steve/analysis/analysis.hpp"

namespace breve::steve::test {

class NoModules final : public ModuleResolver {
 public:
  std::optional<ModuleSource> resolve(std::string_view, std::string_view) override { return std::nullopt; }
};

inline constexpr std::string_view kWorld = R"(@use Control.
@define SPEED 5.5. # length units a second
Controller Field.

Mobile : Bird (aka Birds) {
  % A bird.
  + variables:
    heading (vector). # where it flies
    leader (Bird object).
    friend (object).
    wings (2 ints).

  + to fly to place (vector) with-speed speed = 1.5 (float):
    % Fly somewhere.
    here (vector).

    here = (self get-location).
    friend = new Bird.
    return self.

  - to rest:
    % Do nothing for a while.
    leader rest.
}

Control : Field {
  + variables:
    birds (list).
    first (object).

  + to init:
    b (object).

    push (new Bird) onto birds.
    first = birds{0}.
    foreach b in birds: b rest.
    BODY
}
)";

/// kWorld with `body` in the place of BODY, which stands in Field's init.
inline std::string world(std::string_view body) {
  std::string text(kWorld);
  const std::size_t at = text.find("BODY");
  return text.replace(at, 4, body);
}

class Looking {
 public:
  explicit Looking(std::string text) : offset_(static_cast<std::uint32_t>(std::min(text.find('~'), text.size()))) {
    if (offset_ < text.size()) text.erase(offset_, 1);
    NoModules modules;
    analysis = std::make_unique<Analysis>(ModuleSource{"main.tz", std::move(text)}, modules);
  }

  std::vector<std::string> completions() const {
    std::vector<std::string> names;
    for (const Completion& item : analysis->completions(0, offset_).items) names.push_back(item.name);
    return names;
  }
  bool offers(std::string_view name) const {
    const std::vector<std::string> names = completions();
    return std::find(names.begin(), names.end(), name) != names.end();
  }
  std::optional<Reference> at() const { return analysis->at(0, offset_); }

  /// "Owner.signature" of each definition, joined by "; "; "nothing" if there is no name.
  std::string definitions() const {
    const auto found = analysis->definitions(0, offset_);
    if (!found) return "nothing";
    std::string text;
    for (const std::size_t i : *found) text += (text.empty() ? "" : "; ") + shown(i);
    return text;
  }
  std::string shown(std::size_t symbol) const {
    const SymbolInfo& s = analysis->symbols()[symbol];
    return (s.owner.empty() ? "" : s.owner + ".") + s.signature;
  }
  const SymbolInfo* symbol(NameKind kind, std::string_view name, std::string_view owner = "") const {
    for (const SymbolInfo& s : analysis->symbols())
      if (s.kind == kind && s.name == name && s.owner == owner) return &s;
    return nullptr;
  }

  std::unique_ptr<Analysis> analysis;

 private:
  std::uint32_t offset_;
};

/// Of kWorld with that body.
inline Looking in_body(std::string_view body) { return Looking(world(body)); }

}  // namespace breve::steve::test
