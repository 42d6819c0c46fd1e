// Natives of Control that set what is drawn around the bodies: lights, shadows, backdrop, fog, text, pictures.
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

ViewState& view_of(Machine& machine) { return machine.world().view(); }

// --- flags -----------------------------------------------------------------------------------------------------------

template <bool DrawingFlags::*Flag>
void enable(Machine& machine, Instance&) {
  view_of(machine).flags.*Flag = true;
}
template <bool DrawingFlags::*Flag>
void disable(Machine& machine, Instance&) {
  view_of(machine).flags.*Flag = false;
}
template <bool DrawingFlags::*Flag>
void toggle(Machine& machine, Instance&) {
  view_of(machine).flags.*Flag = !(view_of(machine).flags.*Flag);
}

template <bool On>
void fog(Machine& machine, Instance&) {
  view_of(machine).fog.enabled = On;
}
void toggle_fog(Machine& machine, Instance&) { view_of(machine).fog.enabled = !view_of(machine).fog.enabled; }

template <bool LightExposureState::*Flag, bool On>
void light_exposure(Machine& machine, Instance&) {
  view_of(machine).light_exposure.*Flag = On;
}

void set_light_exposure_source(Machine& machine, Instance&, Vector3 location) {
  view_of(machine).light_exposure.source = finite(location, "the light exposure source");
}

void set_blur_factor(Machine& machine, Instance&, double factor) {
  view_of(machine).flags.blur_factor = finite(factor, "the blur factor");
}

void clear_screen(Machine& machine, Instance&) { ++view_of(machine).clears; }

// --- lights ----------------------------------------------------------------------------------------------------------

/// Light `number`, or null with a warning.
LightState* light(Machine& machine, std::int32_t number) {
  if (number >= 0 && static_cast<std::size_t>(number) < kLightCount)
    return &view_of(machine).lights[static_cast<std::size_t>(number)];
  machine.warn("light " + std::to_string(number) + " does not exist: the lights are 0 to " +
               std::to_string(kLightCount - 1));
  return nullptr;
}

template <Vector3 LightState::*Property>
void set_light(Machine& machine, Instance&, Vector3 value, std::int32_t number) {
  finite(value, "a property of a light");
  if (LightState* one = light(machine, number)) one->*Property = value;
}

void set_light_color(Machine& machine, Instance&, Vector3 color, std::int32_t) {
  LightState& main = view_of(machine).lights[0];
  main.ambient = main.diffuse = main.specular = finite(color, "a light's colour");
}

// --- backdrop --------------------------------------------------------------------------------------------------------

void set_background_color(Machine& machine, Instance&, Vector3 color) {
  view_of(machine).backdrop.color = finite(color, "the background colour");
}

void set_background_texture_image(Machine& machine, Instance&, Instance* image) {
  view_of(machine).backdrop.texture = machine.id_of(image);
}

void set_background_texture(Machine& machine, Instance&, std::int32_t number) {
  view_of(machine).backdrop.texture = object_with_index(machine, number);
}

void set_background_scroll_rate(Machine& machine, Instance&, double x, double y) {
  view_of(machine).backdrop.scroll_x = finite(x, "the background scroll rate");
  view_of(machine).backdrop.scroll_y = finite(y, "the background scroll rate");
}

/// Take the names of the six files. 0 with a warning if there are not six.
std::int32_t name_skybox(Machine& machine, Instance&, ListCell* files) {
  BackdropState& backdrop = view_of(machine).backdrop;
  if (!files || files->size != backdrop.sides.size()) {
    machine.warn("set-skybox-images needs six file names: front, back, left, right, top, bottom");
    return 0;
  }
  std::pmr::vector<std::pmr::string> fresh(backdrop.skybox.get_allocator());
  for (const Value& file : *files) {
    if (file.tag != Tag::String) Machine::fail(RunErrorKind::Type, "set-skybox-images: every element must be a string");
    fresh.emplace_back(view(file.string()));
  }
  backdrop.skybox.swap(fresh);
  backdrop.mountains = false;
  return 1;
}

ObjectId& skybox_side(Machine& machine, std::int32_t number) {
  auto& sides = view_of(machine).backdrop.sides;
  if (number < 0 || static_cast<std::size_t>(number) >= sides.size())
    throw Error(ErrorCode::Argument, "a sky box has no side " + std::to_string(number) + ": its sides are 0 to 5");
  return sides[static_cast<std::size_t>(number)];
}

Instance* get_skybox_side(Machine& machine, Instance&, std::int32_t number) {
  return machine.instance(skybox_side(machine, number));
}

void set_skybox_side(Machine& machine, Instance&, Instance* image, std::int32_t number) {
  skybox_side(machine, number) = machine.id_of(image);
}

void set_mountain_skybox(Machine& machine, Instance&) {
  view_of(machine).backdrop.skybox.clear();
  view_of(machine).backdrop.sides = {};
  view_of(machine).backdrop.mountains = true;
}

void set_fog_limits(Machine& machine, Instance&, double start, double end) {
  view_of(machine).fog.start = finite(start, "a fog limit");
  view_of(machine).fog.end = finite(end, "a fog limit");
}

void set_fog_intensity(Machine& machine, Instance&, double intensity) {
  view_of(machine).fog.intensity = finite(intensity, "the fog's intensity");
}

void set_fog_color(Machine& machine, Instance&, Vector3 color) {
  view_of(machine).fog.color = finite(color, "the fog's colour");
}

// --- text ------------------------------------------------------------------------------------------------------------

void set_text(Machine& machine, Text text, std::int32_t slot, double x, double y, const Vector3& color) {
  if (slot < 0 || static_cast<std::size_t>(slot) >= kOverlayTextCount) {
    machine.warn("display text " + std::to_string(slot) + " does not exist: the slots are 0 to " +
                 std::to_string(kOverlayTextCount - 1));
    return;
  }
  finite(x, "a text's place");
  finite(y, "a text's place");
  finite(color, "a text's colour");
  OverlayText& overlay = view_of(machine).texts[static_cast<std::size_t>(slot)];
  overlay.text = view(text);
  overlay.x = x;
  overlay.y = y;
  overlay.color = color;
}

void set_display_text(Machine& machine, Instance&, Text text, double x, double y, std::int32_t slot, Vector3 color) {
  set_text(machine, text, slot, x, y, color);
}

void set_display_message(Machine& machine, Instance&, Text text, std::int32_t slot, double x, double y, Vector3 color) {
  set_text(machine, text, slot, x, y, color);
}

void set_display_text_scale(Machine& machine, Instance&, double scale) {
  view_of(machine).text_scale = finite(scale, "the text scale");
}

void set_display_text_color(Machine& machine, Instance&, Vector3 color) {
  finite(color, "the text colour");
  for (OverlayText& text : view_of(machine).texts) text.color = color;
}

using Flags = DrawingFlags;

constexpr Native kViewNatives[] = {
    native<enable<&Flags::lighting>>("control.enable-lighting"),
    native<disable<&Flags::lighting>>("control.disable-lighting"),
    native<toggle<&Flags::lighting>>("control.toggle-lighting"),
    native<set_light<&LightState::position>>("control.move-light"),
    native<set_light_color>("control.set-light-color"),
    native<set_light<&LightState::ambient>>("control.set-light-ambient-color"),
    native<set_light<&LightState::diffuse>>("control.set-light-diffuse-color"),
    native<set_light<&LightState::specular>>("control.set-light-specular-color"),
    native<light_exposure<&LightExposureState::detection, true>>("control.enable-light-exposure-detection"),
    native<light_exposure<&LightExposureState::detection, false>>("control.disable-light-exposure-detection"),
    native<light_exposure<&LightExposureState::drawing, true>>("control.enable-light-exposure-drawing"),
    native<light_exposure<&LightExposureState::drawing, false>>("control.disable-light-exposure-drawing"),
    native<set_light_exposure_source>("control.set-light-exposure-source"),
    native<enable<&Flags::shadow_catcher>>("control.set-shadow-catcher"),
    native<enable<&Flags::shadows>>("control.enable-shadows"),
    native<disable<&Flags::shadows>>("control.disable-shadows"),
    native<toggle<&Flags::shadows>>("control.toggle-shadows"),
    native<enable<&Flags::shadow_volumes>>("control.enable-shadow-volumes"),
    native<disable<&Flags::shadow_volumes>>("control.disable-shadow-volumes"),
    native<toggle<&Flags::shadow_volumes>>("control.toggle-shadow-volumes"),
    native<enable<&Flags::reflections>>("control.enable-reflections"),
    native<disable<&Flags::reflections>>("control.disable-reflections"),
    native<toggle<&Flags::reflections>>("control.toggle-reflections"),
    native<enable<&Flags::every_frame>>("control.enable-draw-every-frame"),
    native<disable<&Flags::every_frame>>("control.disable-draw-every-frame"),
    native<enable<&Flags::outline>>("control.enable-outline"),
    native<disable<&Flags::outline>>("control.disable-outline"),
    native<enable<&Flags::blur>>("control.enable-blur"),
    native<disable<&Flags::blur>>("control.disable-blur"),
    native<toggle<&Flags::blur>>("control.toggle-blur"),
    native<set_blur_factor>("control.set-blur-factor"),
    native<clear_screen>("control.clear-screen"),
    native<fog<true>>("control.enable-fog"),
    native<fog<false>>("control.disable-fog"),
    native<toggle_fog>("control.toggle-fog"),
    native<set_fog_limits>("control.set-fog-limits"),
    native<set_fog_intensity>("control.set-fog-intensity"),
    native<set_fog_color>("control.set-fog-color"),
    native<set_background_color>("control.set-background-color"),
    native<set_background_texture_image>("control.set-background-texture-image"),
    native<set_background_texture>("control.set-background-texture"),
    native<set_background_scroll_rate>("control.set-background-scroll-rate"),
    native<name_skybox>("control.name-skybox"),
    native<get_skybox_side>("control.get-skybox-side"),
    native<set_skybox_side>("control.set-skybox-side"),
    native<set_mountain_skybox>("control.set-mountain-skybox"),
    native<enable<&Flags::text>>("control.enable-text"),
    native<disable<&Flags::text>>("control.disable-text"),
    native<set_display_text>("control.set-display-text"),
    native<set_display_message>("control.set-display-message"),
    native<set_display_text_scale>("control.set-display-text-scale"),
    native<set_display_text_color>("control.set-display-text-color"),
};

}  // namespace

std::span<const Native> view_natives() { return kViewNatives; }

}  // namespace breve::steve
