// XML text as a tree of pugixml. Its own parser takes a text in one piece, however long it is and however deeply it
// nests; with expat in front of it, reading can be interrupted, and what nests too deeply is refused.
#pragma once

#include <pugixml.hpp>
#include <string_view>

#include "runtime/base/poll.hpp"

namespace breve::steve {

/// Appends the elements and texts of `xml` (UTF-8) to `document`. Comments, processing instructions and a document type
/// without declarations are skipped; texts of white space alone are kept. A tag is at most 4 MB long.
/// @param most_depth  of elements within each other
/// @param poll        is called for every few tens of kilobytes, and may throw
/// @throws Error{File} if `xml` is not well-formed, with the position, or nests too deeply
void parse_xml(std::string_view xml, int most_depth, const Poll& poll, pugi::xml_document& document);

}  // namespace breve::steve
