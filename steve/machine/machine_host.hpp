// The door between a machine and whoever embeds it.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/base/ids.hpp"
#include "steve/code/foreign.hpp"
#include "steve/machine/files.hpp"
#include "steve/machine/network.hpp"
#include "steve/machine/value.hpp"

namespace breve::steve {

/// A picture of a world, valid until the next one is drawn.
struct DrawnView {
  int width = 0, height = 0;
  std::span<const std::uint8_t> rgba;  // rows from the top, 4 bytes a pixel
  std::span<const float> depth;        // of each pixel, length units along the line of sight; infinite where nothing is
};

/// A rectangle of the view, in pixels from its upper left corner. Without a size: all of it.
struct ViewPart {
  int left = 0, top = 0, width = 0, height = 0;
};

/// What a machine needs from whoever embeds it. Every member may be empty.
struct MachineHost {
  std::function<void(std::string_view text)> print;  // what scripts print, as written
  std::function<void(std::string_view text)> warn;   // one warning, one or more whole lines
  std::function<void(std::string_view text)> error;  // a run-time error that did not stop the run
  // Open a file; null with a reason, or without one if there is none.
  std::function<std::unique_ptr<FileReader>(std::string_view name, std::string& why)> open_for_reading;
  std::function<std::unique_ptr<FileWriter>(std::string_view name, bool append, std::string& why)> open_for_writing;
  std::function<std::string(std::string_view command)> system;  // run a shell command; empty: not allowed
  // The view as it is now, whose pixels outside of the part are undefined; empty: nothing can be drawn.
  std::function<const DrawnView&(const ViewPart& part)> draw;
  std::shared_ptr<Network> network;  // null: there is none
  // One of the functions that the program was compiled with; not empty if there are any. `self` is the calling
  // instance.
  std::function<Value(const ForeignFunction& function, Instance& self, std::span<const Value> arguments)> call_foreign;
  // Where the foreign method stands that is active at this depth of calls, innermost first; empty if that is not known.
  std::function<std::vector<ForeignPlace>(std::size_t depth)> places;
  std::function<void(ObjectId object)> gone;  // an object is being forgotten; runs nothing
  // A number that comes from outside is on its way to a script: it may be noted, or replaced by one of an earlier run.
  std::function<void(void* bytes, std::size_t size)> from_outside;
  std::function<bool()> replays;  // an earlier run is repeated: there is nothing to wait for
  bool may_sleep = false, may_read_clock = false, may_draw_entropy = false;
  std::vector<std::string> arguments;  // [0] is the program file
  std::chrono::steady_clock::time_point started = std::chrono::steady_clock::now();
  std::uint64_t seed = 1;  // that the world was made with
  bool verbose = false;    // say once when an obsolete selector is used
  bool strict = false;
  std::uint32_t depth_limit = 5000;  // nested calls
  std::uint64_t budget = 0;          // loop iterations and calls in a step or a call from the host; 0 = none
  std::uint64_t call_budget = 0;     // in one call by the world, within an iteration; 0 = none
  std::uint64_t physics_budget = 0;  // units of work of an iteration's physics; 0 = none
  // s of real time that an iteration or a call from the host may take before it is warned of; 0 = any
  double patience = 0;
  std::vector<std::pair<std::string, std::string>> settings;  // variables of the controller, set before its init
};

}  // namespace breve::steve
