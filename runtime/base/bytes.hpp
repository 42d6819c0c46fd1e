// Writing and reading snapshot images: little-endian scalars, length-prefixed strings, every read checked.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <memory_resource>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "runtime/base/error.hpp"
#include "runtime/base/ids.hpp"
#include "runtime/base/math.hpp"

namespace breve {

static_assert(std::endian::native == std::endian::little, "images are written in the machine's byte order");

class ByteWriter {
 public:
  /// @param memory  where the image takes its bytes
  explicit ByteWriter(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : bytes_(memory), shared_(memory) {}
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void put(T value) { raw(&value, sizeof value); }
  void put(const Vector3& v) { raw(v.data(), 3 * sizeof(double)); }
  void put(const Matrix3& m) { raw(m.data(), 9 * sizeof(double)); }
  void put(const Quaternion& q) { raw(q.coeffs().data(), 4 * sizeof(double)); }
  void put(ObjectId id) {
    put(id.index);
    put(id.generation);
  }
  void put(std::string_view text) {
    put(static_cast<std::uint64_t>(text.size()));
    raw(text.data(), text.size());
  }
  void raw(const void* data, std::size_t size) {
    if (size == 0) return;
    const std::size_t at = bytes_.size();
    bytes_.resize(at + size);
    std::memcpy(bytes_.data() + at, data, size);
  }
  /// Put another number where one was written.
  void overwrite(std::size_t at, std::uint64_t value) { std::memcpy(bytes_.data() + at, &value, sizeof value); }
  /// Something that several owners share (or null): written once per writer, named by a number afterwards, so that
  /// it is shared again after reading. T has save(ByteWriter&) const and static shared_ptr<T> load(ByteReader&).
  template <class T>
  void put_shared(const std::shared_ptr<T>& thing) {
    if (!thing) return put(std::uint32_t{0});
    const auto [entry, fresh] = shared_.try_emplace(thing.get(), static_cast<std::uint32_t>(shared_.size() + 1));
    put(entry->second);
    if (fresh) thing->save(*this);
  }
  const std::pmr::vector<std::uint8_t>& bytes() const { return bytes_; }
  std::pmr::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::pmr::vector<std::uint8_t> bytes_;
  std::pmr::map<const void*, std::uint32_t> shared_;  // looked up, never walked: addresses do not reach the image
};

/// Reads what ByteWriter wrote. Throws Error{Image} when the image ends early; never reads outside it.
class ByteReader {
 public:
  /// @param memory  where what is read takes its bytes
  ByteReader(const std::uint8_t* data, std::size_t size,
             std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : next_(data), left_(size), memory_(memory), shared_(memory) {}
  std::pmr::memory_resource* memory() const { return memory_; }

  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) T get() {
    T value;
    raw(&value, sizeof value);
    return value;
  }
  bool get_bool() { return get<std::uint8_t>() != 0; }
  Vector3 get_vector() {
    Vector3 v;
    raw(v.data(), 3 * sizeof(double));
    return v;
  }
  Matrix3 get_matrix() {
    Matrix3 m;
    raw(m.data(), 9 * sizeof(double));
    return m;
  }
  Quaternion get_quaternion() {
    Quaternion q;
    raw(q.coeffs().data(), 4 * sizeof(double));
    return q;
  }
  ObjectId get_object() {
    const auto index = get<std::uint32_t>();
    return {index, get<std::uint32_t>()};
  }
  /// A text, as it stands in the image.
  std::string_view get_text() {
    const auto size = get<std::uint64_t>();
    need(size);
    const std::string_view text(reinterpret_cast<const char*>(next_), static_cast<std::size_t>(size));
    skip(static_cast<std::size_t>(size));
    return text;
  }
  std::string get_string() { return std::string(get_text()); }
  /// A count of things of at least `least` bytes each: a damaged count cannot ask for more than the image holds.
  std::size_t get_count(std::size_t least = 1) {
    const auto count = get<std::uint64_t>();
    if (least != 0 && count > left_ / least) fail();
    return static_cast<std::size_t>(count);
  }
  /// What put_shared wrote; null if it was null.
  template <class T>
  std::shared_ptr<T> get_shared() {
    const auto number = get<std::uint32_t>();
    if (number == 0) return nullptr;
    if (number <= shared_.size()) {
      const auto& [thing, type] = shared_[number - 1];
      if (*type != typeid(T) || !thing) fail();
      return std::static_pointer_cast<T>(thing);
    }
    if (number != shared_.size() + 1) fail();
    shared_.emplace_back(nullptr, &typeid(T));
    std::shared_ptr<T> thing = T::load(*this);
    shared_[number - 1].first = thing;
    return thing;
  }
  void raw(void* out, std::size_t size) {
    need(size);
    if (size != 0) std::memcpy(out, next_, size);
    skip(size);
  }
  std::size_t left() const { return left_; }
  [[noreturn]] static void fail() { throw Error(ErrorCode::Image, "the image is damaged or truncated"); }

 private:
  void need(std::uint64_t size) const {
    if (size > left_) fail();
  }
  void skip(std::size_t size) {
    next_ += size;
    left_ -= size;
  }
  const std::uint8_t* next_;
  std::size_t left_;
  std::pmr::memory_resource* memory_;
  std::pmr::vector<std::pair<std::shared_ptr<void>, const std::type_info*>> shared_;
};

}  // namespace breve
