// Logs of all that a world gets from outside. What the host does between two iterations is found by hashes, whatever
// function it used, and written as the difference of two images; what scripts receive within one is written as it
// comes.
#include <cstring>

#include "internal.hpp"
#include "runtime/base/hasher.hpp"
#include "tape.hpp"

namespace breve::host {

void Inputs::add(Kind kind, std::string_view bytes) {
  added_.number(static_cast<std::uint64_t>(kind));
  added_.text(bytes);
}

bool Inputs::is_next(Kind kind) const {
  return replayed_ && LogReader(replayed_->rest()).number() == static_cast<std::uint64_t>(kind);
}

std::optional<std::string_view> Inputs::next(Kind kind) {
  if (strayed_ || !replayed_ || replayed_->rest().empty()) {
    strayed_ = true;
    return std::nullopt;
  }
  const std::uint64_t is = replayed_->number();
  const std::string_view bytes = replayed_->text();
  if (is == static_cast<std::uint64_t>(Kind::Failed)) return std::nullopt;
  strayed_ = replayed_->failed() || is != static_cast<std::uint64_t>(kind);
  return strayed_ ? std::nullopt : std::optional(bytes);
}

InputsScope::InputsScope(breve_world& world, Inputs& inputs) : world_(world) { world.inputs = &inputs; }
InputsScope::~InputsScope() { world_.inputs = nullptr; }

void pass_number(breve_world& world, void* bytes, std::size_t size) {
  if (!world.inputs) return;
  if (!world.inputs->replaying()) {
    world.inputs->add(Inputs::Kind::Number, {static_cast<const char*>(bytes), size});
    return;
  }
  const auto recorded = world.inputs->next(Inputs::Kind::Number);
  if (recorded && recorded->size() == size) std::memcpy(bytes, recorded->data(), size);
}

Recorder::Recorder(const breve_world& world, breve_write_fn write, void* sink)
    : write_(write), sink_(sink), base_(image_of(world)), hash_(hash_of(world)) {
  write_(sink_, kLogBegins.data(), kLogBegins.size());
  this->write(kImageMark, base_);
}

/// A record is written in one piece: a process that ends leaves whole records, and perhaps the beginning of another.
void Recorder::write(std::uint64_t mark, std::string_view payload) {
  Hasher hasher;
  hasher.add(mark);
  hasher.add(payload);
  LogWriter record;
  record.number(mark);
  record.text(payload);
  record.number(hasher.value());
  write_(sink_, record.bytes().data(), record.bytes().size());
}

std::string Recorder::delta_to(const breve_world& world) {
  std::string image = image_of(world);
  std::string delta = delta_of(base_, image);
  base_ = std::move(image);
  return delta;
}

void Recorder::begin(const breve_world& world) {
  before_.clear();
  inputs_ = Inputs();
  if (hash_of(world) != hash_) before_ = delta_to(world);
}

void Recorder::end(const breve_world& world, Ending ending) {
  hash_ = hash_of(world);
  LogWriter record;
  record.number(static_cast<std::uint64_t>(ending));
  record.number(world.world->iteration());
  record.number(hash_);
  record.text(before_);
  record.text(inputs_.bytes());
  record.text(ending == Ending::Cut ? delta_to(world) : std::string());
  write(kIterationMark, record.bytes());
}

void Recorder::finish() { write(kEndMark, {}); }

namespace {

/// A step of the recording. If it fails, the run goes on without.
template <class Work>
void keep_recording(breve_world& world, Work work) {
  if (!world.recorder) return;
  try {
    const CallbackScope busy(world);  // the host's function cannot end the recording that it is called by
    work(*world.recorder);
  } catch (const std::exception& e) {
    world.recorder.reset();
    world.machine->host().warn(std::string("warning: the recording ends here: ") + e.what() + "\n");
  }
}

Ending ending_of_current() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return Ending::Cut;
  } catch (const Error& e) {
    return e.code() == ErrorCode::Interrupted || e.code() == ErrorCode::Memory ? Ending::Cut : Ending::Failed;
  } catch (...) {
    return Ending::Failed;
  }
}

}  // namespace

void record_iteration(breve_world& world) {
  keep_recording(world, [&](Recorder& recorder) { recorder.begin(world); });
  if (!world.recorder) {
    iterate(world);
    return;
  }
  try {
    const InputsScope inputs(world, world.recorder->inputs());
    iterate(world);
  } catch (...) {
    const Ending ending = ending_of_current();
    keep_recording(world, [&](Recorder& recorder) { recorder.end(world, ending); });
    throw;
  }
  keep_recording(world, [&](Recorder& recorder) { recorder.end(world, Ending::Well); });
}

}  // namespace breve::host

using namespace breve::host;

breve_status breve_world_record_start(breve_world* world, breve_write_fn write, void* sink) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(reinterpret_cast<const void*>(write), "write");
    need_idle(*world, "breve_world_record_start");
    if (world->recorder) fail(BREVE_ERROR_ARGUMENT, "the world is being recorded already");
    const CallbackScope busy(*world);
    world->recorder = std::make_unique<Recorder>(*world, write, sink);
  });
}

breve_status breve_world_record_stop(breve_world* world) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need_idle(*world, "breve_world_record_stop");
    if (!world->recorder) return;
    const CallbackScope busy(*world);
    world->recorder->finish();
    world->recorder.reset();
  });
}

bool breve_world_recording(const breve_world* world) { return world && world->recorder; }

breve_status breve_world_record_input(breve_world* world, void* bytes, size_t size) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (size != 0) need(bytes, "bytes");
    Inputs* const inputs = world->inputs;
    if (!inputs) return;
    if (!inputs->replaying()) {
      inputs->add(Inputs::Kind::Host, {static_cast<const char*>(bytes), size});
      return;
    }
    const auto recorded = inputs->next(Inputs::Kind::Host);
    if (!recorded || recorded->size() != size)
      fail(BREVE_ERROR_IMAGE, "the replay has taken another course: the log has no such input here");
    if (size != 0) std::memcpy(bytes, recorded->data(), size);
  });
}
