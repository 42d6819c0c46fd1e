// Replays: the iterations of a log are run again, with what the log holds in place of the outside.
#include "internal.hpp"
#include "runtime/base/hasher.hpp"
#include "tape.hpp"

namespace breve::host {

namespace {

[[noreturn]] void fail_log(const char* why) { fail(BREVE_ERROR_IMAGE, std::string("the log ") + why); }

/// The records of a log.
class Log {
 public:
  explicit Log(std::string_view bytes) : in_(bytes) {
    if (!bytes.starts_with(kLogBegins)) fail_log("does not begin as a log does, or was written by another version");
    in_ = LogReader(bytes.substr(kLogBegins.size()));
  }
  /// @return  false at the end, also one in the middle of a record
  bool next(std::uint64_t& mark, std::string_view& payload) {
    mark = in_.number();
    payload = in_.text();
    const std::uint64_t check = in_.number();
    if (in_.failed()) return false;
    Hasher hasher;
    hasher.add(mark);
    hasher.add(payload);
    if (check != hasher.value() || mark < kImageMark || mark > kEndMark) fail_log("is damaged");
    return true;
  }

 private:
  LogReader in_;
};

IterationRecord record_of(std::string_view payload) {
  LogReader in(payload);
  IterationRecord record;
  const std::uint64_t ending = in.number();
  record.ending = static_cast<Ending>(ending);
  record.iteration = in.number();
  record.hash = in.number();
  record.before = in.text();
  record.inputs = in.text();
  record.after = in.text();
  if (in.failed() || ending > static_cast<std::uint64_t>(Ending::Cut)) fail_log("has a damaged iteration");
  return record;
}

class Replay {
 public:
  Replay(breve_world& world, breve_replay& result) : world_(world), result_(result) {}
  void begin(std::string_view image) {
    base_ = image;
    restore_image(world_, base_);
  }
  /// @return  false: it differs
  bool run(const IterationRecord& record) {
    if (!record.before.empty()) put(record.before);
    bool same = true;
    if (record.ending == Ending::Cut)
      put(record.after);
    else
      same = iterate_again(record);
    result_.iteration = world_.world->iteration();
    result_.hash = hash_of(world_);
    result_.recorded_hash = record.hash;
    ++result_.iterations;
    result_.differs = !same || result_.hash != record.hash;
    return !result_.differs;
  }

 private:
  void put(std::string_view delta) {
    base_ = apply_delta(base_, delta);
    restore_image(world_, base_);
  }
  bool iterate_again(const IterationRecord& record) {
    Inputs inputs(record.inputs);
    const InputsScope scope(world_, inputs);
    const breve_status status = guard(world_.error, [&] { iterate(world_); });
    return (status != BREVE_OK) == (record.ending == Ending::Failed) && !inputs.strayed();
  }

  breve_world& world_;
  breve_replay& result_;
  std::string base_;
};

}  // namespace
}  // namespace breve::host

using namespace breve::host;

breve_status breve_world_replay(breve_world* world, const void* log, size_t size,
                                bool (*after)(void* user, breve_world* world), void* user, breve_replay* replay) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(log, "log");
    need(replay, "replay");
    need_idle(*world, "breve_world_replay");
    if (world->recorder) fail(BREVE_ERROR_ARGUMENT, "the world is being recorded");
    Log records({static_cast<const char*>(log), size});
    std::uint64_t mark = 0;
    std::string_view payload;
    if (!records.next(mark, payload) || mark != kImageMark) fail_log("has no snapshot at its beginning");
    breve_replay result{};
    Replay again(*world, result);
    again.begin(payload);
    while (records.next(mark, payload)) {
      if (mark == kImageMark) fail_log("has a snapshot in its middle");
      result.complete = mark == kEndMark;
      if (mark == kEndMark || !again.run(record_of(payload))) break;
      const CallbackScope busy(*world);
      if (after && !after(user, world)) break;
    }
    *replay = result;
  });
}
