// A host that calls any function of breve.h in any order: what it holds, the arguments that it draws, and what it
// demands of each call. call_target.cpp makes the calls; caller_callbacks.cpp has the callbacks, which call back in.
#pragma once

#include <array>
#include <cstring>
#include <deque>
#include <string>
#include <vector>

#include "breve/analysis.h"
#include "breve/breve.h"
#include "choices.hpp"
#include "class_library.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace breve::fuzz {

class Caller;

/// A set of statuses; BREVE_OK, _ARGUMENT and _MEMORY may come of any function.
using Statuses = std::uint32_t;
constexpr Statuses status_bit(breve_status status) { return Statuses{1} << status; }

/// A function of breve.h, and how it is called: one call, with arguments that the caller draws.
struct Function {
  const char* name;
  breve_status (*call)(Caller&);
  Statuses may_give = 0;
  unsigned weight = 1;  // how often it is called, compared with others
};

/// Facts about the arguments of the call that is being made, and so of its status.
struct Demand {
  bool null_handle = false;            // the status is BREVE_ERROR_ARGUMENT
  bool refusal = false;                // the status is an error
  const breve_world* world = nullptr;  // whose last error is that of the call
  const breve_runtime* runtime = nullptr;
};

struct PreparedSelector {
  breve_selector selector{};
  std::size_t keywords = 0;
};

/// Reads a text that the library gave to its end; ASan tells if it is gone.
inline void read_text(const char* text) {
  require(text != nullptr, "a text is NULL");
  require(std::strlen(text) < std::size_t{1} << 30, "a text has no end");
}

class Caller {
 public:
  explicit Caller(Bytes bytes);
  Caller(const Caller&) = delete;
  Caller& operator=(const Caller&) = delete;

  /// Calls until the choices have run out; then everything is destroyed, in any order, and nothing may be left.
  void run();

  Choices& choose() { return choices_; }
  bool chance(std::size_t percent) { return choices_.chance(percent); }

  // --- handles: one that lives, or rarely NULL
  breve_runtime* runtime();
  breve_program* program();
  breve_analysis* analysis();
  breve_world* world();

  // --- objects: live ones of this world, ones of other worlds, gone ones, null, and numbers that were never given out
  breve_object object(const breve_world* world, const char* class_name = nullptr);
  /// The same where the null object is allowed, and a gone one is refused.
  breve_object object_or_null(const breve_world* world, const char* class_name = nullptr);
  /// No demand is made of the status: for functions that take any id.
  breve_object any_object(const breve_world* world, const char* class_name = nullptr);

  // --- numbers, texts, values
  double number();  // mostly what a scene may have; also NaN, infinite and huge ones
  double finite();  // small
  std::uint32_t word();
  template <std::size_t N>
  const double* numbers(double (&to)[N], bool optional = false);
  breve_pose pose();
  const char* class_name();                    // may be NULL
  const char* text_or_null(const char* text);  // `text`, or rarely NULL, which is refused
  breve_value value(const breve_world* world);
  breve_value value_of_type(const std::string& type, const breve_world* world);
  std::size_t struct_size(std::size_t right);
  std::size_t capacity();

  // --- what calls gave
  void keep(breve_object object);
  void keep(const breve_value& value);
  void keep(breve_program* program) { programs_.push_back(program); }
  void keep(breve_analysis* analysis) { analyses_.push_back(analysis); }
  void keep(breve_world* world) { worlds_.push_back(world); }
  std::vector<breve_program*>& programs() { return programs_; }
  std::vector<breve_world*>& worlds() { return worlds_; }
  std::vector<breve_analysis*>& analyses() { return analyses_; }
  std::array<breve_runtime*, 2>& runtimes() { return runtimes_; }
  std::vector<PreparedSelector>& selectors() { return selectors_; }
  std::vector<std::string>& images() { return images_; }

  // --- demands
  void expect_refusal() { demand_->refusal = true; }
  void expect_argument_error() { demand_->null_handle = true; }
  void accept_null() { demand_->null_handle = false; }
  /// No error text is to be looked for: the function ends the handle, or keeps errors elsewhere.
  void forget_handles() { demand_->world = nullptr, demand_->runtime = nullptr; }

  // --- callbacks
  breve_runtime_config runtime_config();
  breve_trace_fn trace();
  breve_listener listener();
  void call_back(breve_world* speaker);
  bool called_back() const { return depth_ > 1; }

 private:
  friend struct Callbacks;

  /// What one runtime has of the host, to see at the end that it has given everything back.
  struct Ledger {
    Caller* caller = nullptr;
    std::size_t bytes = 0, files = 0, modules = 0, plugins = 0;  // that were given and not given back
    long retained = 0;
  };

  void start();
  void finish();
  void make_call();
  void make_call(const Function& function);
  void check(const Function& function, const Demand& demand, breve_status status);
  void compile_text(std::size_t runtime, std::string_view text);
  breve_object draw_object(const breve_world* world, const char* class_name);

  Choices choices_;
  const ClassLibrary& library_ = ClassLibrary::get();
  Demand nothing_demanded_;
  Demand* demand_ = &nothing_demanded_;
  std::size_t depth_ = 0;
  std::size_t allocations_until_failure_ = 0;  // 0: none fails

  std::deque<Ledger> ledgers_;
  std::size_t first_destroyed_ = 0;  // how the end goes
  bool backwards_ = false;
  std::array<breve_runtime*, 2> runtimes_{};
  std::vector<breve_program*> programs_;
  std::vector<breve_world*> worlds_;
  std::vector<breve_world*> speakers_;  // of callbacks that are being made; some are not created yet
  std::vector<breve_analysis*> analyses_;
  std::vector<breve_object> objects_;
  std::vector<breve_value> values_;
  std::vector<PreparedSelector> selectors_;
  std::vector<std::string> images_;
  std::string class_name_;
};

inline constexpr unsigned char kPattern = 0xa5;

/// Room for a result, or rarely NULL. It is filled with a pattern, which must still be there after an error.
template <class T>
class Out {
 public:
  explicit Out(Caller& caller, bool optional = false) : null_(caller.chance(optional ? 30 : 3)) {
    std::memset(static_cast<void*>(&value_), kPattern, sizeof value_);
    std::memcpy(&before_, &value_, sizeof value_);
    if (null_ && !optional) caller.expect_refusal();
  }
  T* to() { return null_ ? nullptr : &value_; }
  /// Of structs whose size is an argument: everything beyond it must stay, whatever the status is.
  void set_size(std::size_t size) {
    value_.struct_size = size;
    std::memcpy(&before_, &value_, sizeof value_);
    sized_ = true;
  }
  breve_status after(breve_status status) {
    filled_ = status == BREVE_OK && !null_;
    std::size_t from = filled_ ? sizeof value_ : 0;
    if constexpr (requires { value_.struct_size; })
      if (filled_ && sized_) from = std::min(before_.struct_size, sizeof value_);
    require(std::memcmp(bytes(value_) + from, bytes(before_) + from, sizeof value_ - from) == 0,
            "a result was written in spite of an error, or beyond its struct_size");
    return status;
  }
  explicit operator bool() const { return filled_; }
  const T& operator*() const { return value_; }
  const T* operator->() const { return &value_; }

 private:
  static const char* bytes(const T& of) { return reinterpret_cast<const char*>(&of); }
  T value_, before_;
  bool null_, filled_ = false, sized_ = false;
};

/// Room for several results, of a capacity that is often too small.
template <class T>
class Room {
 public:
  Room(Caller& caller, std::size_t capacity, std::size_t per_item = 1)
      : capacity_(capacity), items_(capacity * per_item), before_(items_) {
    if (!items_.empty()) {
      std::memset(static_cast<void*>(items_.data()), kPattern, items_.size() * sizeof(T));
      before_ = items_;
      if ((null_ = caller.chance(3))) caller.expect_refusal();
    }
  }
  T* to() { return null_ || items_.empty() ? nullptr : items_.data(); }
  std::size_t capacity() const { return capacity_; }
  breve_status after(breve_status status, std::size_t written) {
    written_ = status == BREVE_OK && !null_ ? std::min(written, items_.size()) : 0;
    const std::size_t rest = items_.size() - written_;
    require(rest == 0 || std::memcmp(items_.data() + written_, before_.data() + written_, rest * sizeof(T)) == 0,
            "results were written in spite of an error, or beyond their count");
    return status;
  }
  std::span<const T> written() const { return {items_.data(), written_}; }

 private:
  std::size_t capacity_;
  std::vector<T> items_, before_;
  std::size_t written_ = 0;
  bool null_ = false;
};

template <std::size_t N>
const double* Caller::numbers(double (&to)[N], bool optional) {
  for (double& x : to) x = chance(92) ? finite() : number();
  if (!chance(optional ? 30 : 3)) return to;
  if (!optional) expect_refusal();
  return nullptr;
}

}  // namespace breve::fuzz
