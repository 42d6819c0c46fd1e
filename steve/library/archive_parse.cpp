// The grammar: a tree is built from left to right, with the open element as the only state.
#include "steve/library/archive_parse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string>

#include "runtime/base/error.hpp"

namespace breve::steve {

namespace {

constexpr std::size_t kPiece = 1 << 16;  // bytes between two polls
constexpr std::string_view kSpace = " \t\r\n";
constexpr std::string_view kEndsName = " \t\r\n=/>";

void append_utf8(std::string& text, unsigned code) {
  const auto put = [&](unsigned byte) { text += static_cast<char>(byte); };
  const auto tail = [&](int shift) { put(0x80 | ((code >> shift) & 0x3f)); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xc0 | (code >> 6)), tail(0);
  } else if (code < 0x10000) {
    put(0xe0 | (code >> 12)), tail(6), tail(0);
  } else {
    put(0xf0 | (code >> 18)), tail(12), tail(6), tail(0);
  }
}

/// Appends the sign that an entity stands for, given the text between '&' and ';'. Yields false if nobody knows it.
bool append_entity(std::string& text, std::string_view name) {
  constexpr std::pair<std::string_view, char> kNamed[] = {
      {"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}};
  for (const auto& [known, sign] : kNamed)
    if (name == known) return text += sign, true;
  if (!name.starts_with('#')) return false;
  const bool hex = name.starts_with("#x");
  const std::string_view digits = name.substr(hex ? 2 : 1);
  unsigned code = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code, hex ? 16 : 10);
  constexpr unsigned kLastCode = 0x10ffff;
  if (error != std::errc{} || end != digits.data() + digits.size() || code == 0 || code > kLastCode) return false;
  append_utf8(text, code);
  return true;
}

class XmlParser {
 public:
  XmlParser(std::string_view xml, int most_depth, const Poll& poll, pugi::xml_document& document)
      : xml_(xml), most_depth_(most_depth), poll_(poll), open_(document) {}

  void parse() {
    if (xml_.starts_with("\xef\xbb\xbf")) at_ = 3;  // of editors that mark their encoding
    while (at_ < xml_.size()) {
      if (xml_[at_] == '<')
        parse_markup();
      else
        parse_text();
    }
    if (depth_ != 0) refuse(fmt::format("<{}> has no end", open_.name()));
  }

 private:
  [[noreturn]] void refuse(std::string_view why) const {
    throw Error(ErrorCode::File, fmt::format("this is not XML: {} (byte {})", why, at_));
  }

  void advance(std::size_t bytes) {
    at_ += bytes;
    if (at_ - polled_ < kPiece) return;
    polled_ = at_;
    if (poll_) poll_();
  }

  bool next_is(std::string_view text) const { return xml_.substr(at_, text.size()) == text; }

  void skip_space() {
    while (at_ < xml_.size() && kSpace.find(xml_[at_]) != std::string_view::npos) advance(1);
  }

  /// Moves behind the next `end`, and yields what stands before it.
  std::string_view take_until(std::string_view end, std::string_view what) {
    const std::size_t from = at_;
    for (std::size_t piece = at_; piece < xml_.size(); piece += kPiece) {
      const std::size_t found = xml_.substr(piece, kPiece + end.size() - 1).find(end);
      if (found == std::string_view::npos) {
        if (poll_) poll_();
        continue;
      }
      advance(piece + found + end.size() - at_);
      return xml_.substr(from, piece + found - from);
    }
    refuse(fmt::format("{} has no end", what));
  }

  std::string_view take_name() {
    const std::size_t from = at_;
    constexpr std::size_t kLongest = 1000;  // bytes
    while (at_ < xml_.size() && kEndsName.find(xml_[at_]) == std::string_view::npos) {
      if (xml_[at_] == '<' || at_ - from > kLongest) break;
      advance(1);
    }
    if (at_ == from || at_ - from > kLongest) refuse("a name is missing");
    return xml_.substr(from, at_ - from);
  }

  void parse_markup() {
    if (next_is("<!--")) {
      advance(4);
      take_until("-->", "a comment");
    } else if (next_is("<![CDATA[")) {
      advance(9);
      if (depth_ == 0) refuse("a text stands outside of all elements");
      const std::string_view text = take_until("]]>", "a text");
      open_.append_child(pugi::node_cdata).set_value(text.data(), text.size());
    } else if (next_is("<!")) {
      if (take_until(">", "a document type").find('[') != std::string_view::npos)
        refuse("declarations in a document type are not read");
    } else if (next_is("<?")) {
      take_until("?>", "an instruction");
    } else if (next_is("</")) {
      parse_end();
    } else {
      parse_begin();
    }
  }

  void parse_end() {
    advance(2);
    if (depth_ == 0) refuse("an element ends that did not begin");
    if (take_name() != open_.name()) refuse(fmt::format("<{}> has no end", open_.name()));
    skip_space();
    if (!next_is(">")) refuse("'>' is missing");
    advance(1);
    open_ = open_.parent();
    --depth_;
  }

  void parse_begin() {
    if (depth_ == most_depth_) refuse("its elements are nested too deeply");
    advance(1);
    pugi::xml_node element = open_.append_child(pugi::node_element);
    text_ = take_name();
    element.set_name(text_.c_str());
    for (skip_space(); at_ < xml_.size() && xml_[at_] != '>' && xml_[at_] != '/'; skip_space())
      parse_attribute(element);
    const bool empty = next_is("/>");
    if (!empty && !next_is(">")) refuse("'>' is missing");
    advance(empty ? 2 : 1);
    if (empty) return;
    open_ = element;
    ++depth_;
  }

  void parse_attribute(pugi::xml_node element) {
    text_ = take_name();
    pugi::xml_attribute attribute = element.append_attribute(text_.c_str());
    skip_space();
    if (!next_is("=")) refuse("'=' is missing");
    advance(1);
    skip_space();
    if (!next_is("\"") && !next_is("'")) refuse("the value of an attribute is not quoted");
    const std::string_view quote = xml_.substr(at_, 1);
    advance(1);
    decode(take_until(quote, "the value of an attribute"), true);
    attribute.set_value(text_.data(), text_.size());
  }

  void parse_text() {
    if (depth_ == 0) {
      skip_space();
      if (at_ < xml_.size() && xml_[at_] != '<') refuse("a text stands outside of all elements");
      return;
    }
    const std::size_t end = std::min(xml_.find('<', at_), xml_.size());
    decode(xml_.substr(at_, end - at_), false);
    advance(end - at_);
    open_.append_child(pugi::node_pcdata).set_value(text_.data(), text_.size());
  }

  /// To `text_`: entities as what they stand for, ends of lines as '\n', and in attributes all white space as ' '.
  void decode(std::string_view raw, bool attribute) {
    text_.clear();
    while (!raw.empty()) {
      const std::string_view piece = raw.substr(0, kPiece);
      const std::size_t plain = std::min(piece.find_first_of(attribute ? "&\r\n\t" : "&\r"), piece.size());
      text_ += piece.substr(0, plain);
      raw.remove_prefix(plain);
      if (plain == piece.size()) {
        if (plain == kPiece && poll_) poll_();
        continue;
      }
      if (raw.front() == '&') {
        constexpr std::size_t kLongest = 12;  // "&#x0010ffff;"
        const std::size_t end = raw.substr(0, kLongest).find(';');
        const bool known = end != std::string_view::npos && append_entity(text_, raw.substr(1, end - 1));
        if (!known) text_ += '&';
        raw.remove_prefix(known ? end + 1 : 1);
        continue;
      }
      const bool two = raw.starts_with("\r\n");
      text_ += attribute ? ' ' : '\n';
      raw.remove_prefix(two ? 2 : 1);
    }
  }

  const std::string_view xml_;
  const int most_depth_;
  const Poll& poll_;
  pugi::xml_node open_;  // the innermost element that has not ended, or the document
  int depth_ = 0;
  std::size_t at_ = 0, polled_ = 0;
  std::string text_;
};

}  // namespace

void parse_xml(std::string_view xml, int most_depth, const Poll& poll, pugi::xml_document& document) {
  XmlParser(xml, most_depth, poll, document).parse();
}

}  // namespace breve::steve
