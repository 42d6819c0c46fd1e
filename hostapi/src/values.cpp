// Script values at the border: conversion both ways, and the lists and hashes that hosts look into.
#include <cstring>

#include "internal.hpp"
#include "steve/machine/operators.hpp"

namespace breve::host {

using steve::Tag;
using steve::Value;

breve_ref References::add(steve::Cell* cell) {
  if (!cell) return {0, 0};
  cells_.push_back(cell);
  return {static_cast<std::uint32_t>(cells_.size() - 1), epoch_};
}

steve::Cell* References::find(breve_ref ref, Tag tag) const {
  if (ref.index == 0 && ref.epoch == 0) return nullptr;
  if (ref.epoch != epoch_ || ref.index >= cells_.size())
    fail(BREVE_ERROR_STALE, "the list or hash was read before script ran: read it again");
  steve::Cell* cell = cells_[ref.index];
  if (cell->tag != tag) fail(BREVE_ERROR_TYPE, "the reference is to a " + std::string(steve::type_name(cell->tag)));
  return cell;
}

void References::forget_all() {
  if (cells_.empty()) return;
  cells_.clear();
  if (++epoch_ == 0) epoch_ = 1;
}

breve_value to_host(breve_world& world, const Value& value) {
  breve_value out = breve_value_null();
  out.type = static_cast<std::uint32_t>(value.tag);
  static_assert(static_cast<int>(Tag::Data) == BREVE_TYPE_DATA && static_cast<int>(Tag::Object) == BREVE_TYPE_OBJECT &&
                static_cast<int>(Tag::Vector) == BREVE_TYPE_VECTOR && static_cast<int>(Tag::Hash) == BREVE_TYPE_HASH);
  switch (value.tag) {
    case Tag::Null:
    case Tag::Pointer: break;
    case Tag::Int: out.as.integer = value.i; break;
    case Tag::Double: out.as.number = value.d; break;
    case Tag::Vector: std::memcpy(out.as.vector, value.v, sizeof out.as.vector); break;
    case Tag::Matrix:
      if (value.ref) std::memcpy(out.as.matrix, value.matrix()->m.data(), sizeof out.as.matrix);
      break;
    case Tag::String:
      out.as.string.bytes = world.machine->heap().terminated(value.string());
      out.as.string.size = value.ref ? value.string()->size : 0;
      break;
    case Tag::Data:
      out.as.string.bytes = "";
      if (value.ref && !value.data()->bytes.empty()) {
        out.as.string.bytes = reinterpret_cast<const char*>(value.data()->bytes.data());
        out.as.string.size = value.data()->bytes.size();
      }
      break;
    case Tag::Object: out.as.object = handle_of(world, world.machine->id_of(value.object())); break;
    case Tag::List:
    case Tag::Hash: out.as.ref = world.references.add(value.ref); break;
  }
  return out;
}

namespace {

std::string_view bytes_of(const breve_value& value) {
  if (value.as.string.size != 0) need(value.as.string.bytes, "the bytes of a value");
  return {value.as.string.size != 0 ? value.as.string.bytes : "", value.as.string.size};
}

}  // namespace

Value from_host(breve_world& world, const breve_value& value) {
  auto& heap = world.machine->heap();
  switch (value.type) {
    case BREVE_TYPE_NULL: return Value();
    case BREVE_TYPE_INT: return Value::of(value.as.integer);
    case BREVE_TYPE_DOUBLE: return Value::of(value.as.number);
    case BREVE_TYPE_VECTOR: return Value::of(Vector3(value.as.vector[0], value.as.vector[1], value.as.vector[2]));
    case BREVE_TYPE_MATRIX: return Value::of(Tag::Matrix, heap.matrix(Matrix3(value.as.matrix)));
    case BREVE_TYPE_STRING: return Value::of(Tag::String, heap.string(bytes_of(value)));
    case BREVE_TYPE_DATA: return Value::of(Tag::Data, heap.data(bytes_of(value)));
    case BREVE_TYPE_OBJECT:
      if (is_null(value.as.object)) return Value::of(Tag::Object, nullptr);
      return Value::of(Tag::Object, &live_instance(world, value.as.object));
    case BREVE_TYPE_LIST: return Value::of(Tag::List, world.references.find(value.as.ref, Tag::List));
    case BREVE_TYPE_HASH: return Value::of(Tag::Hash, world.references.find(value.as.ref, Tag::Hash));
    case BREVE_TYPE_POINTER: fail(BREVE_ERROR_UNSUPPORTED, "a pointer cannot be passed to a script by the host");
    default: fail(BREVE_ERROR_ARGUMENT, "value.type is " + std::to_string(value.type) + ", which is not a breve_type");
  }
}

namespace {

/// The list of a value; null for one that is not made yet.
steve::ListCell* list_of(const breve_world& world, const breve_value* value) {
  need(value, "list");
  if (value->type != BREVE_TYPE_LIST) fail(BREVE_ERROR_TYPE, "the value is not a list");
  return static_cast<steve::ListCell*>(world.references.find(value->as.ref, Tag::List));
}

steve::HashCell* hash_of(const breve_world& world, const breve_value* value) {
  need(value, "hash");
  if (value->type != BREVE_TYPE_HASH) fail(BREVE_ERROR_TYPE, "the value is not a hash");
  return static_cast<steve::HashCell*>(world.references.find(value->as.ref, Tag::Hash));
}

}  // namespace
}  // namespace breve::host

using namespace breve::host;
using breve::steve::Tag;
using breve::steve::Value;

breve_value breve_value_null(void) {
  breve_value value;
  std::memset(&value, 0, sizeof value);
  return value;
}

breve_value breve_value_int(int32_t integer) {
  breve_value value = breve_value_null();
  value.type = BREVE_TYPE_INT;
  value.as.integer = integer;
  return value;
}

breve_value breve_value_double(double number) {
  breve_value value = breve_value_null();
  value.type = BREVE_TYPE_DOUBLE;
  value.as.number = number;
  return value;
}

breve_value breve_value_vector(double x, double y, double z) {
  breve_value value = breve_value_null();
  value.type = BREVE_TYPE_VECTOR;
  value.as.vector[0] = x;
  value.as.vector[1] = y;
  value.as.vector[2] = z;
  return value;
}

breve_value breve_value_matrix(const double rows[9]) {
  breve_value value = breve_value_null();
  value.type = BREVE_TYPE_MATRIX;
  if (rows) std::memcpy(value.as.matrix, rows, sizeof value.as.matrix);
  return value;
}

breve_value breve_value_string(const char* text) {
  breve_value value = breve_value_null();
  value.type = BREVE_TYPE_STRING;
  value.as.string.bytes = text ? text : "";
  value.as.string.size = text ? std::strlen(text) : 0;
  return value;
}

breve_value breve_value_object(breve_object object) {
  breve_value value = breve_value_null();
  value.type = BREVE_TYPE_OBJECT;
  value.as.object = object;
  return value;
}

breve_status breve_value_text(breve_world* world, const breve_value* value, const char** text) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(value, "value");
    need(text, "text");
    const Value v = from_host(*world, *value);
    const ScriptScope script(*world);
    world->text = world->machine->text(v);
    *text = world->text.c_str();
  });
}

breve_status breve_list_create(breve_world* world, breve_value* list) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(list, "list");
    *list = to_host(*world, Value::of(Tag::List, world->machine->heap().list()));
  });
}

breve_status breve_list_size(const breve_world* world, const breve_value* list, size_t* size) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(size, "size");
    const auto* cell = list_of(*world, list);
    *size = cell ? cell->size : 0;
  });
}

breve_status breve_list_get(breve_world* world, const breve_value* list, size_t index, breve_value* element) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(element, "element");
    const auto* cell = list_of(*world, list);
    const std::size_t size = cell ? cell->size : 0;
    if (index >= size)
      fail(BREVE_ERROR_NOT_FOUND, "index " + std::to_string(index) + " of a list of " + std::to_string(size));
    *element = to_host(*world, (*cell)[static_cast<std::uint32_t>(index)]);
  });
}

breve_status breve_list_read(breve_world* world, const breve_value* list, size_t first, breve_value* elements,
                             size_t count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (count != 0) need(elements, "elements");
    const auto* cell = list_of(*world, list);
    const std::size_t size = cell ? cell->size : 0;
    if (first > size || count > size - first)
      fail(BREVE_ERROR_NOT_FOUND, std::to_string(count) + " elements from " + std::to_string(first) +
                                      " on of a list of " + std::to_string(size));
    for (std::size_t i = 0; i < count; ++i)
      elements[i] = to_host(*world, (*cell)[static_cast<std::uint32_t>(first + i)]);
  });
}

breve_status breve_list_push(breve_world* world, const breve_value* list, const breve_value* element) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(element, "element");
    auto* cell = list_of(*world, list);
    need(cell, "the list");
    world->machine->heap().push(*cell, from_host(*world, *element));
  });
}

breve_status breve_hash_create(breve_world* world, breve_value* hash) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(hash, "hash");
    *hash = to_host(*world, Value::of(Tag::Hash, world->machine->heap().hash()));
  });
}

breve_status breve_hash_size(const breve_world* world, const breve_value* hash, size_t* size) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(size, "size");
    const auto* cell = hash_of(*world, hash);
    *size = cell ? cell->count_live : 0;
  });
}

breve_status breve_hash_get(breve_world* world, const breve_value* hash, const breve_value* key, breve_value* element) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(key, "key");
    need(element, "element");
    const auto* cell = hash_of(*world, hash);
    const Value k = from_host(*world, *key);
    const Value* found = cell ? world->machine->heap().find(*cell, k) : nullptr;
    if (!found) fail(BREVE_ERROR_NOT_FOUND, "the hash has no such key");
    *element = to_host(*world, *found);
  });
}

breve_status breve_hash_set(breve_world* world, const breve_value* hash, const breve_value* key,
                            const breve_value* element) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(key, "key");
    need(element, "element");
    auto* cell = hash_of(*world, hash);
    need(cell, "the hash");
    const Value k = from_host(*world, *key);
    world->machine->heap().set(*cell, k, from_host(*world, *element));
  });
}

breve_status breve_hash_keys(breve_world* world, const breve_value* hash, breve_value* keys) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(keys, "keys");
    const auto* cell = hash_of(*world, hash);
    auto& heap = world->machine->heap();
    *keys = to_host(*world, Value::of(Tag::List, cell ? heap.keys(*cell) : heap.list()));
  });
}
