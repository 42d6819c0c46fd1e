// Files that change under a running program.
#include "watch.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>

namespace breve::command {

namespace {
constexpr auto kEvery = std::chrono::milliseconds(100);
}

Watch::Stamp Watch::look_at(const std::string& path) {
  struct stat info {};
  Stamp stamp;
  if (::stat(path.c_str(), &info) != 0) return stamp;
  stamp.seconds = info.st_mtim.tv_sec;
  stamp.nanoseconds = info.st_mtim.tv_nsec;
  stamp.size = static_cast<std::uint64_t>(info.st_size);
  stamp.inode = info.st_ino;
  stamp.exists = true;
  return stamp;
}

void Watch::files(const std::vector<std::string>& paths) {
  known_.clear();
  for (const auto& path : paths) known_[path] = look_at(path);
  seen_ = known_;
}

bool Watch::changed() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return false;
  next_ = now + kEvery;
  bool moving = false;
  for (auto& [path, stamp] : seen_) {
    const Stamp current = look_at(path);
    // Half-written still, or between its end and the new one's beginning: wait until two looks agree.
    moving = moving || current != stamp || !current.exists;
    stamp = current;
  }
  if (moving || seen_ == known_) return false;
  known_ = seen_;
  return true;
}

Reloader::Reloader(Session& session, Output& output, std::string file)
    : session_(session), output_(output), file_(std::move(file)) {
  watch_.files(session_.files());
}

bool Reloader::look(breve_world* world) { return watch_.changed() && reload(world); }

bool Reloader::reload(breve_world* world) {
  constexpr const char* kGoesOn = "the previous version keeps running";
  ProgramHandle program;
  auto before = session_.files();
  const ExitStatus status = session_.load_again(file_, program);
  auto files = session_.files();
  if (status != kEndedWell) {
    // The files of the running program are also watched: the mistake may be there.
    for (auto& path : before)
      if (std::find(files.begin(), files.end(), path) == files.end()) files.push_back(path);
    output_.complain(fmt::format("breve: {} is not reloaded: {}\n", file_, kGoesOn));
  }
  watch_.files(files);
  if (status != kEndedWell) return false;
  if (breve_world_reload(world, program.get()) != BREVE_OK) {
    const breve_error* error = breve_world_last_error(world);
    output_.complain(fmt::format("breve: {} is not reloaded: {}\nbreve: {}\n", file_,
                                 error ? error->message : "an unknown error", kGoesOn));
    return false;
  }
  output_.complain(fmt::format("breve: {} reloaded, {} {}, at {:.2f} s\n", file_, files.size(),
                               files.size() == 1 ? "file" : "files", breve_world_time(world)));
  return true;
}

}  // namespace breve::command
