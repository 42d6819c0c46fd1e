// Native data in snapshots and hashes.
#include "steve/library/resources.hpp"

namespace breve::steve {

void ShapeResource::save(ByteWriter& out) const {
  out.put(density);
  out.put_shared(shape);
}

void ShapeResource::hash(Hasher& hasher) const {
  hasher.add(density);
  if (shape) shape->hash(hasher);
}

std::unique_ptr<Resource> ShapeResource::load(ByteReader& in) {
  auto resource = make_in<ShapeResource>(in.memory());
  resource->density = in.get<double>();
  resource->shape = in.get_shared<Shape>();
  return resource;
}

void FieldResource::save(ByteWriter& out) const {
  out.put(field.has_value());
  if (field) field->save(out);
}

void FieldResource::hash(Hasher& hasher) const {
  if (field) field->hash(hasher);
}

std::unique_ptr<Resource> FieldResource::load(ByteReader& in) {
  auto resource = make_in<FieldResource>(in.memory());
  if (in.get_bool()) resource->field = Field::load(in);
  return resource;
}

void ReactionResource::save(ByteWriter& out) const {
  out.put(reaction.has_value());
  if (reaction) reaction->save(out);
}

void ReactionResource::hash(Hasher& hasher) const {
  if (reaction) reaction->hash(hasher);
}

std::unique_ptr<Resource> ReactionResource::load(ByteReader& in) {
  auto resource = make_in<ReactionResource>(in.memory());
  if (in.get_bool()) resource->reaction = Reaction::load(in);
  return resource;
}

}  // namespace breve::steve
