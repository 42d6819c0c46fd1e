// Files that the host's callbacks open, as the machine reads and writes them.
#include <fmt/format.h>

#include "internal.hpp"

namespace breve::host {

namespace {

[[noreturn]] void fail_at(const char* verb, const std::string& name) {
  throw Error(ErrorCode::File, fmt::format("cannot {} file '{}': opening it succeeded, but this failed", verb, name));
}

/// How many files a world has open. The process has a bounded number, which other worlds and the host also need.
using OpenCount = std::shared_ptr<std::size_t>;
constexpr std::size_t kMostOpen = 100;

/// Closes the file once.
class OpenFile {
 public:
  OpenFile(const breve_file& file, std::string name, OpenCount count) noexcept
      : file_(file), name_(std::move(name)), count_(std::move(count)) {
    ++*count_;
  }
  OpenFile(OpenFile&& other) noexcept
      : file_(std::exchange(other.file_, {})), name_(std::move(other.name_)), count_(std::move(other.count_)) {}
  ~OpenFile() { close(); }
  OpenFile& operator=(OpenFile&&) = delete;

  const breve_file& functions() const { return file_; }
  const std::string& name() const { return name_; }
  void spoil() { keep_ = false; }
  bool close() {
    if (const OpenCount count = std::move(count_)) --*count;
    const auto close = std::exchange(file_.close, nullptr);
    return !close || close(file_.handle, keep_);
  }

 private:
  breve_file file_;
  std::string name_;
  OpenCount count_;  // null: it is closed
  bool keep_ = true;
};

class HostReader final : public steve::FileReader {
 public:
  HostReader(breve_world& world, OpenFile file) : world_(world), file_(std::move(file)), path_(file_.name()) {
    if (file_.functions().path) path_ = file_.functions().path;
  }
  /// One that gives what was recorded.
  HostReader(breve_world& world, OpenFile file, std::string_view path)
      : world_(world), file_(std::move(file)), path_(path) {}
  static bool fits(const breve_file& file) { return file.read; }
  std::size_t read(char* bytes, std::size_t size) override {
    Inputs* const inputs = world_.inputs;
    if (inputs && inputs->replaying()) return replay(*inputs, bytes, size);
    const auto function = file_.functions().read;
    std::size_t got = 0;
    if (!function || !function(file_.functions().handle, bytes, size, &got) || got > size) {
      if (inputs) inputs->add(Inputs::Kind::Failed, {});
      fail_at("read", file_.name());
    }
    if (inputs) inputs->add(Inputs::Kind::Read, {bytes, got});
    return got;
  }
  const std::string& path() const override { return path_; }

 private:
  std::size_t replay(Inputs& inputs, char* bytes, std::size_t size) {
    const auto recorded = inputs.next(Inputs::Kind::Read);
    if (!recorded || recorded->size() > size) fail_at("read", file_.name());
    return recorded->copy(bytes, size);
  }

  breve_world& world_;
  OpenFile file_;
  std::string path_;
};

class HostWriter final : public steve::FileWriter {
 public:
  HostWriter(breve_world& world, OpenFile file) : world_(world), file_(std::move(file)) {}
  /// One that fails where it failed when it was recorded, and writes nothing.
  HostWriter(breve_world& world, OpenFile file, std::string_view) : world_(world), file_(std::move(file)) {}
  static bool fits(const breve_file& file) { return file.write; }
  void write(std::string_view bytes) override {
    if (bytes.empty()) return;
    const auto function = file_.functions().write;
    if (passes([&] { return function && function(file_.functions().handle, bytes.data(), bytes.size()); })) return;
    file_.spoil();
    fail_at("write", file_.name());
  }
  void close() override {
    if (!passes([&] { return file_.close(); })) fail_at("close", file_.name());
  }

 private:
  /// Whether it succeeds, or did when it was recorded.
  template <class Work>
  bool passes(Work work) {
    Inputs* const inputs = world_.inputs;
    if (inputs && inputs->replaying()) return inputs->next(Inputs::Kind::Written).has_value();
    const bool succeeded = work();
    if (inputs) inputs->add(succeeded ? Inputs::Kind::Written : Inputs::Kind::Failed, {});
    return succeeded;
  }

  breve_world& world_;
  OpenFile file_;
};

/// Asks the host. @param open  of the name, the file and the reason's two arguments
template <class Wrapper, class Open>
std::unique_ptr<Wrapper> ask(breve_world& world, const OpenCount& count, std::string_view name, std::string& why,
                             Open open) {
  if (*count >= kMostOpen) {
    why = fmt::format("{} files are open, and a world may have no more: close those that are not needed", kMostOpen);
    return nullptr;
  }
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
  OpenFile whole(file, std::move(asked), count);
  if (Wrapper::fits(file)) return std::make_unique<Wrapper>(world, std::move(whole));
  why = "the host opened it without the required function";
  return nullptr;
}

/// The path that a reader gives scripts.
std::string path_of(const HostReader& file) { return file.path(); }
std::string path_of(const HostWriter&) { return {}; }

/// The same, recorded or replayed.
template <class Wrapper, class Open>
std::unique_ptr<Wrapper> ask_on_tape(breve_world& world, const OpenCount& count, std::string_view name,
                                     std::string& why, Open open) {
  using enum Inputs::Kind;
  Inputs* const inputs = world.inputs;
  if (!inputs) return ask<Wrapper>(world, count, name, why, open);
  if (!inputs->replaying()) {
    auto file = ask<Wrapper>(world, count, name, why, open);
    inputs->add(file ? Opened : NotOpened, file ? path_of(*file) : why);
    return file;
  }
  const bool refused = inputs->is_next(NotOpened);
  const auto recorded = inputs->next(refused ? NotOpened : Opened);
  if (recorded && !refused) return std::make_unique<Wrapper>(world, OpenFile({}, std::string(name), count), *recorded);
  why = recorded ? std::string(*recorded) : "it was not opened in the recorded run";
  return nullptr;
}

}  // namespace

void open_files(breve_world& world, steve::MachineHost& host) {
  const breve_files& files = world.runtime->config.files;
  const OpenCount count = std::make_shared<std::size_t>(0);
  if (files.open_for_reading)
    host.open_for_reading = [&world, &files, count](std::string_view name, std::string& why) {
      return ask_on_tape<HostReader>(world, count, name, why,
                                     [&](const char* asked, breve_file* file, breve_write_fn reason, void* sink) {
                                       return files.open_for_reading(files.user, &world, asked, file, reason, sink);
                                     });
    };
  if (files.open_for_writing)
    host.open_for_writing = [&world, &files, count](std::string_view name, bool append, std::string& why) {
      return ask_on_tape<HostWriter>(
          world, count, name, why, [&](const char* asked, breve_file* file, breve_write_fn reason, void* sink) {
            return files.open_for_writing(files.user, &world, asked, append, file, reason, sink);
          });
    };
}

}  // namespace breve::host
