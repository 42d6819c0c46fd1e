// Functions and classes that whoever embeds the language gives to programs. The compiler knows their names and types,
// and the machine hands each call on to MachineHost::call_foreign; what such a function does is not known here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace breve::steve {

/// Whoever embeds the language derives from it what it needs to make the call.
class ForeignFunction {
 public:
  static constexpr std::size_t kMostParameters = 8;

  /// @param signature  as Native::signature, with any of the letters i d v m s o l h b a
  ForeignFunction(std::string name, std::string signature, std::string doc, bool method = false)
      : name_(std::move(name)), signature_(std::move(signature)), doc_(std::move(doc)), method_(method) {}
  virtual ~ForeignFunction() = default;
  ForeignFunction(const ForeignFunction&) = delete;
  ForeignFunction& operator=(const ForeignFunction&) = delete;

  const std::string& name() const { return name_; }
  const std::string& signature() const { return signature_; }
  const std::string& doc() const { return doc_; }
  const std::string& result_name() const { return result_name_; }  // for errors: "the result of worldHeight"
  std::size_t parameter_count() const { return parameter_count_; }
  bool is_method() const { return method_; }  // then it is a ForeignMethod

 private:
  const std::string name_, signature_, doc_;
  const bool method_;
  const std::string result_name_ = "the result of " + name_;
  const std::size_t parameter_count_ = signature_.find(':');
};

using ForeignFunctions = std::vector<std::shared_ptr<const ForeignFunction>>;

/// A method of a ForeignClass: called with its receiver as `self`. Its name cannot be written as that of a function.
class ForeignMethod : public ForeignFunction {
 public:
  /// @param adopts  its keywords are those of the method that it overrides, if there is one
  /// @param file    of its own source; "" if that is not known
  ForeignMethod(const std::string& cls, const std::string& name, std::string signature, std::string doc, bool adopts,
                std::string file, std::uint32_t line)
      : ForeignFunction(cls + '.' + name, std::move(signature), std::move(doc), true),
        adopts_(adopts),
        file_(std::move(file)),
        line_(line) {}
  bool adopts_keywords() const { return adopts_; }
  const std::string& file() const { return file_; }
  std::uint32_t line() const { return line_; }

 private:
  const bool adopts_;
  const std::string file_;
  const std::uint32_t line_;
};

/// A class whose methods are foreign functions. A program takes it in when it names it, as a class of the library.
class ForeignClass {
 public:
  virtual ~ForeignClass() = default;
  const std::string& name() const { return name_; }
  const std::string& alias() const { return alias_; }
  /// The class as a file of the library would have it: the body of the n-th method is `@native "n" (type).`
  const std::string& text() const { return text_; }
  const std::vector<std::string>& modules() const { return modules_; }  // loaded before it
  const std::vector<std::unique_ptr<ForeignMethod>>& methods() const { return methods_; }

 protected:
  std::string name_, alias_, text_;
  std::vector<std::string> modules_;
  std::vector<std::unique_ptr<ForeignMethod>> methods_;
};

using ForeignClasses = std::vector<std::shared_ptr<const ForeignClass>>;

/// Where a foreign method stands in its own source.
struct ForeignPlace {
  std::string function;  // what the source calls it; the last of several is the method itself
  std::string file;
  std::uint32_t line = 0;
};

}  // namespace breve::steve
