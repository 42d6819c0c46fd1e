// Natives that write objects to XML files and read them back.
#include "steve/library/archive.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

/// Run `work`; a failure that is about the archive is a warning with the file's name, not the end of the run.
template <class Work>
bool try_archive(Machine& machine, std::string_view what, Work work) {
  try {
    work();
    return true;
  } catch (const Error& error) {
    const ErrorCode code = error.code();
    if (code != ErrorCode::File && code != ErrorCode::Argument && code != ErrorCode::Image) throw;
    machine.warn(std::string(what) + ": " + error.what());
    return false;
  }
}

std::int32_t save(Machine& machine, Instance& self, Text file) {
  const std::string name(view(file));
  const bool done = try_archive(machine, "archive '" + name + "' not written",
                                [&] { write_file(machine, name, to_archive(machine, self)); });
  return done ? 0 : -1;
}

Text archive_as_xml_string(Machine& machine, Instance& self) {
  std::string xml;
  try_archive(machine, "no archive", [&] { xml = to_archive(machine, self); });
  return machine.heap().string(xml);
}

Instance* dearchive_xml(Machine& machine, Instance&, Text file) {
  const std::string name(view(file));
  Instance* object = nullptr;
  try_archive(machine, "archive '" + name + "' not read",
              [&] { object = from_archive(machine, read_file(machine, name), Origin::File); });
  return object;
}

Instance* parse_request(Machine& machine, Instance&, Text xml) {
  constexpr std::uint64_t kOfRequest = 128;  // iterations: one that is refused at once takes as long
  machine.charge(kOfRequest);
  Instance* object = nullptr;
  try_archive(machine, "request not understood", [&] { object = from_archive(machine, view(xml), Origin::Network); });
  return object;
}

std::int32_t data_load(Machine& machine, Instance& self, Text file) {
  const std::string name(view(file));
  const bool done = try_archive(machine, "archive '" + name + "' not read",
                                [&] { variables_from_archive(machine, read_file(machine, name), self); });
  return done ? 0 : -1;
}

constexpr Native kArchiveNatives[] = {
    native<save>("object.archive-as-xml", Reach::Writes),
    native<archive_as_xml_string>("object.archive-as-xml-string"),
    native<dearchive_xml>("control.dearchive-xml", Reach::Reads),
    native<parse_request>("control.parse-xml-network-request"),
    native<save>("data.save-to", Reach::Writes),
    native<save>("data.save-as-xml", Reach::Writes),
    native<data_load>("data.load-from", Reach::Reads),
    native<data_load>("data.load-from-xml", Reach::Reads),
};

}  // namespace

std::span<const Native> archive_natives() { return kArchiveNatives; }

}  // namespace breve::steve
