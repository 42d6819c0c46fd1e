// Natives that write objects to XML and read them back.
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

[[noreturn]] void later(std::string_view selector) {
  Machine::fail(RunErrorKind::World, std::string(selector) + ": archives are part of a later version");
}

std::int32_t archive_as_xml(Machine&, Instance&, Text) { later("archive-as-xml"); }
Text archive_as_xml_string(Machine&, Instance&) { later("archive-as-xml-string"); }
Instance* dearchive_xml(Machine&, Instance&, Text) { later("dearchive-xml"); }
Instance* parse_request(Machine&, Instance&, Text) { later("parse-xml-network-request"); }
std::int32_t data_save(Machine&, Instance&, Text) { later("save-to"); }
std::int32_t data_load(Machine&, Instance&, Text) { later("load-from"); }

constexpr Native kArchiveNatives[] = {
    native<archive_as_xml>("object.archive-as-xml"),
    native<archive_as_xml_string>("object.archive-as-xml-string"),
    native<dearchive_xml>("control.dearchive-xml"),
    native<parse_request>("control.parse-xml-network-request"),
    native<data_save>("data.save-to"),
    native<data_save>("data.save-as-xml"),
    native<data_load>("data.load-from"),
    native<data_load>("data.load-from-xml"),
};

}  // namespace

std::span<const Native> archive_natives() { return kArchiveNatives; }

}  // namespace breve::steve
