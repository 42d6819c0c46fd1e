// The view's state in snapshots and hashes. One list of fields serves saving, loading and hashing.
#include "runtime/world/view.hpp"

namespace breve {

namespace {

struct Saver {
  ByteWriter& out;
  void field(const bool& value) { out.put(value); }
  void field(const double& value) { out.put(value); }
  void field(const std::int32_t& value) { out.put(value); }
  void field(const std::uint64_t& value) { out.put(value); }
  void field(const Vector3& value) { out.put(value); }
  void field(const std::pmr::string& value) { out.put(std::string_view(value)); }
  void field(const ObjectId& value) { out.put(value); }
  void field(const CameraState& value) { value.save(out); }
  void field(const std::pmr::vector<std::pmr::string>& value) {
    out.put(static_cast<std::uint64_t>(value.size()));
    for (const std::pmr::string& text : value) field(text);
  }
};

struct Loader {
  ByteReader& in;
  void field(bool& value) { value = in.get_bool(); }
  void field(double& value) { value = in.get<double>(); }
  void field(std::int32_t& value) { value = in.get<std::int32_t>(); }
  void field(std::uint64_t& value) { value = in.get<std::uint64_t>(); }
  void field(Vector3& value) { value = in.get_vector(); }
  void field(std::pmr::string& value) { value = in.get_text(); }
  void field(ObjectId& value) { value = in.get_object(); }
  void field(CameraState& value) { value.load(in); }
  void field(std::pmr::vector<std::pmr::string>& value) {
    value.resize(in.get_count(sizeof(std::uint64_t)));
    for (std::pmr::string& text : value) field(text);
  }
};

struct Mixer {
  Hasher& hasher;
  void field(const bool& value) { hasher.add(static_cast<std::uint64_t>(value)); }
  void field(const double& value) { hasher.add(value); }
  void field(const std::int32_t& value) { hasher.add(static_cast<std::uint64_t>(static_cast<std::int64_t>(value))); }
  void field(const std::uint64_t& value) { hasher.add(value); }
  void field(const Vector3& value) { hasher.add(value); }
  void field(const std::pmr::string& value) { hasher.add(std::string_view(value)); }
  void field(const ObjectId& value) { hasher.add(static_cast<std::uint64_t>(value.index) << 32 | value.generation); }
  void field(const CameraState& value) { value.hash(hasher); }
  void field(const std::pmr::vector<std::pmr::string>& value) {
    hasher.add(static_cast<std::uint64_t>(value.size()));
    for (const std::pmr::string& text : value) field(text);
  }
};

/// Every field, in the order of the image. `view` is const for saving and hashing.
template <class Visitor, class View>
void visit(Visitor& v, View& view) {
  v.field(view.camera);
  for (auto* pan : {&view.offset_pan, &view.target_pan}) {
    v.field(pan->goal);
    v.field(pan->steps);
  }
  v.field(view.frozen);
  v.field(view.selection);
  for (auto& light : view.lights) {
    v.field(light.position);
    v.field(light.ambient);
    v.field(light.diffuse);
    v.field(light.specular);
  }
  v.field(view.fog.enabled);
  v.field(view.fog.start);
  v.field(view.fog.end);
  v.field(view.fog.intensity);
  v.field(view.fog.color);
  v.field(view.backdrop.color);
  v.field(view.backdrop.texture);
  v.field(view.backdrop.scroll_x);
  v.field(view.backdrop.scroll_y);
  v.field(view.backdrop.skybox);
  if (!view.backdrop.skybox.empty())
    for (auto& side : view.backdrop.sides) v.field(side);
  v.field(view.backdrop.mountains);
  auto& flags = view.flags;
  for (auto* flag : {&flags.lighting, &flags.shadow_volumes, &flags.shadows, &flags.reflections, &flags.shadow_catcher,
                     &flags.blur, &flags.outline, &flags.text, &flags.every_frame, &flags.recording})
    v.field(*flag);
  v.field(flags.blur_factor);
  v.field(view.light_exposure.detection);
  v.field(view.light_exposure.drawing);
  v.field(view.light_exposure.source);
  for (auto& text : view.texts) {
    v.field(text.text);
    v.field(text.x);
    v.field(text.y);
    v.field(text.color);
  }
  v.field(view.text_scale);
  v.field(view.clears);
}

}  // namespace

Vector3 Pan::advance(const Vector3& now) {
  if (steps <= 0) return now;
  const Vector3 next = steps == 1 ? goal : Vector3(now + (goal - now) / steps);
  --steps;
  return next;
}

ViewState::ViewState(std::pmr::memory_resource* memory)
    : backdrop(memory),
      texts{{{std::pmr::string(memory)},
             {std::pmr::string(memory)},
             {std::pmr::string(memory)},
             {std::pmr::string(memory)},
             {std::pmr::string(memory)},
             {std::pmr::string(memory)},
             {std::pmr::string(memory)},
             {std::pmr::string(memory)}}} {
  static_assert(kOverlayTextCount == 8);
}

void ViewState::save(ByteWriter& out) const {
  Saver saver{out};
  visit(saver, *this);
}

void ViewState::load(ByteReader& in) {
  Loader loader{in};
  visit(loader, *this);
}

void ViewState::hash(Hasher& hasher) const {
  Mixer mixer{hasher};
  visit(mixer, *this);
}

}  // namespace breve
