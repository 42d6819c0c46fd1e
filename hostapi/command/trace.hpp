// A run as a trace in Chrome's format, written while it happens: https://ui.perfetto.dev and chrome://tracing show it.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "breve/breve.h"

namespace breve::command {

/// Writes one complete event ("X") for each call, when it ends. The file is valid JSON after every flush, so that a run
/// that is killed leaves what it had.
class TraceWriter {
 public:
  /// @param limit  bytes; calls that begin after the file has grown to it are left out
  /// @throws std::runtime_error if the file cannot be written
  TraceWriter(const std::string& path, const std::string& program, std::uint64_t limit);
  ~TraceWriter();
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;

  static void receive(void* user, const breve_trace_event* event) { static_cast<TraceWriter*>(user)->add(*event); }
  /// Write what is left. @throws std::runtime_error if something could not be written
  void close();
  std::uint64_t left_out() const { return left_out_; }                  // calls, for the limit
  std::uint64_t cut_at_iteration() const { return cut_at_iteration_; }  // when the first one was

 private:
  struct Open {
    double begin = 0;        // s
    std::uint32_t kind = 0;  // breve_profile_kind
    const std::string* class_name = nullptr;
    const std::string* name = nullptr;
    const std::string* file = nullptr;
    std::uint32_t line = 0, call_line = 0;
    std::uint64_t iteration = 0;
    bool written = true;
  };
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void add(const breve_trace_event& event);
  void write(const Open& call, double end);
  void flush();
  const std::string* escaped(const char* text);

  std::string path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  bool can_seek_ = false, failed_ = false;
  std::string buffer_;
  std::uint64_t size_ = 0, limit_, left_out_ = 0, cut_at_iteration_ = 0;
  std::vector<Open> open_;
  std::unordered_map<const char*, std::string> escaped_;  // texts live as long as the profile: their address is a name
};

}  // namespace breve::command
