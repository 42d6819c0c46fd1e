// Functions that whoever embeds the language gives to programs. The compiler knows their names and types, and the
// machine hands each call on to MachineHost::call_foreign; what such a function does is not known here.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace breve::steve {

/// Whoever embeds the language derives from it what it needs to make the call.
class ForeignFunction {
 public:
  static constexpr std::size_t kMostParameters = 8;

  /// @param signature  as Native::signature, with any of the letters i d v m s o l h b a
  ForeignFunction(std::string name, std::string signature, std::string doc)
      : name_(std::move(name)), signature_(std::move(signature)), doc_(std::move(doc)) {}
  virtual ~ForeignFunction() = default;
  ForeignFunction(const ForeignFunction&) = delete;
  ForeignFunction& operator=(const ForeignFunction&) = delete;

  const std::string& name() const { return name_; }
  const std::string& signature() const { return signature_; }
  const std::string& doc() const { return doc_; }
  const std::string& result_name() const { return result_name_; }  // for errors: "the result of worldHeight"
  std::size_t parameter_count() const { return parameter_count_; }

 private:
  const std::string name_, signature_, doc_;
  const std::string result_name_ = "the result of " + name_;
  const std::size_t parameter_count_ = signature_.find(':');
};

using ForeignFunctions = std::vector<std::shared_ptr<const ForeignFunction>>;

}  // namespace breve::steve
