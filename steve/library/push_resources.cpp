// Interpreters, programs and pools of Push in snapshots and hashes.
#include "steve/library/push_resources.hpp"

namespace breve::steve {

void PushInterpreterResource::save(ByteWriter& out) const { interpreter.save(out); }

void PushInterpreterResource::hash(Hasher& hasher) const { interpreter.hash(hasher); }

std::unique_ptr<Resource> PushInterpreterResource::load(ByteReader& in) {
  auto resource = make_in<PushInterpreterResource>(in.memory(), in.memory());
  resource->interpreter.load(in);
  return resource;
}

void PushProgramResource::save(ByteWriter& out) const { push::CodeWriter(out).put(code); }

void PushProgramResource::hash(Hasher& hasher) const { push::hash(code, hasher); }

std::unique_ptr<Resource> PushProgramResource::load(ByteReader& in) {
  auto resource = make_in<PushProgramResource>(in.memory(), in.memory());
  resource->code = push::CodeReader(in).get();
  return resource;
}

void PushPoolResource::save(ByteWriter& out) const {
  out.put(tolerance);
  out.put(static_cast<std::uint64_t>(programs.size()));
  push::CodeWriter writer(out);
  for (const push::Code& program : programs) writer.put(program);
}

void PushPoolResource::hash(Hasher& hasher) const {
  hasher.add(static_cast<std::uint64_t>(tolerance));
  for (const push::Code& program : programs) push::hash(program, hasher);
}

std::unique_ptr<Resource> PushPoolResource::load(ByteReader& in) {
  auto resource = make_in<PushPoolResource>(in.memory(), in.memory());
  resource->tolerance = in.get<std::int32_t>();
  if (resource->tolerance < 0) ByteReader::fail();
  push::CodeReader reader(in);
  for (std::size_t left = in.get_count(2 * sizeof(std::uint32_t)); left > 0; --left)
    resource->programs.push_back(reader.get());
  return resource;
}

}  // namespace breve::steve
