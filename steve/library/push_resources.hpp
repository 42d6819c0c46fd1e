// The native data behind PushInterpreter, PushProgram and PushDiversityPool objects.
#pragma once

#include <memory>
#include <vector>

#include "runtime/learn/push/edit.hpp"
#include "runtime/learn/push/interpreter.hpp"
#include "runtime/world/resource.hpp"

namespace breve::steve {

/// A PushInterpreter object.
class PushInterpreterResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "push-interpreter";
  explicit PushInterpreterResource(std::pmr::memory_resource* memory) : interpreter(memory) {}
  push::Interpreter interpreter;
  bool running = false;  // only while a call into it is under way: never in an image

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override;
  void hash(Hasher& hasher) const override;
  static std::unique_ptr<Resource> load(ByteReader& in);
};

/// A PushProgram object.
class PushProgramResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "push-program";
  explicit PushProgramResource(std::pmr::memory_resource* memory) : code(push::empty_list(memory)) {}
  push::Code code;

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override;
  void hash(Hasher& hasher) const override;
  static std::unique_ptr<Resource> load(ByteReader& in);
};

/// A PushDiversityPool object.
class PushPoolResource final : public Resource {
 public:
  static constexpr std::string_view kKind = "push-pool";
  static constexpr std::int32_t kFirstTolerance = 10;
  explicit PushPoolResource(std::pmr::memory_resource* memory) : programs(memory) {}
  std::pmr::vector<push::Code> programs;  // each differs from all others by more than the tolerance of its day
  std::int32_t tolerance = kFirstTolerance;

  std::string_view kind() const override { return kKind; }
  void save(ByteWriter& out) const override;
  void hash(Hasher& hasher) const override;
  static std::unique_ptr<Resource> load(ByteReader& in);
};

}  // namespace breve::steve
