// Mesh files: what they hold comes out, in the file's axes, and no file does harm.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "runtime/base/error.hpp"
#include "runtime/base/memory.hpp"
#include "runtime/solid/contact.hpp"
#include "runtime/solid/surface.hpp"
#include "runtime/store/mesh_file.hpp"

namespace breve {
namespace {

constexpr double kSingle = 1e-6;  // both formats end in numbers of seven digits

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

/// A box from (1, 2, 3) to (2, 4, 6): one face a quadrilateral with textures and normals, one counted backward.
std::string box_obj() {
  return "# a box\nmtllib /etc/passwd\no box\n"
         "v 1 2 3\nv 2 2 3\r\nv 2 4 3\nv 1 4 3\nv 1 2 6\nv 2 2 6\nv 2 4 6\nv 1 4 6\nvt 0 0\nvn 0 0 1\n"
         "f 1/1/1 4/1/1 3/1/1 2/1/1\nusemtl stone\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf -6 -5 -1 -2\nf 4 1 5 8\n";
}

Bytes chunk(std::uint16_t id, const Bytes& inside) {
  Bytes out{static_cast<std::uint8_t>(id & 255), static_cast<std::uint8_t>(id >> 8)};
  const auto size = static_cast<std::uint32_t>(inside.size() + 6);
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(size >> 8 * i));
  out.insert(out.end(), inside.begin(), inside.end());
  return out;
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes out;
  for (const Bytes& p : parts) out.insert(out.end(), p.begin(), p.end());
  return out;
}

template <class T>
void put(Bytes& out, T value) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof value);
}

/// The same box as a 3DS file.
Bytes box_3ds(float high = 6) {
  Bytes corners, faces;
  put(corners, std::uint16_t{8});
  for (int i = 0; i < 8; ++i) {
    put(corners, i & 1 ? 2.0F : 1.0F);
    put(corners, i & 2 ? 4.0F : 2.0F);
    put(corners, i & 4 ? high : 3.0F);
  }
  const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  put(faces, std::uint16_t{12});
  for (const auto& q : quads) {
    for (const auto& t : {std::array{q[0], q[1], q[2]}, std::array{q[0], q[2], q[3]}}) {
      for (const int v : t) put(faces, static_cast<std::uint16_t>(v));
      put(faces, std::uint16_t{7});
    }
  }
  const Bytes mesh = chunk(0x4100, joined({chunk(0x4110, corners), chunk(0x4120, faces)}));
  const Bytes object = chunk(0x4000, joined({bytes_of("box"), {0}, mesh}));
  return chunk(0x4d4d, chunk(0x3d3d, object));
}

Eigen::AlignedBox3d bounds(const MeshData& data) {
  Eigen::AlignedBox3d box;
  for (const auto& t : data.triangles) {
    for (const std::int32_t v : t) box.extend(data.corners[static_cast<std::size_t>(v)]);
  }
  return box;
}

std::string refusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::File);
    return error.what();
  }
  return "accepted";
}

TEST(MeshFile, BothFormatsGiveTheBoxInTheFilesOwnAxes) {
  for (const Bytes& file : {bytes_of(box_obj()), box_3ds()}) {
    const MeshData data = parse_mesh(file, "box");
    EXPECT_EQ(data.triangles.size(), 12U);
    EXPECT_LE((bounds(data).min() - Vector3(1, 2, 3)).norm(), kSingle);
    EXPECT_LE((bounds(data).max() - Vector3(2, 4, 6)).norm(), kSingle);
  }
}

TEST(MeshFile, TheShapeIsCentredAndHasTheWantedSize) {
  for (const Bytes& file : {bytes_of(box_obj()), box_3ds()}) {
    const MeshData data = parse_mesh(file, "box");
    for (const MeshUse use : {MeshUse::Hull, MeshUse::Triangles}) {
      const auto own = make_mesh(data, "box", use, 0), half = make_mesh(data, "box", use, 1.5);
      EXPECT_NEAR(own->volume(), 6, 10 * kSingle);
      EXPECT_NEAR(half->volume(), 6.0 / 8, kSingle);
      EXPECT_LE((half->bounds(Matrix3::Identity()).sizes() - Vector3(0.5, 1, 1.5)).norm(), kSingle);
      EXPECT_LE(half->center_of_mass().norm(), kSingle);
      EXPECT_LE((half->bounds(Matrix3::Identity()).center()).norm(), kSingle);
      EXPECT_NEAR(closest(*Shape::sphere(0.5), {Vector3(2, 0, 0), Quaternion::Identity()}, *half, {}).distance, 1.25,
                  kSingle);
    }
    EXPECT_TRUE(make_mesh(data, "box", MeshUse::Triangles, 1)->surface()->solid());
  }
  EXPECT_THROW(make_mesh(parse_mesh(box_3ds(), "box"), "box", MeshUse::Hull, -1), Error);
  EXPECT_THROW(make_mesh(parse_mesh(box_3ds(), "box"), "box", MeshUse::Hull, std::nan("")), Error);
}

TEST(MeshFile, ErrorsNameFileAndReason) {
  const auto parse = [](const std::string& text) { return [=] { parse_mesh(bytes_of(text), "a.obj"); }; };
  EXPECT_NE(refusal(parse("")).find("'a.obj': it has no vertices"), std::string::npos);
  EXPECT_NE(refusal(parse("v 1 2\n")).find("line 1: a vertex has coordinate ''"), std::string::npos);
  EXPECT_NE(refusal(parse("v 1 2 nan\n")).find("coordinate 'nan'"), std::string::npos);
  EXPECT_NE(refusal(parse("v 1 2 1e300\n")).find("coordinate '1e300'"), std::string::npos);
  EXPECT_NE(refusal(parse("v 0 0 0\nf 1 1 2\n")).find("line 2: a face refers to vertex '2' (there are 1 so far)"),
            std::string::npos);
  EXPECT_NE(refusal(parse("v 0 0 0\nf 1 1\n")).find("has 2 corners"), std::string::npos);
  EXPECT_NE(refusal([] {
              auto flat = parse_mesh(bytes_of("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "flat.obj");
              make_mesh(flat, "flat.obj", MeshUse::Hull, 1);
            }).find("'flat.obj': a convex hull"),
            std::string::npos);
  Bytes cut = box_3ds();
  cut.resize(cut.size() / 2);
  EXPECT_NE(refusal([&] { parse_mesh(cut, "cut.3ds"); }).find("truncated"), std::string::npos);
  EXPECT_NE(
      refusal([&] { make_mesh(parse_mesh(box_3ds(NAN), "nan.3ds"), "nan.3ds", MeshUse::Hull, 1); }).find("'nan.3ds'"),
      std::string::npos);
}

TEST(MeshFile, HostileBytesGiveErrorsOrMeshes) {
  std::mt19937_64 engine(42);
  const auto dice = [&](std::size_t n) { return static_cast<std::size_t>(engine() % n); };
  int refused = 0;
  for (int i = 0; i < 600; ++i) {
    Bytes file = i % 2 == 0 ? box_3ds() : bytes_of(box_obj());
    if (i % 5 == 4) {
      file.resize(2 + dice(200));
      for (std::uint8_t& b : file) b = static_cast<std::uint8_t>(engine());
      if (i % 2 == 0) file[0] = file[1] = 0x4d;
    } else if (i % 5 == 3) {
      file.resize(dice(file.size()));
    }
    for (int k = 0; k < i % 5 && !file.empty(); ++k) file[dice(file.size())] = static_cast<std::uint8_t>(engine());
    try {
      const MeshData data = parse_mesh(file, "bad");
      make_mesh(data, "bad", i % 3 == 0 ? MeshUse::Hull : MeshUse::Triangles, 1);
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(error.code(), ErrorCode::File) << error.what();
    }
  }
  EXPECT_GT(refused, 200);
}

TEST(MeshFile, WhatIsImportedIsCountedAndGivenBack) {
  MemoryMeter meter;
  {
    const auto shape = make_mesh(parse_mesh(box_3ds(), "box", &meter), "box", MeshUse::Triangles, 1, &meter);
    EXPECT_GT(meter.used(), 12 * sizeof(Vector3));
  }
  EXPECT_EQ(meter.used(), 0U);
  // Any allocation may be the one that is refused.
  for (std::size_t limit = 64; limit < 20000; limit += 64) {
    MemoryMeter small;
    small.set_limit(limit);
    try {
      make_mesh(parse_mesh(box_3ds(), "box", &small), "box", MeshUse::Triangles, 1, &small);
    } catch (const std::bad_alloc&) {
    }
    EXPECT_EQ(small.used(), 0U);
  }
}

}  // namespace
}  // namespace breve
