// Files below directories that a host names, and no others. A path is walked one folder at a time from the open
// directory, so that nobody who renames or links on the way leads it elsewhere.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

#include "internal.hpp"

namespace breve::host {

namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{256} << 20;

/// A file descriptor of this object alone.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  int get() const { return number_; }
  bool good() const { return number_ >= 0; }
  bool close() { return number_ < 0 || ::close(std::exchange(number_, -1)) == 0; }

 private:
  int number_;
};

/// Why a file is not opened; "" if there is none of that name.
struct Refusal {
  std::string why;
};

[[noreturn]] void refuse(const std::string& why) { throw Refusal{why}; }

[[noreturn]] void refuse_by_errno() {
  if (errno == ENOENT || errno == ENOTDIR) throw Refusal{};
  if (errno == ELOOP) refuse("symbolic links are not followed");
  refuse(std::strerror(errno));
}

struct Root {
  Descriptor directory;
  bool may_write;
  std::uint64_t most_bytes;
};

/// The folder of a file, and its name there.
struct Spot {
  Descriptor folder;
  std::string name;
};

Spot find_spot(const Root& root, std::string_view path) {
  if (path.empty()) throw Refusal{};
  if (path.front() == '/') refuse("absolute paths are not allowed");
  Spot spot{Descriptor(::fcntl(root.directory.get(), F_DUPFD_CLOEXEC, 0)), {}};
  if (!spot.folder.good()) refuse_by_errno();
  while (true) {
    const std::size_t slash = path.find('/');
    const std::string part(path.substr(0, slash));
    if (part == "..") refuse("'..' is not allowed");
    const bool last = slash == std::string_view::npos;
    if (last) {
      if (part.empty() || part == ".") refuse("it is a directory");
      spot.name = part;
      return spot;
    }
    path.remove_prefix(slash + 1);
    if (part.empty() || part == ".") continue;
    Descriptor next(::openat(spot.folder.get(), part.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    if (!next.good()) {
      // Without it O_DIRECTORY says of a link what it says of a file.
      struct stat info {};
      const int reason = errno;
      if (::fstatat(spot.folder.get(), part.c_str(), &info, AT_SYMLINK_NOFOLLOW) == 0 && S_ISLNK(info.st_mode))
        refuse("symbolic links are not followed");
      errno = reason;
      refuse_by_errno();
    }
    spot.folder = std::move(next);
  }
}

/// The opened file must be a regular file of an allowed size.
std::uint64_t need_plain(const Descriptor& file, const Root& root) {
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) refuse_by_errno();
  if (S_ISDIR(info.st_mode)) refuse("it is a directory");
  if (!S_ISREG(info.st_mode)) refuse("it is not a regular file");
  const auto size = static_cast<std::uint64_t>(info.st_size);
  if (size > root.most_bytes) refuse(fmt::format("it is larger than {} bytes", root.most_bytes));
  return size;
}

/// A file that is read from its start, or written to its end.
class PlainFile {
 public:
  PlainFile(Spot spot, Descriptor file, std::uint64_t size, std::uint64_t most)
      : spot_(std::move(spot)), file_(std::move(file)), size_(size), most_(most) {}
  ~PlainFile() {
    if (!temporary_.empty()) ::unlinkat(spot_.folder.get(), temporary_.c_str(), 0);
  }
  PlainFile(const PlainFile&) = delete;
  PlainFile& operator=(const PlainFile&) = delete;

  /// Begins a new file beside the one that it will replace. Several threads may write that one at once, each to its
  /// own.
  void create_temporary() {
    constexpr int kHow = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kMost = 1000;
    for (int i = 1;; ++i) {
      std::string name = fmt::format(".{}.{}.{}.part", spot_.name.substr(0, 100), ::getpid(), i);
      file_ = Descriptor(::openat(spot_.folder.get(), name.c_str(), kHow, 0666));
      if (file_.good()) {
        temporary_ = std::move(name);
        return;
      }
      if (errno != EEXIST || i == kMost) refuse_by_errno();
    }
  }

  bool read(void* bytes, std::size_t size, std::size_t& got) {
    // A file may grow while it is read.
    const std::size_t wanted = static_cast<std::size_t>(std::min<std::uint64_t>(size, most_ - std::min(most_, done_)));
    ssize_t count;
    do count = ::read(file_.get(), bytes, wanted);
    while (count < 0 && errno == EINTR);
    if (count < 0) return false;
    got = static_cast<std::size_t>(count);
    done_ += got;
    return true;
  }

  bool write(const char* bytes, std::size_t size) {
    if (size > most_ - std::min(most_, size_)) return false;
    while (size > 0) {
      const ssize_t count = ::write(file_.get(), bytes, size);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      bytes += count;
      size -= static_cast<std::size_t>(count);
      size_ += static_cast<std::uint64_t>(count);
    }
    return true;
  }

  /// The written file gets its name.
  bool close(bool keep) {
    if (!file_.close()) return false;
    if (temporary_.empty()) return true;
    if (!keep || ::renameat(spot_.folder.get(), temporary_.c_str(), spot_.folder.get(), spot_.name.c_str()) != 0)
      return false;
    temporary_.clear();
    return true;
  }

 private:
  Spot spot_;
  Descriptor file_;
  std::string temporary_;  // its name until it is closed; "": it has its own
  std::uint64_t size_, most_, done_ = 0;
};

std::unique_ptr<PlainFile> open_to_read(const Root& root, std::string_view path) {
  Spot spot = find_spot(root, path);
  // Without O_NONBLOCK a pipe would be waited for.
  Descriptor file(::openat(spot.folder.get(), spot.name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (!file.good()) refuse_by_errno();
  const std::uint64_t size = need_plain(file, root);
  return std::make_unique<PlainFile>(std::move(spot), std::move(file), size, root.most_bytes);
}

std::unique_ptr<PlainFile> open_to_append(const Root& root, Spot spot) {
  constexpr int kHow = O_WRONLY | O_APPEND | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
  Descriptor file(::openat(spot.folder.get(), spot.name.c_str(), kHow, 0666));
  if (!file.good()) refuse_by_errno();
  const std::uint64_t size = need_plain(file, root);
  return std::make_unique<PlainFile>(std::move(spot), std::move(file), size, root.most_bytes);
}

std::unique_ptr<PlainFile> open_to_write(const Root& root, std::string_view path, bool append) {
  Spot spot = find_spot(root, path);
  if (append) return open_to_append(root, std::move(spot));
  struct stat info {};
  if (::fstatat(spot.folder.get(), spot.name.c_str(), &info, AT_SYMLINK_NOFOLLOW) == 0 && !S_ISREG(info.st_mode))
    refuse(S_ISLNK(info.st_mode) ? "symbolic links are not followed" : "it is not a regular file");
  // It exists before its file does, so that no failure can leave that behind.
  auto written = std::make_unique<PlainFile>(std::move(spot), Descriptor(-1), 0, root.most_bytes);
  written->create_temporary();
  return written;
}

/// The roots of a breve_files, in their order.
struct Roots {
  std::vector<Root> roots;
  std::atomic<int> owners = 1;
};

/// The first root that has the file; the first reason of those that refuse it. Nothing is thrown into the host.
template <class Open>
bool open_in(Roots& roots, breve_file* file, breve_write_fn reason, void* sink, Open open) {
  std::string why;
  try {
    for (const Root& root : roots.roots) {
      try {
        file->handle = open(root).release();
        file->close = [](void* handle, bool keep) {
          const std::unique_ptr<PlainFile> closed(static_cast<PlainFile*>(handle));
          return closed->close(keep);
        };
        return true;
      } catch (const Refusal& refusal) {
        if (why.empty()) why = refusal.why;
      }
    }
    if (!why.empty()) reason(sink, why.data(), why.size());
  } catch (const std::bad_alloc&) {
    reason(sink, kNoMemory.data(), kNoMemory.size());
  }
  return false;
}

bool open_for_reading(void* user, breve_world*, const char* name, breve_file* file, breve_write_fn reason, void* sink) {
  file->read = [](void* handle, void* bytes, std::size_t size, std::size_t* got) {
    return static_cast<PlainFile*>(handle)->read(bytes, size, *got);
  };
  return open_in(*static_cast<Roots*>(user), file, reason, sink,
                 [name](const Root& root) { return open_to_read(root, name); });
}

bool open_for_writing(void* user, breve_world*, const char* name, bool append, breve_file* file, breve_write_fn reason,
                      void* sink) {
  file->write = [](void* handle, const void* bytes, std::size_t size) {
    return static_cast<PlainFile*>(handle)->write(static_cast<const char*>(bytes), size);
  };
  return open_in(*static_cast<Roots*>(user), file, reason, sink, [&](const Root& root) {
    if (!root.may_write) refuse("nothing may be written there");
    return open_to_write(root, name, append);
  });
}

void retain(void* user) { ++static_cast<Roots*>(user)->owners; }
void release(void* user) {
  auto* roots = static_cast<Roots*>(user);
  if (--roots->owners == 0) delete roots;
}

}  // namespace

}  // namespace breve::host

using namespace breve::host;

breve_status breve_files_add_directory(const char* directory, bool may_write, uint64_t most_bytes, breve_files* files) {
  return guard([&] {
    need(directory, "directory");
    need(files, "files");
    const bool fresh = !files->open_for_reading && !files->open_for_writing;
    if (!fresh && files->open_for_reading != &open_for_reading)
      fail(BREVE_ERROR_ARGUMENT, "the files have callbacks of the host's own");
    Descriptor opened(::open(directory, O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!opened.good())
      fail(BREVE_ERROR_FILE, fmt::format("cannot open directory '{}': {}", directory, std::strerror(errno)));
    Root root{std::move(opened), may_write, most_bytes == 0 ? kMostBytes : most_bytes};
    if (!fresh) {
      static_cast<Roots*>(files->user)->roots.push_back(std::move(root));
      return;
    }
    auto roots = std::make_unique<Roots>();
    roots->roots.push_back(std::move(root));
    *files = {roots.release(), &open_for_reading, &open_for_writing, &retain, &release};
  });
}

breve_status breve_files_release(breve_files* files) {
  if (!files) return BREVE_OK;
  if (files->release) files->release(files->user);
  *files = {};
  return BREVE_OK;
}
