// Mesh files are read by assimp, which is seen here and nowhere else. It is given bytes that were looked through first:
// of an OBJ file the lines that matter, so that it opens no other files; of a 3DS file, chunks that nest.
#include "runtime/store/mesh_file.hpp"

#include <assimp/BaseImporter.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "runtime/base/error.hpp"

namespace breve {

namespace {

using Bytes = std::pmr::vector<std::uint8_t>;

[[noreturn]] void refuse_mesh(const std::string& name, const std::string& why) {
  throw Error(ErrorCode::File, fmt::format("cannot use mesh file '{}': {}", name, why));
}

// --- 3DS
// --------------------------------------------------------------------------------------------------------------

bool is_3ds(std::span<const std::uint8_t> bytes) { return bytes.size() >= 2 && bytes[0] == 0x4d && bytes[1] == 0x4d; }

/// Every chunk ends within the one it is in: identifier, then a length that counts these six bytes. The main chunk and
/// the editor's hold chunks at once; the file must not end before its main chunk does.
void check_chunks(std::span<const std::uint8_t> bytes, const std::string& name) {
  constexpr std::uint32_t kHead = 6, kEditor = 0x3d3d;
  const auto length = [&](std::size_t at) {
    std::uint32_t value;
    std::memcpy(&value, bytes.data() + at + 2, sizeof value);
    return value;
  };
  const auto walk = [&](std::size_t begin, std::size_t end, auto&& inside) -> void {
    for (std::size_t at = begin; at < end;) {
      if (end - at < kHead || length(at) < kHead || length(at) > end - at) {
        refuse_mesh(name, fmt::format("it is damaged or truncated: the chunk at byte {} does not end in the file", at));
      }
      inside(at, at + length(at));
      at += length(at);
    }
  };
  if (bytes.size() < kHead || length(0) < kHead || length(0) > bytes.size()) {
    refuse_mesh(name, "it is truncated: a 3DS file must be as long as its first chunk states");
  }
  walk(kHead, length(0), [&](std::size_t at, std::size_t end) {
    std::uint16_t id;
    std::memcpy(&id, bytes.data() + at, sizeof id);
    if (id == kEditor) walk(at + kHead, end, [](std::size_t, std::size_t) {});
  });
}

// --- OBJ
// --------------------------------------------------------------------------------------------------------------

/// The vertices and faces of an OBJ file, faces by their vertices alone.
class ObjFilter {
 public:
  ObjFilter(std::span<const std::uint8_t> bytes, const std::string& name, Bytes& out)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), name_(name), out_(out) {}

  void run() {
    put("o mesh\n");
    while (!text_.empty()) line(next_line());
    if (vertices_ == 0 || faces_ == 0) {
      refuse_mesh(name_, "it has no vertices and faces: is it a 3DS or OBJ file?");
    }
  }

 private:
  void put(std::string_view text) { out_.insert(out_.end(), text.begin(), text.end()); }

  /// A line without its end; one that ends in a backslash goes on in the next.
  std::string_view next_line() {
    ++number_;
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    std::string_view here = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    if (!here.empty() && here.back() == '\r') here.remove_suffix(1);
    return here;
  }

  static std::string_view next_word(std::string_view& line) {
    constexpr std::string_view kBlank = " \t";
    line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
    const std::size_t end = std::min(line.find_first_of(kBlank), line.size());
    const std::string_view word = line.substr(0, end);
    line.remove_prefix(end);
    return word;
  }

  [[noreturn]] void refuse(const std::string& why) { refuse_mesh(name_, fmt::format("line {}: {}", number_, why)); }

  void line(std::string_view rest) {
    const std::string_view kind = next_word(rest);
    if (kind == "v") vertex(rest);
    if (kind == "f") face(rest);
  }

  void vertex(std::string_view rest) {
    put("v");
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = next_word(rest);
      double value = 0;
      const auto [end, wrong] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (wrong != std::errc() || end != word.data() + word.size() || !(std::abs(value) <= 1e30)) {
        refuse(fmt::format("a vertex has coordinate '{}' (must be a number, at most 1e30)", word.substr(0, 40)));
      }
      put(fmt::format(" {:.17g}", value));
    }
    put("\n");
    ++vertices_;
  }

  void face(std::string_view rest) {
    constexpr int kMostCorners = 10000;
    std::string text = "f";
    int corners = 0;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      if (word == "\\") {
        rest = next_line();
        continue;
      }
      const std::string_view first = word.substr(0, word.find('/'));
      long index = 0;
      const auto [end, wrong] = std::from_chars(first.data(), first.data() + first.size(), index);
      if (index < 0) index += vertices_ + 1;  // counted back from the last one
      if (wrong != std::errc() || end != first.data() + first.size() || index < 1 || index > vertices_) {
        refuse(fmt::format("a face refers to vertex '{}' (there are {} so far)", first.substr(0, 40), vertices_));
      }
      if (++corners > kMostCorners) refuse(fmt::format("a face has more than {} corners", kMostCorners));
      text += fmt::format(" {}", index);
    }
    if (corners < 3) refuse(fmt::format("a face has {} corners (must be at least 3)", corners));
    put(text + "\n");
    ++faces_;
  }

  std::string_view text_;
  const std::string& name_;
  Bytes& out_;
  long number_ = 0, vertices_ = 0, faces_ = 0;
};

// --- both
// -------------------------------------------------------------------------------------------------------------

/// Only the two formats that are promised.
void keep_formats(Assimp::Importer& importer) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* one = importer.GetImporter(i);
    const std::string_view extensions = importer.GetImporterInfo(i)->mFileExtensions;
    if (extensions.find("3ds") != std::string_view::npos || extensions == "obj") continue;
    if (importer.UnregisterLoader(one) == aiReturn_SUCCESS) delete one;  // it is ours from now on
  }
}

Vector3 vector_of(const aiVector3D& v) { return {v.x, v.y, v.z}; }

/// The meshes of a node at its place. Corners keep the axes of the file: the root's transformation, by which assimp
/// turns some formats, is left out.
void collect(const aiScene& scene, MeshData& out, const std::string& name) {
  struct Task {
    const aiNode* node;
    aiMatrix4x4 transform;
  };
  std::vector<Task> tasks{{scene.mRootNode, aiMatrix4x4()}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    for (unsigned m = 0; m < task.node->mNumMeshes; ++m) {
      const aiMesh& mesh = *scene.mMeshes[task.node->mMeshes[m]];
      const std::size_t first = out.corners.size();
      if (first + mesh.mNumVertices > 0x7fffffffU) refuse_mesh(name, "it has too many vertices");
      for (unsigned v = 0; v < mesh.mNumVertices; ++v)
        out.corners.push_back(vector_of(task.transform * mesh.mVertices[v]));
      for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        if (face.mNumIndices != 3) continue;  // points and lines
        std::array<std::int32_t, 3> triangle;
        for (unsigned k = 0; k < 3; ++k) {
          if (face.mIndices[k] >= mesh.mNumVertices)
            refuse_mesh(name, "it is damaged: a face refers to a vertex that does not exist");
          triangle[k] = static_cast<std::int32_t>(first + face.mIndices[k]);
        }
        out.triangles.push_back(triangle);
      }
    }
    for (unsigned c = task.node->mNumChildren; c-- > 0;) {
      const aiNode* child = task.node->mChildren[c];
      tasks.push_back({child, task.transform * child->mTransformation});
    }
  }
}

}  // namespace

MeshData parse_mesh(std::span<const std::uint8_t> bytes, const std::string& name, std::pmr::memory_resource* memory) {
  if (bytes.size() > kMostMeshBytes) refuse_mesh(name, fmt::format("it is larger than {} bytes", kMostMeshBytes));
  const bool three_ds = is_3ds(bytes);
  Bytes filtered(memory);
  if (three_ds) {
    check_chunks(bytes, name);
  } else {
    ObjFilter(bytes, name, filtered).run();
    bytes = filtered;
  }
  Assimp::Importer importer;
  keep_formats(importer);
  const aiScene* scene =
      importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_Triangulate, three_ds ? "3ds" : "obj");
  if (scene == nullptr || scene->mRootNode == nullptr) {
    refuse_mesh(name, fmt::format("it is damaged ({})", importer.GetErrorString()));
  }
  MeshData data{std::pmr::vector<Vector3>(memory), std::pmr::vector<std::array<std::int32_t, 3>>(memory)};
  collect(*scene, data, name);
  if (data.triangles.empty()) refuse_mesh(name, "it has no triangles");
  return data;
}

std::shared_ptr<Shape> make_mesh(const MeshData& data, const std::string& name, MeshUse use, double size,
                                 std::pmr::memory_resource* memory) {
  if (!std::isfinite(size) || size < 0) {
    throw Error(ErrorCode::Argument, fmt::format("the size of a mesh is {} (must be finite and >= 0)", size));
  }
  try {
    std::pmr::vector<Vector3> corners(data.corners, memory);
    const auto build = [&] {
      return use == MeshUse::Hull ? Shape::hull(corners, 1, memory) : Shape::mesh(corners, data.triangles, memory);
    };
    // First as it is, to find its centre; corners that no triangle uses count for nothing.
    std::vector<bool> used(corners.size(), false);
    for (const auto& t : data.triangles) {
      for (const std::int32_t v : t) used[static_cast<std::size_t>(v)] = true;
    }
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (!used[i]) corners[i] = corners[static_cast<std::size_t>(data.triangles[0][0])];
      box.extend(corners[i]);
    }
    const double factor = size > 0 ? size / box.sizes().maxCoeff() : 1;
    const Vector3 middle = box.center();
    for (Vector3& p : corners) p = factor * (p - middle);
    const Vector3 center = build()->center_of_mass();
    for (Vector3& p : corners) p -= center;
    return build();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Argument) throw;
    refuse_mesh(name, error.what());
  }
}

}  // namespace breve
