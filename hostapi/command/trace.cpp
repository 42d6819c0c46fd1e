// The trace file. Times are microseconds; one process, one thread: a world is one.
#include "trace.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

namespace breve::command {

namespace {

constexpr std::string_view kTail = "\n]}\n";
constexpr std::size_t kChunk = 1 << 16;  // bytes between two flushes

std::string json_text(const std::string& text) {
  auto quoted = nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return quoted.substr(1, quoted.size() - 2);
}

const char* category(std::uint32_t kind) {
  switch (kind) {
    case BREVE_PROFILE_WORLD:
    case BREVE_PROFILE_STAGE: return "stage";
    case BREVE_PROFILE_METHOD: return "method";
    case BREVE_PROFILE_NATIVE: return "native";
    case BREVE_PROFILE_FUNCTION: return "function";
    case BREVE_PROFILE_ACT: return "act";
  }
  return "other";
}

}  // namespace

TraceWriter::TraceWriter(const std::string& path, const std::string& program, std::uint64_t limit)
    : path_(path), file_(std::fopen(path.c_str(), "w")), limit_(limit) {
  if (!file_) throw std::runtime_error("cannot write " + path + ": " + std::strerror(errno));
  can_seek_ = std::fseek(file_.get(), 0, SEEK_CUR) == 0;
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // buffer_ is one
  const std::string name = json_text(program);
  buffer_ = fmt::format(
      "{{\"displayTimeUnit\":\"ms\",\"otherData\":{{\"program\":\"{0}\",\"library\":\"breve {1}\"}},\"traceEvents\":[\n"
      "{{\"name\":\"process_name\",\"ph\":\"M\",\"ts\":0,\"pid\":1,\"tid\":1,\"args\":{{\"name\":\"breve run "
      "{0}\"}}}},\n"
      "{{\"name\":\"thread_name\",\"ph\":\"M\",\"ts\":0,\"pid\":1,\"tid\":1,\"args\":{{\"name\":\"world\"}}}}",
      name, breve_version());
  flush();
}

TraceWriter::~TraceWriter() {
  if (!file_) return;
  try {
    close();
  } catch (const std::exception&) {
    file_.reset();
  }
}

const std::string* TraceWriter::escaped(const char* text) {
  const auto [at, fresh] = escaped_.try_emplace(text);
  if (fresh) at->second = json_text(text);
  return &at->second;
}

void TraceWriter::add(const breve_trace_event& event) {
  if (event.begins) {
    const bool room = size_ + buffer_.size() < limit_;
    if (!room && left_out_++ == 0) cut_at_iteration_ = event.iteration;
    open_.push_back({event.seconds, event.kind, escaped(event.class_name), escaped(event.name), escaped(event.file),
                     event.line, event.call_line, event.iteration, room});
    return;
  }
  if (open_.empty()) return;
  const Open call = open_.back();
  open_.pop_back();
  if (!call.written) return;
  write(call, event.seconds);
  if (buffer_.size() >= kChunk) flush();
}

void TraceWriter::write(const Open& call, double end) {
  const bool method = call.kind == BREVE_PROFILE_METHOD || call.kind == BREVE_PROFILE_NATIVE;
  auto out = std::back_inserter(buffer_);
  fmt::format_to(
      out, ",\n{{\"name\":\"{}{}{}\",\"cat\":\"{}\",\"ph\":\"X\",\"ts\":{:.3f},\"dur\":{:.3f},\"pid\":1,\"tid\":1",
      method ? *call.class_name : *call.name,
      call.class_name->empty() ? ""
      : method                 ? "."
                               : " ",
      call.class_name->empty() ? *call.class_name
      : method                 ? *call.name
                               : *call.class_name,
      category(call.kind), call.begin * 1e6, (end - call.begin) * 1e6);
  std::string_view before = ",\"args\":{";
  const auto argument = [&](std::string_view key, const std::string& file, std::uint32_t line) {
    fmt::format_to(out, "{}\"{}\":\"{}:{}\"", before, key, file, line);
    before = ",";
  };
  if (method) argument("declared", *call.file, call.line);
  if (call.call_line != 0) {
    // The line is in the file of the method around it.
    for (auto caller = open_.rbegin(); caller != open_.rend(); ++caller) {
      if (caller->file->empty()) continue;
      argument("called", *caller->file, call.call_line);
      break;
    }
  }
  if (open_.empty()) {
    fmt::format_to(out, "{}\"iteration\":{}", before, call.iteration);
    before = ",";
  }
  buffer_ += before == "," ? "}}" : "}";
}

void TraceWriter::flush() {
  size_ += buffer_.size();
  // What ends the file is written each time, and written over the next: on a pipe it comes once. Both in one go: a kill
  // between them would leave a file without an end.
  if (can_seek_) buffer_ += kTail;
  if (std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) != buffer_.size()) failed_ = true;
  if (can_seek_ && std::fseek(file_.get(), -static_cast<long>(kTail.size()), SEEK_CUR) != 0) failed_ = true;
  buffer_.clear();
}

void TraceWriter::close() {
  if (!file_) return;
  flush();
  if (std::fwrite(kTail.data(), 1, kTail.size(), file_.get()) != kTail.size()) failed_ = true;
  if (std::fclose(file_.release()) != 0) failed_ = true;
  if (failed_) throw std::runtime_error("cannot write all of " + path_);
}

}  // namespace breve::command
