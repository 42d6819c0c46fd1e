// Every file that a script uses is opened here, by whoever embeds the machine.
#include "steve/machine/files.hpp"

#include <fmt/format.h>

#include <array>

#include "steve/machine/machine.hpp"

namespace breve::steve {

namespace {

[[noreturn]] void refuse(const char* verb, std::string_view name, std::string_view why) {
  throw Error(ErrorCode::File, fmt::format("cannot {} file '{}': {}", verb, name, why));
}

void check_name(const char* verb, std::string_view name) {
  if (name.empty()) refuse(verb, name, "the name is empty");
  if (const auto zero = name.find('\0'); zero != std::string_view::npos)
    refuse(verb, name.substr(0, zero), "the name contains a zero byte");
}

constexpr std::uint64_t kOfOpening = 4000;  // iterations: what operating systems take for it

}  // namespace

std::unique_ptr<FileReader> open_for_reading(Machine& machine, std::string_view name) {
  machine.charge(kOfOpening);  // before a refusal, which also takes longer than a loop iteration
  check_name("read", name);
  if (!machine.host().open_for_reading) refuse("read", name, "the host does not let scripts read files");
  std::string why;
  auto file = machine.host().open_for_reading(name, why);
  if (!file && why.empty()) throw MissingFile(fmt::format("cannot read file '{}': there is no such file", name));
  if (!file) refuse("read", name, why);
  return file;
}

std::unique_ptr<FileWriter> open_for_writing(Machine& machine, std::string_view name, bool append) {
  machine.charge(kOfOpening);
  check_name("write", name);
  if (!machine.host().open_for_writing) refuse("write", name, "the host does not let scripts write files");
  std::string why;
  auto file = machine.host().open_for_writing(name, append, why);
  if (!file) refuse("write", name, why.empty() ? "it cannot be opened" : why);
  return file;
}

std::pmr::string read_file(Machine& machine, std::string_view name) {
  const auto file = open_for_reading(machine, name);
  std::pmr::string bytes(machine.heap().memory());
  std::array<char, 65536> block;
  while (const std::size_t got = file->read(block.data(), block.size())) {
    if (bytes.size() + got > kMostFileBytes)
      refuse("read", name, fmt::format("it is larger than {} bytes", kMostFileBytes));
    machine.charge_for(got);
    bytes.append(block.data(), got);
  }
  return bytes;
}

void write_file(Machine& machine, std::string_view name, std::string_view bytes) {
  const auto file = open_for_writing(machine, name, false);
  file->write(bytes);
  file->close();
}

std::string find_file(Machine& machine, std::string_view name) {
  try {
    return open_for_reading(machine, name)->path();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::File) throw;
    return {};
  }
}

}  // namespace breve::steve
