// The input of a world that is recorded or replayed, and the log that it is written to.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "breve/breve.h"

namespace breve::host {

/// Numbers and byte strings, one after the other.
class LogWriter {
 public:
  void number(std::uint64_t value);
  void text(std::string_view bytes);  // behind its size
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads them again. Beyond the end there are zeros and empty texts, and failed() is true.
class LogReader {
 public:
  explicit LogReader(std::string_view bytes) : rest_(bytes) {}
  std::uint64_t number();
  std::string_view text();
  std::string_view rest() const { return rest_; }
  bool failed() const { return failed_; }

 private:
  std::string_view rest_;
  bool failed_ = false;
};

/// How to make an image from an earlier one: most of two images in a row is the same.
std::string delta_of(std::string_view base, std::string_view image);
/// StatusError{BREVE_ERROR_IMAGE} if the delta is damaged.
std::string apply_delta(std::string_view base, std::string_view delta);

/// What scripts receive from outside in one iteration, in its order.
class Inputs {
 public:
  enum class Kind : std::uint8_t {
    Failed,
    Number,
    Opened,
    NotOpened,
    Read,
    Written,
    Command,
    Host,
    Request,
    Fetched,
    NotFetched
  };

  /// To be filled.
  Inputs() = default;
  /// To be given again. The bytes must outlive it.
  explicit Inputs(std::string_view recorded) : replayed_(recorded) {}

  bool replaying() const { return replayed_.has_value(); }
  void add(Kind kind, std::string_view bytes);
  /// The next one, which should be of this kind. None if it failed when it was recorded, or if the run has taken
  /// another course.
  std::optional<std::string_view> next(Kind kind);
  /// The next one is of this kind.
  bool is_next(Kind kind) const;
  /// Something else was asked for than was recorded, or not all of it.
  bool strayed() const { return strayed_ || (replayed_ && !replayed_->rest().empty()); }
  const std::string& bytes() const { return added_.bytes(); }

 private:
  LogWriter added_;
  std::optional<LogReader> replayed_;
  bool strayed_ = false;
};

/// Scripts of the world get their input through `inputs` while this stands.
class InputsScope {
 public:
  InputsScope(breve_world& world, Inputs& inputs);
  ~InputsScope();
  InputsScope(const InputsScope&) = delete;
  InputsScope& operator=(const InputsScope&) = delete;

 private:
  breve_world& world_;
};

/// A number that a script receives: noted, or replaced by what was recorded.
void pass_number(breve_world& world, void* bytes, std::size_t size);

/// How an iteration ended.
enum class Ending : std::uint8_t {
  Well,
  Failed,  // it fails in the same way when it is run again
  Cut      // by something that does not happen again: an interrupt, a lack of memory
};

/// The log's record of an iteration.
struct IterationRecord {
  Ending ending = Ending::Well;
  std::uint64_t iteration = 0, hash = 0;  // at its end
  std::string_view before;                // delta of the image to begin with; "": as the last one ended
  std::string_view inputs;
  std::string_view after;  // delta of the image it was cut with
};

/// The marks of a log. The first is also its version.
inline constexpr std::string_view kLogBegins = "breve log 1\n";
inline constexpr std::uint64_t kImageMark = 1, kIterationMark = 2, kEndMark = 3;

/// Writes the log of a world.
class Recorder {
 public:
  Recorder(const breve_world& world, breve_write_fn write, void* sink);
  void begin(const breve_world& world);
  void end(const breve_world& world, Ending ending);
  void finish();
  Inputs& inputs() { return inputs_; }

 private:
  void write(std::uint64_t mark, std::string_view payload);
  std::string delta_to(const breve_world& world);

  const breve_write_fn write_;
  void* const sink_;
  std::string base_;  // the last image in the log
  std::string before_;
  std::uint64_t hash_;  // of the world at the end of the last iteration
  Inputs inputs_;
};

/// Runs an iteration of a world that is recorded. A log that cannot be continued ends, with a warning.
void record_iteration(breve_world& world);

}  // namespace breve::host
