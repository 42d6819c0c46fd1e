// The world as an image and as a hash. An image is read into a fresh world first; this one changes only if all was
// well.
#include <array>
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/world/parts.hpp"

namespace breve {

namespace {

constexpr std::array<char, 8> kMagic{'b', 'r', 'e', 'v', 'e', 'i', 'm', 'g'};
constexpr std::uint32_t kVersion = 21;  // grows with every change of what follows the header

std::uint64_t checksum(const std::uint8_t* data, std::size_t size) {
  Hasher hasher;
  hasher.add(std::string_view(reinterpret_cast<const char*>(data), size));
  return hasher.value();
}

[[noreturn]] void refuse(const std::string& why) { throw Error(ErrorCode::Image, why); }

/// Checks the header and gives a reader of what it covers.
ByteReader open_image(const std::uint8_t* data, std::size_t size, std::uint64_t fingerprint,
                      std::pmr::memory_resource* memory) {
  ByteReader in(data, size, memory);
  std::array<char, 8> magic{};
  in.raw(magic.data(), magic.size());
  if (magic != kMagic) refuse("this is not an image of a world");
  if (in.get<std::uint32_t>() != kVersion) refuse("the image is of another version of the library");
  if (in.get<std::uint64_t>() != fingerprint) refuse("the image is of another program");
  const auto length = in.get<std::uint64_t>();
  const auto sum = in.get<std::uint64_t>();
  if (length != in.left()) refuse("the image is damaged or truncated");
  if (checksum(data + (size - in.left()), in.left()) != sum) refuse("the image is damaged");
  return in;
}

void save_input(ByteWriter& out, const std::pmr::deque<InputEvent>& events) {
  out.put(static_cast<std::uint64_t>(events.size()));
  for (const InputEvent& event : events) {
    out.put(event.kind);
    out.put(std::string_view(event.key));
    out.put(event.object);
  }
}

void load_input(ByteReader& in, std::pmr::deque<InputEvent>& events) {
  const std::size_t count = in.get_count(2 * sizeof(std::uint64_t));
  for (std::size_t i = 0; i < count; ++i) {
    InputEvent event;
    event.kind = in.get<InputEvent::Kind>();
    if (event.kind > InputEvent::Kind::Menu) ByteReader::fail();
    event.key = in.get_string();
    event.object = in.get_object();
    events.push_back(std::move(event));
  }
}

}  // namespace

std::pmr::vector<std::uint8_t> World::save(std::uint64_t program_fingerprint) const {
  if (stepping_ || advancing_) throw Error(ErrorCode::Busy, "a world cannot be saved from inside a step");
  ByteWriter out(memory_);
  out.raw(kMagic.data(), kMagic.size());
  out.put(kVersion);
  out.put(program_fingerprint);
  const std::size_t seal = out.bytes().size();  // length and checksum of the rest, known at the end
  out.put(std::uint64_t{0});
  out.put(std::uint64_t{0});
  const std::size_t start = out.bytes().size();
  write_image(out);
  const std::uint64_t length = out.bytes().size() - start;
  out.overwrite(seal, length);
  out.overwrite(seal + sizeof length, checksum(out.bytes().data() + start, length));
  return out.take();
}

void World::write_image(ByteWriter& out) const {
  const Parts& parts = *parts_;
  out.put(clock_.time);
  out.put(clock_.residue);
  out.put(clock_.iteration_step);
  out.put(clock_.integration_step);
  out.put(clock_.iteration);
  out.put(clock_.end_requested);
  out.put(clock_.paused);
  out.put(bodies_->flat());
  random_.save(out);
  view_.save(out);
  parts.names.save(out);
  parts.objects.save(out);
  bodies_->save(out);
  parts.schedule.save(out, parts.objects);
  parts.notifications.save(out, parts.objects);
  parts.handlers.save(out);
  parts.pairs.save(out);
  parts.collisions.save(out);
  parts.effects.save(out);
  parts.dynamics->save(out);
  out.put(parts.exact_schedule);
  out.put(parts.at_impact);
  out.put(parts.first_handler);
  parts.save_targets(out);
  parts.save_pushes(out);
  parts.space.save(out);
  parts.near.save(out);
  save_input(out, parts.input);
  out.put(behaviour_ != nullptr);
  if (behaviour_) behaviour_->save(out);
}

void World::read_image(ByteReader& in, World& fresh) const {
  Parts& parts = *fresh.parts_;
  fresh.clock_.time = in.get<double>();
  fresh.clock_.residue = in.get<double>();
  fresh.clock_.iteration_step = in.get<double>();
  fresh.clock_.integration_step = in.get<double>();
  fresh.clock_.iteration = in.get<std::uint64_t>();
  fresh.clock_.end_requested = in.get_bool();
  fresh.clock_.paused = in.get_bool();
  for (const double seconds : {fresh.clock_.time, fresh.clock_.residue})
    if (!std::isfinite(seconds)) ByteReader::fail();
  for (const double step : {fresh.clock_.iteration_step, fresh.clock_.integration_step})
    if (!std::isfinite(step) || !(step > 0)) ByteReader::fail();
  if (in.get_bool()) fresh.flatten();
  fresh.random_.load(in);
  fresh.view_.load(in);
  parts.names.load(in);
  parts.objects.load(
      in,
      [](const void* context, std::string_view kind) -> ResourceLoader {
        const auto& loaders = static_cast<const Parts*>(context)->loaders;
        const auto loader = loaders.find(kind);
        return loader == loaders.end() ? nullptr : loader->second;
      },
      parts_.get());
  fresh.bodies_->load(in);
  std::size_t embodied = 0;
  for (const ObjectId id : parts.objects.order()) {
    if (!parts.objects.alive(id) || parts.objects.at(id).body == kNoBody) continue;
    const BodyIndex body = parts.objects.at(id).body;
    if (!fresh.bodies_->used(body) || fresh.bodies_->owner(body) != id) ByteReader::fail();
    ++embodied;
  }
  if (embodied != fresh.bodies_->size()) ByteReader::fail();
  parts.schedule.load(in, parts.objects, parts.names.size());
  parts.notifications.load(in, parts.objects, parts.names.size());
  parts.handlers.load(in, parts.names.size());
  parts.pairs.load(in);
  parts.collisions.load(in);
  parts.effects.load(in);
  parts.dynamics->load(in);
  parts.exact_schedule = in.get_bool();
  parts.at_impact = in.get_bool();
  parts.first_handler = in.get_object();
  parts.load_targets(in);
  parts.load_pushes(in);
  parts.space.load(in);
  parts.near.load(in, parts.objects);
  parts.near.close(parts.space);
  load_input(in, parts.input);
}

void World::swap_state(World& other) {
  bodies_->swap(*other.bodies_);
  std::swap(parts_, other.parts_);
  std::swap(parts_->loaders, other.parts_->loaders);
  std::swap(parts_->judge, other.parts_->judge);
  parts_->rebind(*this);
  other.parts_->rebind(other);
  std::swap(random_, other.random_);
  std::swap(view_, other.view_);
  std::swap(clock_, other.clock_);
}

void World::load(const std::uint8_t* data, std::size_t size, std::uint64_t program_fingerprint) {
  if (stepping_ || advancing_) throw Error(ErrorCode::Busy, "a world cannot be loaded from inside a step");
  ByteReader in = open_image(data, size, program_fingerprint, memory_);
  World fresh(memory_);
  try {
    read_image(in, fresh);
  } catch (const Error& error) {  // of whatever looked at a part
    if (error.code() == ErrorCode::Image || error.code() == ErrorCode::Memory) throw;
    refuse("the image is damaged: " + std::string(error.what()));
  }
  const bool scripted = in.get_bool();
  if (scripted != (behaviour_ != nullptr)) refuse("the image is of a world with a different script engine");
  if (!scripted && in.left() != 0) ByteReader::fail();
  fresh.parts_->objects.keep_tickets(parts_->objects);
  // The script side may look at the objects while it reads its own part, and takes it only if all of it is good.
  swap_state(fresh);
  try {
    if (behaviour_) behaviour_->load(in);
  } catch (...) {
    swap_state(fresh);
    throw;
  }
  look_again();
}

std::uint64_t World::hash() const {
  const Parts& parts = *parts_;
  Hasher hasher;
  hasher.add(clock_.time);
  hasher.add(clock_.residue);
  hasher.add(clock_.iteration_step);
  hasher.add(clock_.integration_step);
  hasher.add(clock_.iteration);
  hasher.add(static_cast<std::uint64_t>(clock_.end_requested) | static_cast<std::uint64_t>(clock_.paused) << 1);
  random_.hash(hasher);
  view_.hash(hasher);
  parts.objects.hash(hasher);
  for (const ObjectId id : parts.objects.order()) {
    if (parts.objects.alive(id) && parts.objects.at(id).body != kNoBody) {
      bodies_->hash(hasher, parts.objects.at(id).body);
    }
  }
  parts.schedule.hash(hasher, parts.names, parts.objects);
  parts.notifications.hash(hasher, parts.names, parts.objects);
  parts.handlers.hash(hasher, parts.names);
  parts.pairs.hash(hasher);
  parts.collisions.hash(hasher);
  parts.dynamics->hash(hasher);
  parts.hash_targets(hasher);
  parts.hash_pushes(hasher);
  hasher.add(static_cast<std::uint64_t>(parts.exact_schedule) | static_cast<std::uint64_t>(parts.at_impact) << 1);
  parts.space.hash(hasher);
  parts.near.hash(hasher);
  for (const InputEvent& event : parts.input) {
    hasher.add(std::uint64_t{event.object.index} << 8 | static_cast<std::uint64_t>(event.kind));
    hasher.add(std::string_view(event.key));
  }
  if (behaviour_) behaviour_->hash(hasher);
  return hasher.value();
}

}  // namespace breve
