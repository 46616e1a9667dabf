#include "io/geometry/mesh_file.h"

#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <unordered_map>

#include "core/error.h"
#include "io/geometry/child_process.h"
#include "io/geometry/mesh_checks.h"

namespace molten {
namespace {

namespace fs = std::filesystem;
using Point = std::array<float, 3>;
using Triangle = std::array<std::int32_t, 3>;

constexpr std::size_t giga = std::size_t{1} << 30;
constexpr std::size_t largest_file = 4 * giga, largest_answer = 4 * giga;
constexpr int most_seconds = 60;                 // of a small file
constexpr std::size_t bytes_a_second = 2 << 20;  // of a large one, on a slow and busy machine
// assimp keeps coordinates in single precision; worse than this part of the mesh's size is refused.
constexpr double coarsest = 1e-4;

[[noreturn]] void refuse(const fs::path& file, const std::string& what) {
  std::string line = file.string() + ": " + what;
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  throw Error(ExitCode::geometry, line);
}

std::string extension_of(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension != ".obj" && extension != ".stl" && extension != ".ply" && extension != ".glb")
    refuse(file, "unknown kind of mesh file: convert it to OBJ, STL, PLY or binary glTF (.glb)");
  return extension.substr(1);
}

std::string bytes_of(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) refuse(file, "no such file: check the path");
  if (!fs::is_regular_file(status)) refuse(file, "not a file: give an OBJ, STL, PLY or GLB file");
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size > largest_file) refuse(file, "larger than 4 GiB: reduce the mesh");
  std::ifstream in(file, std::ios::binary);
  std::string bytes(size, '\0');
  if (!in || !in.read(bytes.data(), static_cast<std::streamsize>(size)))
    refuse(file, "cannot be read: check its permissions");
  if (bytes.empty()) refuse(file, "the file is empty: export it again");
  return bytes;
}

// ---- in the child -------------------------------------------------------------------------------------------------

struct PointHash {
  std::size_t operator()(const Point& p) const {
    std::uint64_t hash = 1469598103934665603ULL;
    for (const float x : p) {
      std::uint32_t bits;
      std::memcpy(&bits, &x, sizeof bits);
      hash = (hash ^ bits) * 1099511628211ULL;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

/// Welds vertices that share a position, in the order of their first use.
class Welder {
 public:
  void add(const aiMesh& mesh, const aiMatrix4x4& placing) {
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;  // lines and points of an OBJ file
      Triangle triangle;
      for (int k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices)
          throw std::runtime_error("a face names a vertex that does not exist");
        triangle[k] = vertex(placing * mesh.mVertices[face.mIndices[k]]);
      }
      triangles.push_back(triangle);
    }
  }

  std::vector<Point> points;
  std::vector<Triangle> triangles;

 private:
  std::int32_t vertex(const aiVector3D& v) {
    const Point point = {v.x + 0.0f, v.y + 0.0f, v.z + 0.0f};  // -0 becomes 0
    const auto [at, is_new] = known_.try_emplace(point, static_cast<std::int32_t>(points.size()));
    if (is_new) points.push_back(point);
    return at->second;
  }

  std::unordered_map<Point, std::int32_t, PointHash> known_;
};

/// The meshes of a node and those below it, where glTF's nodes put them. A mesh with a skin stays where it is: its
/// bones would move it, at rest back to there.
void add_nodes(Welder& welder, const aiScene& scene, const aiNode& node, const aiMatrix4x4& above) {
  const aiMatrix4x4 placing = above * node.mTransformation;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
    welder.add(mesh, mesh.HasBones() ? aiMatrix4x4() : placing);
  }
  for (unsigned k = 0; k < node.mNumChildren; ++k) add_nodes(welder, scene, *node.mChildren[k], placing);
}

FacesInFile check(std::string& bytes, const std::string& extension) {
  if (extension == "obj") return check_obj(bytes);
  if (extension == "stl") return check_stl(bytes);
  if (extension == "ply") return check_ply(bytes);
  return check_glb(bytes);
}

/// With a wrong extension assimp would go through all its formats; only those of the one asked for stay (two for glTF).
void keep_only(Assimp::Importer& importer, const std::string& extension) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const std::string all = std::string(" ") + importer.GetImporterInfo(i)->mFileExtensions + " ";
    if (all.find(" " + extension + " ") == std::string::npos) importer.UnregisterLoader(importer.GetImporter(i));
  }
}

template <class T> void append(std::string& bytes, const std::vector<T>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

std::string parse(std::string& bytes, const std::string& extension) {
  const FacesInFile expected = check(bytes, extension);
  Assimp::Importer importer;
  keep_only(importer, extension);
  const aiScene* scene =
      importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_Triangulate, extension.c_str());
  if (!scene) throw std::runtime_error(std::string(importer.GetErrorString()).substr(0, 200));
  Welder welder;
  add_nodes(welder, *scene, *scene->mRootNode, aiMatrix4x4());
  const std::size_t got = welder.triangles.size();
  if (got == 0 || (expected.only_triangles && got != expected.faces))
    throw std::runtime_error("only " + std::to_string(got) + " of " + std::to_string(expected.faces) +
                             " triangles could be read");
  std::string answer;
  append(answer, std::vector<std::uint64_t>{welder.points.size(), welder.triangles.size()});
  append(answer, welder.points);
  append(answer, welder.triangles);
  return answer;
}

// ---- in the parent ------------------------------------------------------------------------------------------------

template <class T> bool take(const std::string& bytes, std::size_t& at, std::uint64_t count, std::vector<T>& values) {
  if (count > (bytes.size() - at) / sizeof(T)) return false;
  values.resize(count);
  std::memcpy(values.data(), bytes.data() + at, count * sizeof(T));
  at += count * sizeof(T);
  return true;
}

/// False when the answer is not of the agreed form; the child may have been led astray.
bool unpack(const std::string& answer, TriangleMesh& mesh) {
  std::vector<std::uint64_t> sizes;
  std::vector<Point> points;
  std::size_t at = 0;
  if (!take(answer, at, 2, sizes) || !take(answer, at, sizes[0], points) ||
      !take(answer, at, sizes[1], mesh.triangles) || at != answer.size())
    return false;
  mesh.vertices.reserve(points.size());
  for (const Point& p : points) mesh.vertices.emplace_back(p[0], p[1], p[2]);
  const auto count = static_cast<std::int64_t>(points.size());
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [count](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [count](std::int32_t v) { return v >= 0 && v < count; });
  });
}

void require_sound(const TriangleMesh& mesh, const fs::path& file) {
  Eigen::AlignedBox3d box;
  for (const Vec3& v : mesh.vertices) {
    if (!v.allFinite()) refuse(file, "a vertex is not finite: export the mesh again");
    box.extend(v);
  }
  const double size = box.sizes().maxCoeff();
  if (!(size > 0)) refuse(file, "all its vertices lie at one point: export the mesh again");
  const double farthest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  if (farthest > 1e15) refuse(file, "its coordinates go up to " + std::to_string(farthest) + " m: scale it to metres");
  if (farthest * std::numeric_limits<float>::epsilon() > coarsest * size)
    refuse(file, "its coordinates are too far from the origin for its size (" + std::to_string(farthest) +
                     " m against " + std::to_string(size) +
                     " m): move it near the origin and give `position` in the scene");
}

}  // namespace

TriangleMesh read_mesh(const fs::path& file, const std::function<void()>& waiting) {
  const std::string extension = extension_of(file);
  std::string bytes = bytes_of(file);
  const ChildLimits limits{2 * giga + 100 * bytes.size(),
                           most_seconds + static_cast<int>(bytes.size() / bytes_a_second), largest_answer};
  const ChildAnswer answer = run_in_child([&] { return parse(bytes, extension); }, limits, waiting);
  if (!answer.failure.empty()) refuse(file, answer.failure + ": repair the file or export it again");
  TriangleMesh mesh;
  if (!unpack(answer.bytes, mesh))
    refuse(file, "the reader gave an unsound answer: repair the file or export it again");
  require_sound(mesh, file);
  // An OBJ file does not say how many faces it has.
  if (extension == "obj" && bytes.back() != '\n' && inspect(mesh).open_edges > 0)
    refuse(file,
           "it ends within a line and its surface is open, so it looks truncated: export it again (or end its last "
           "line)");
  return mesh;
}

}  // namespace molten
