// Files that the host's callbacks open, as the machine reads and writes them.
#include <fmt/format.h>

#include "internal.hpp"

namespace breve::host {

namespace {

[[noreturn]] void fail_at(const char* verb, const std::string& name) {
  throw Error(ErrorCode::File, fmt::format("cannot {} file '{}': opening it succeeded, but this failed", verb, name));
}

/// Closes the file once.
class OpenFile {
 public:
  OpenFile(const breve_file& file, std::string name) noexcept : file_(file), name_(std::move(name)) {}
  OpenFile(OpenFile&& other) noexcept : file_(std::exchange(other.file_, {})), name_(std::move(other.name_)) {}
  ~OpenFile() { close(); }
  OpenFile& operator=(OpenFile&&) = delete;

  const breve_file& functions() const { return file_; }
  const std::string& name() const { return name_; }
  void spoil() { keep_ = false; }
  bool close() {
    const auto close = std::exchange(file_.close, nullptr);
    return !close || close(file_.handle, keep_);
  }

 private:
  breve_file file_;
  std::string name_;
  bool keep_ = true;
};

class HostReader final : public steve::FileReader {
 public:
  explicit HostReader(OpenFile file) : file_(std::move(file)), path_(file_.name()) {
    if (file_.functions().path) path_ = file_.functions().path;
  }
  static bool fits(const breve_file& file) { return file.read; }
  std::size_t read(char* bytes, std::size_t size) override {
    std::size_t got = 0;
    if (!file_.functions().read(file_.functions().handle, bytes, size, &got) || got > size)
      fail_at("read", file_.name());
    return got;
  }
  const std::string& path() const override { return path_; }

 private:
  OpenFile file_;
  std::string path_;
};

class HostWriter final : public steve::FileWriter {
 public:
  explicit HostWriter(OpenFile file) : file_(std::move(file)) {}
  static bool fits(const breve_file& file) { return file.write; }
  void write(std::string_view bytes) override {
    if (bytes.empty() || file_.functions().write(file_.functions().handle, bytes.data(), bytes.size())) return;
    file_.spoil();
    fail_at("write", file_.name());
  }
  void close() override {
    if (!file_.close()) fail_at("close", file_.name());
  }

 private:
  OpenFile file_;
};

/// Asks the host. @param open  of the name, the file and the reason's two arguments
template <class Wrapper, class Open>
std::unique_ptr<Wrapper> ask(breve_world& world, std::string_view name, std::string& why, Open open) {
  std::string asked(name);
  Answer answer;
  breve_file file{};
  const bool opened = [&] {
    const CallbackScope busy(world);
    return open(asked.c_str(), &file, &Answer::add, &answer);
  }();
  if (!opened) {
    why = answer.text();
    if (why == kNoMemory) throw std::bad_alloc();
    return nullptr;
  }
  OpenFile whole(file, std::move(asked));
  if (Wrapper::fits(file)) return std::make_unique<Wrapper>(std::move(whole));
  why = "the host opened it without the required function";
  return nullptr;
}

}  // namespace

void open_files(breve_world& world, steve::MachineHost& host) {
  const breve_files& files = world.runtime->config.files;
  if (files.open_for_reading)
    host.open_for_reading = [&world, &files](std::string_view name, std::string& why) {
      return ask<HostReader>(world, name, why,
                             [&](const char* asked, breve_file* file, breve_write_fn reason, void* sink) {
                               return files.open_for_reading(files.user, &world, asked, file, reason, sink);
                             });
    };
  if (files.open_for_writing)
    host.open_for_writing = [&world, &files](std::string_view name, bool append, std::string& why) {
      return ask<HostWriter>(world, name, why,
                             [&](const char* asked, breve_file* file, breve_write_fn reason, void* sink) {
                               return files.open_for_writing(files.user, &world, asked, append, file, reason, sink);
                             });
    };
}

}  // namespace breve::host
