// Reference pages as texts.
#pragma once

#include <string>

#include "doc_model.hpp"

namespace breve::command {

/// A way of writing pages.
class PageFormat {
 public:
  virtual ~PageFormat() = default;
  virtual std::string extension() const = 0;   // ".md"
  virtual std::string index_name() const = 0;  // "README.md"
  virtual std::string index(const DocModel& model) const = 0;
  virtual std::string page(const DocModel& model, const DocClass& cls) const = 0;
};

class MarkdownPages final : public PageFormat {
 public:
  std::string extension() const override { return ".md"; }
  std::string index_name() const override { return "README.md"; }
  std::string index(const DocModel& model) const override;
  std::string page(const DocModel& model, const DocClass& cls) const override;
};

class HtmlPages final : public PageFormat {
 public:
  std::string extension() const override { return ".html"; }
  std::string index_name() const override { return "index.html"; }
  std::string index(const DocModel& model) const override;
  std::string page(const DocModel& model, const DocClass& cls) const override;
};

}  // namespace breve::command
