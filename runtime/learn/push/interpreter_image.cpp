// The state of a Push interpreter in snapshots and hashes.
#include <cmath>

#include "runtime/learn/push/interpreter.hpp"
#include "runtime/learn/push/text.hpp"

namespace breve::push {

namespace {

template <class T, class Put>
void save_stack(ByteWriter& out, const Stack<T>& stack, Put&& put) {
  out.put(static_cast<std::uint64_t>(stack.size()));
  for (const T& item : stack) put(item);
}

/// @param least  bytes of an item
template <class T, class Get>
void load_stack(ByteReader& in, Stack<T>& stack, std::size_t least, Get&& get) {
  const std::size_t count = in.get_count(least);
  if (count > Interpreter::kMaxDepth) ByteReader::fail();
  stack.clear();
  stack.reserve(count);
  for (std::size_t i = 0; i < count; ++i) stack.push_back(get());
}

Code get_name(CodeReader& codes) {
  Code code = codes.get();
  if (code.root().kind != Kind::Name) ByteReader::fail();
  return code;
}

}  // namespace

void Interpreter::save(ByteWriter& out) const {
  settings.save(out);
  CodeWriter code_writer(out);
  const auto plain = [&](auto item) { out.put(item); };
  const auto code = [&](const Code& item) { code_writer.put(item); };
  save_stack(out, integers, plain);
  save_stack(out, floats, plain);
  save_stack(out, booleans, plain);
  save_stack(out, vectors, [&](const Vector3& item) { out.put(item); });
  save_stack(out, names, code);
  save_stack(out, codes, code);
  save_stack(out, execs, code);
  out.put(static_cast<std::uint64_t>(words_.size()));
  for (const auto& [name, word] : words_) {
    out.put(std::string_view(name));
    out.put(word.kind);
    out.put(word.callback);
    if (word.code) code_writer.put(*word.code);
  }
  out.put(quotes_name_);
  out.put(effort);
}

void Interpreter::load(ByteReader& in) {
  settings.load(in);
  CodeReader code_reader(in);
  load_stack(in, integers, sizeof(std::int32_t), [&] { return in.get<std::int32_t>(); });
  load_stack(in, floats, sizeof(double), [&] {
    const auto value = in.get<double>();
    if (!std::isfinite(value)) ByteReader::fail();
    return value;
  });
  load_stack(in, booleans, 1, [&] { return static_cast<std::uint8_t>(in.get_bool()); });
  load_stack(in, vectors, 3 * sizeof(double), [&] {
    const Vector3 value = in.get_vector();
    if (!value.allFinite()) ByteReader::fail();
    return value;
  });
  load_stack(in, names, 2 * sizeof(std::uint32_t), [&] { return get_name(code_reader); });
  load_stack(in, codes, 2 * sizeof(std::uint32_t), [&] { return code_reader.get(); });
  load_stack(in, execs, 2 * sizeof(std::uint32_t), [&] { return code_reader.get(); });
  load_words(in, code_reader);
  quotes_name_ = in.get_bool();
  effort = in.get<std::uint64_t>();
}

void Interpreter::load_words(ByteReader& in, CodeReader& code_reader) {
  words_.clear();
  for (std::size_t left = in.get_count(); left > 0; --left) {
    const std::string_view name = in.get_text();
    if (!is_name(name) || words_.size() >= kMaxDepth) ByteReader::fail();
    const auto kind = in.get<std::uint8_t>();
    if (kind > static_cast<std::uint8_t>(Word::Kind::Callback)) ByteReader::fail();
    Word word{static_cast<Word::Kind>(kind), in.get<std::uint32_t>(), std::nullopt};
    if (word.kind != Word::Kind::Callback) word.code = code_reader.get();
    words_.insert_or_assign(std::pmr::string(name, memory()), std::move(word));
  }
}

void Interpreter::hash(Hasher& hasher) const {
  settings.hash(hasher);
  const auto count = [&](std::size_t items) { hasher.add(static_cast<std::uint64_t>(items)); };
  count(integers.size());
  for (const std::int32_t item : integers) hasher.add(static_cast<std::uint64_t>(static_cast<std::uint32_t>(item)));
  count(floats.size());
  for (const double item : floats) hasher.add(item);
  count(booleans.size());
  for (const std::uint8_t item : booleans) hasher.add(static_cast<std::uint64_t>(item));
  count(vectors.size());
  for (const Vector3& item : vectors) hasher.add(item);
  for (const Stack<Code>* stack : {&names, &codes, &execs}) {
    count(stack->size());
    for (const Code& item : *stack) push::hash(item, hasher);
  }
  for (const auto& [name, word] : words_) {
    hasher.add(std::string_view(name));
    hasher.add(static_cast<std::uint64_t>(word.kind));
    hasher.add(static_cast<std::uint64_t>(word.callback));
    if (word.code) push::hash(*word.code, hasher);
  }
  hasher.add(static_cast<std::uint64_t>(quotes_name_));
  hasher.add(effort);
}

}  // namespace breve::push
