// The course of parsing: expat is given one piece after the other, and its calls build the tree from left to right.
#include "steve/library/archive_parse.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <string>

#include "runtime/base/error.hpp"

namespace breve::steve {

namespace {

constexpr std::size_t kPiece = 1 << 16;  // bytes between two polls
// expat reads a tag again with each piece until its '>' is there.
constexpr std::size_t kLongestTag = 1 << 22;  // bytes

class TreeBuilder {
 public:
  TreeBuilder(int most_depth, pugi::xml_document& document)
      : parser_(XML_ParserCreate("UTF-8"), XML_ParserFree), most_depth_(most_depth), open_(document) {
    if (!parser_) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), begin_element, end_element);
    XML_SetCharacterDataHandler(parser_.get(), add_text);
    XML_SetStartDoctypeDeclHandler(parser_.get(), begin_doctype);
  }

  void parse(std::string_view piece, bool last) {
    const XML_Status status = XML_Parse(parser_.get(), piece.data(), static_cast<int>(piece.size()), last);
    if (failure_) std::rethrow_exception(failure_);
    if (status != XML_STATUS_OK) refuse(XML_ErrorString(XML_GetErrorCode(parser_.get())));
    given_ += piece.size();
    const auto read = static_cast<std::size_t>(std::max<XML_Index>(XML_GetCurrentByteIndex(parser_.get()), 0));
    if (given_ - std::min(given_, read) > kLongestTag) refuse("a tag is longer than 4 MB");
  }

 private:
  [[noreturn]] void refuse(std::string_view why) const {
    throw Error(ErrorCode::File,
                fmt::format("this is not XML: {} (line {}, column {})", why, XML_GetCurrentLineNumber(parser_.get()),
                            XML_GetCurrentColumnNumber(parser_.get()) + 1));
  }

  /// Exceptions do not pass through expat, which is written in C: they wait until it has returned.
  template <class F>
  static void guarded(void* builder, F&& f) {
    auto& self = *static_cast<TreeBuilder*>(builder);
    if (self.failure_) return;
    try {
      f(self);
    } catch (...) {
      self.failure_ = std::current_exception();
      XML_StopParser(self.parser_.get(), XML_FALSE);
    }
  }

  static void begin_element(void* builder, const char* name, const char** attributes) {
    guarded(builder, [&](TreeBuilder& self) {
      self.flush_text();
      if (self.depth_ == self.most_depth_) self.refuse("its elements are nested too deeply");
      pugi::xml_node element = self.open_.append_child(name);
      if (!element) throw std::bad_alloc();
      for (const char** next = attributes; *next != nullptr; next += 2)
        if (!element.append_attribute(next[0]).set_value(next[1])) throw std::bad_alloc();
      self.open_ = element;
      ++self.depth_;
    });
  }

  static void end_element(void* builder, const char*) {
    guarded(builder, [](TreeBuilder& self) {
      self.flush_text();
      self.open_ = self.open_.parent();
      --self.depth_;
    });
  }

  static void add_text(void* builder, const char* text, int size) {
    guarded(builder, [&](TreeBuilder& self) { self.text_.append(text, static_cast<std::size_t>(size)); });
  }

  /// Entities that a document declares can grow without bound, or name files.
  static void begin_doctype(void* builder, const char*, const char*, const char*, int declares) {
    guarded(builder, [&](TreeBuilder& self) {
      if (declares != 0) self.refuse("declarations in a document type are not read");
    });
  }

  void flush_text() {
    if (!text_.empty() && !open_.append_child(pugi::node_pcdata).set_value(text_.data(), text_.size()))
      throw std::bad_alloc();
    text_.clear();
  }

  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  const int most_depth_;
  pugi::xml_node open_;  // the innermost element that has not ended, or the document
  int depth_ = 0;
  std::size_t given_ = 0;  // bytes
  std::string text_;       // of `open_`, since its last element
  std::exception_ptr failure_;
};

}  // namespace

void parse_xml(std::string_view xml, int most_depth, const Poll& poll, pugi::xml_document& document) {
  TreeBuilder builder(most_depth, document);
  for (; xml.size() > kPiece; xml.remove_prefix(kPiece)) {
    builder.parse(xml.substr(0, kPiece), false);
    if (poll) poll();
  }
  builder.parse(xml, true);
}

}  // namespace breve::steve
