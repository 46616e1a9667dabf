// Mesh files: the three formats agree, and damaged or hostile files end in one clear line.
#include "io/geometry/mesh_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <ctime>
#include <limits>
#include <random>

#include "core/boundary/shapes.h"
#include "core/error.h"
#include "io/geometry/child_process.h"
#include "tests/temp_folder.h"

namespace molten::mesh_file_test {
namespace {

using Triangle = std::array<std::int32_t, 3>;

TriangleMesh ball() {
  Shape shape;
  shape.sphere = Sphere{{1, 2, 3}, 0.5};
  return tessellate(shape, 0.1);
}

std::string line(const char* key, const Vec3& v) {
  return std::string(key) + " " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) +
         "\n";
}

std::string obj(const TriangleMesh& mesh) {
  std::string text = "mtllib nothing.mtl\nusemtl red\n";
  for (const Vec3& v : mesh.vertices) text += line("v", v);
  for (const Triangle& t : mesh.triangles)
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
  return text;
}

std::string text_stl(const TriangleMesh& mesh) {
  std::string text = "solid a vertex in the name\n";
  for (const Triangle& t : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int v : t) text += line("vertex", mesh.vertices[v]);
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}

template <class T> void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append_point(std::string& bytes, const Vec3& v) {
  for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(v[k]));
}

std::string binary_stl(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    append_point(bytes, Vec3::Zero());
    for (const int v : t) append_point(bytes, mesh.vertices[v]);
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string ply_header(const char* format, std::size_t vertices, std::size_t faces) {
  return std::string("ply\nformat ") + format + " 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string text_ply(const TriangleMesh& mesh) {
  std::string text = ply_header("ascii", mesh.vertices.size(), mesh.triangles.size());
  for (const Vec3& v : mesh.vertices)
    text += std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) + "\n";
  for (const Triangle& t : mesh.triangles)
    text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  return text;
}

std::string binary_ply(const TriangleMesh& mesh) {
  std::string bytes = ply_header("binary_little_endian", mesh.vertices.size(), mesh.triangles.size());
  for (const Vec3& v : mesh.vertices) append_point(bytes, v);
  for (const Triangle& t : mesh.triangles) {
    bytes += '\3';
    for (const std::int32_t v : t) append(bytes, v);
  }
  return bytes;
}

class MeshFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& bytes) {
    write_bytes(folder_.path() / name, bytes);
    return folder_.path() / name;
  }

  /// The line of the refusal; empty when the file was read.
  std::string refusal(const std::string& name, const std::string& bytes) { return refusal(write(name, bytes)); }
  std::string refusal(const std::filesystem::path& file) {
    try {
      read_mesh(file);
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_EQ(error.code(), ExitCode::geometry);
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      EXPECT_NE(what.find(file.filename().string()), std::string::npos) << what;
      EXPECT_LT(what.size(), 600u);
      return what;
    }
    return "";
  }

  TempFolder folder_;
};

TEST_F(MeshFile, AllFormatsGiveTheSameClosedMesh) {
  const TriangleMesh mesh = ball();
  const std::pair<const char*, std::string> files[] = {{"a.obj", obj(mesh)},
                                                       {"text.stl", text_stl(mesh)},
                                                       {"b.STL", binary_stl(mesh)},
                                                       {"text.ply", text_ply(mesh)},
                                                       {"c.ply", binary_ply(mesh)}};
  for (const auto& [name, bytes] : files) {
    const TriangleMesh read = read_mesh(write(name, bytes));
    EXPECT_EQ(read.vertices.size(), mesh.vertices.size()) << name;
    EXPECT_EQ(read.triangles.size(), mesh.triangles.size()) << name;
    EXPECT_NEAR(signed_volume(read), signed_volume(mesh), 1e-5) << name;
    EXPECT_NO_THROW(require_closed(read, name));
  }
}

/// A tetrahedron of corners (0, 0, 0) and the unit vectors, its node twice as large and shifted by (1, 2, 3); `placing`
/// says so.
std::string glb_tetrahedron(const std::string& placing = R"("scale":[2,2,2],"translation":[1,2,3])",
                            int last_corner = 3, const std::string& corners = "12") {
  std::string data;
  for (const Vec3& v : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) append_point(data, v);
  for (const int i : {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, last_corner}) append(data, static_cast<std::uint16_t>(i));
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"buffers":[{"byteLength":72}],)"
      R"("nodes":[{"mesh":0,)" +
      placing +
      R"(}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},)"
      R"({"bufferView":1,"componentType":5123,"count":)" +
      corners + R"(,"type":"SCALAR"}]})";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  append(bytes, std::uint32_t{2});
  append(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + data.size()));
  append(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  append(bytes, static_cast<std::uint32_t>(data.size()));
  bytes.append("BIN\0", 4);
  return bytes + data;
}

TEST_F(MeshFile, BinaryGltfIsReadWhereItsNodesPutIt) {
  const TriangleMesh mesh = read_mesh(write("a.glb", glb_tetrahedron()));
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_NEAR(signed_volume(mesh), 8.0 / 6, 1e-6);
  EXPECT_NO_THROW(require_closed(mesh, "a.glb"));
  for (const Vec3& v : mesh.vertices) EXPECT_GE((v - Vec3(1, 2, 3)).minCoeff(), -1e-6);
}

TEST_F(MeshFile, TruncatedGltfIsRefused) {
  const std::string bytes = glb_tetrahedron();
  for (const double part : {0.01, 0.3, 0.8, 0.99})
    EXPECT_NE(refusal("a.glb", bytes.substr(0, static_cast<std::size_t>(part * bytes.size()))), "") << part;
}

TEST_F(MeshFile, GltfWithFacesOfNothingIsRefused) {
  const std::string placing = R"("scale":[1,1,1])";
  EXPECT_EQ(refusal("a.glb", glb_tetrahedron(placing)), "");
  EXPECT_NE(refusal("a.glb", glb_tetrahedron(placing, 4)).find("names vertex 4 of 4"), std::string::npos);
  EXPECT_NE(refusal("a.glb", glb_tetrahedron(placing, 3, "11")).find("no whole triangles"), std::string::npos);
  EXPECT_NE(refusal("a.glb", glb_tetrahedron(placing, 3, "399")).find("truncated"), std::string::npos);
}

TEST_F(MeshFile, GltfWithAPlacingThatIsNoneIsRefused) {
  const auto complaint = [&](const std::string& placing) { return refusal("a.glb", glb_tetrahedron(placing)); };
  EXPECT_EQ(complaint(R"("matrix":[1,0,0,0,0,0,1,0,0,-1,0,0,3,0,0,1])"), "");
  for (const auto& [placing, what] :
       std::vector<std::array<std::string, 2>>{{R"("matrix":[0,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1])", "flattens"},
                                               {R"("matrix":[1,0,0,5,0,1,0,0,0,0,1,0,0,0,0,1])", "last row"},
                                               {R"("matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,0])", "last row"},
                                               {R"("matrix":[1,0,0,0,0,1,0,0,0])", "needs 16 numbers"},
                                               {R"("matrix":["a",0,0,0,0,1,0,0,0,0,1,0,0,0,0,1])", "needs 16 numbers"},
                                               {R"("matrix":[1e30,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1])", "below 1e15"},
                                               {R"("scale":[1,0,1])", "scales by 0"},
                                               {R"("translation":[1,2])", "needs 3 numbers"}})
    EXPECT_NE(complaint(placing).find(what), std::string::npos) << placing << ": " << complaint(placing);
}

TEST_F(MeshFile, TheHandIsClosed) {
  const std::filesystem::path hand = MOLTEN_SOURCE_DIR "/scenes/models/hand.glb";
  if (!std::filesystem::exists(hand)) GTEST_SKIP() << "scenes/models is empty: run scripts/models";
  const TriangleMesh mesh = read_mesh(hand);
  EXPECT_EQ(mesh.triangles.size(), 2314u);
  EXPECT_NO_THROW(require_closed(mesh, "hand.glb"));
}

TEST_F(MeshFile, PolygonsAreCutIntoTriangles) {
  const std::string cube =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1/1 2/2 6/3 5/4\nf 2//1 3//1 7//1 6//1\nf -6 -5 -1 \\\n -2\nf 4 1 5 8\nl 1 2\n";
  const TriangleMesh mesh = read_mesh(write("cube.obj", cube));
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_NEAR(signed_volume(mesh), 1, 1e-6);
  require_closed(mesh, "cube");
}

TEST_F(MeshFile, WhatIsNoMeshFileIsRefused) {
  const std::string missing = refusal(folder_.path() / "other.obj");
  EXPECT_NE(missing.find("no such file"), std::string::npos) << missing;
  EXPECT_NE(refusal(folder_.path()), "");
  EXPECT_NE(refusal("notes.txt", "hello"), "");
}

TEST_F(MeshFile, TruncatedFilesAreRefused) {
  const TriangleMesh mesh = ball();
  const std::pair<const char*, std::string> files[] = {{"text.stl", text_stl(mesh)},
                                                       {"b.stl", binary_stl(mesh)},
                                                       {"text.ply", text_ply(mesh)},
                                                       {"b.ply", binary_ply(mesh)}};
  for (const auto& [name, bytes] : files)
    for (const double part : {0.01, 0.3, 0.5, 0.8, 0.99, 0.999})
      EXPECT_NE(refusal(name, bytes.substr(0, static_cast<std::size_t>(part * bytes.size()))), "")
          << name << " " << part;
  // An OBJ file promises no number of faces: what is left of it is read, and found open.
  const std::string bytes = obj(mesh);
  const std::size_t cut = bytes.find("\nf ", bytes.size() / 2 + 2000);
  EXPECT_THROW(require_closed(read_mesh(write("cut.obj", bytes.substr(0, cut + 1))), "cut.obj"), Error);
  EXPECT_NE(refusal("cut.obj", bytes.substr(0, cut + 4)), "");
  EXPECT_NE(refusal("cut.obj", bytes.substr(0, cut)).find("truncated"), std::string::npos);
  EXPECT_EQ(refusal("whole.obj", bytes.substr(0, bytes.size() - 1)), "");
  EXPECT_NE(refusal("cut.obj", bytes.substr(0, bytes.find("\nf ") - 3)), "");
}

TEST_F(MeshFile, FacesOfMissingVerticesAreRefused) {
  EXPECT_NE(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n").find("line 4"), std::string::npos);
  EXPECT_NE(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"), "");
  EXPECT_NE(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n"), "");
  EXPECT_NE(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n"), "");
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_NE(refusal("a.ply", ply_header("ascii", 3, 1) + vertices + "3 0 1 3\n"), "");
  EXPECT_NE(refusal("a.ply", ply_header("ascii", 3, 1) + vertices + "3 0 1 -1\n"), "");
}

TEST_F(MeshFile, NoTrianglesIsRefused) {
  for (const char* name : {"a.obj", "a.stl", "a.ply"}) EXPECT_NE(refusal(name, "").find("empty"), std::string::npos);
  EXPECT_NE(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "");
  EXPECT_NE(refusal("a.stl", "solid x\nendsolid x\n"), "");
  EXPECT_NE(refusal("b.stl", binary_stl({})), "");
  EXPECT_NE(refusal("a.ply", ply_header("ascii", 1, 0) + "0 0 0\n"), "");
  EXPECT_NE(refusal("a.ply", ply_header("ascii", 0, 0)), "");
}

TEST_F(MeshFile, NonFiniteVerticesAreRefused) {
  TriangleMesh mesh = ball();
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    mesh.vertices[7].y() = bad;
    EXPECT_NE(refusal("a.obj", obj(mesh)), "");
    EXPECT_NE(refusal("a.stl", text_stl(mesh)), "");
    EXPECT_NE(refusal("a.ply", text_ply(mesh)), "");
    if (bad == 1e300) continue;  // not a float
    EXPECT_NE(refusal("b.stl", binary_stl(mesh)), "");
    EXPECT_NE(refusal("b.ply", binary_ply(mesh)), "");
  }
}

TEST_F(MeshFile, HugeCountsInHeadersAreRefusedAtOnce) {
  std::string stl = binary_stl(ball());
  const std::uint32_t huge = 0xffffffffu;
  std::memcpy(stl.data() + 80, &huge, 4);
  EXPECT_NE(refusal("a.stl", stl), "");
  const std::string body(1000, '\1');
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    EXPECT_NE(refusal("a.ply", ply_header(format, 18446744073709551615ull, 1) + body), "");
    EXPECT_NE(refusal("a.ply", ply_header(format, 3, 4000000000ull) + body), "");
  }
  std::string list = "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty list uint float x\nend_header\n";
  EXPECT_NE(refusal("a.ply", list + "\xff\xff\xff\xff" + body), "");
  EXPECT_NE(
      refusal("a.ply", "ply\nformat ascii 1.0\nelement vertex 999999999999\nelement face 999999999999\nend_header\n"),
      "");
}

TEST_F(MeshFile, RandomBytesAreRefused) {
  std::mt19937 random(1);
  for (const char* name : {"a.obj", "a.stl", "a.ply"})
    for (int i = 0; i < 10; ++i) {
      std::string bytes(1 + random() % 5000, '\0');
      for (char& c : bytes) c = static_cast<char>(random());
      EXPECT_NE(refusal(name, bytes), "") << name;
    }
}

// Damaged in a few bytes: read or refused, never a crash of this process.
TEST_F(MeshFile, DamagedBytesDoNoHarm) {
  std::mt19937 random(2);
  const TriangleMesh mesh = ball();
  const std::pair<const char*, std::string> files[] = {{"a.obj", obj(mesh)},
                                                       {"text.stl", text_stl(mesh)},
                                                       {"b.stl", binary_stl(mesh)},
                                                       {"text.ply", text_ply(mesh)},
                                                       {"b.ply", binary_ply(mesh)}};
  for (const auto& [name, bytes] : files)
    for (int i = 0; i < 15; ++i) {
      std::string damaged = bytes;
      for (int k = 0; k < 4; ++k)
        damaged[random() % (k < 2 ? 300 : damaged.size())] = static_cast<char>(k % 2 ? random() : ' ' + random() % 95);
      refusal(name, damaged);
    }
}

TEST_F(MeshFile, TooFarForSinglePrecisionIsRefused) {
  TriangleMesh mesh = ball();
  for (Vec3& v : mesh.vertices) v.x() += 5e6;
  EXPECT_NE(refusal("far.obj", obj(mesh)).find("far from the origin"), std::string::npos);
}

TEST(MeshReport, FindsDefects) {
  const TriangleMesh good = ball();
  EXPECT_EQ(inspect(good).open_edges + inspect(good).flipped_edges + inspect(good).degenerate_triangles, 0u);
  EXPECT_NO_THROW(require_closed(good, "ball"));
  const auto refusal = [](const TriangleMesh& mesh) {
    try {
      require_closed(mesh, "ball.obj");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::geometry);
      return std::string(error.what());
    }
    return std::string();
  };

  TriangleMesh open = good;
  const Triangle lost = open.triangles[10];
  open.triangles.erase(open.triangles.begin() + 10);
  EXPECT_EQ(inspect(open).open_edges, 3u);
  double nearest = 1;
  for (int k = 0; k < 3; ++k) {
    const Vec3 middle = (good.vertices[lost[k]] + good.vertices[lost[(k + 1) % 3]]) / 2;
    nearest = std::min(nearest, (middle - inspect(open).first_defect).norm());
  }
  EXPECT_LT(nearest, 1e-12);
  EXPECT_NE(refusal(open).find("3 open edges"), std::string::npos);

  TriangleMesh flipped = good;
  std::swap(flipped.triangles[10][0], flipped.triangles[10][1]);
  EXPECT_EQ(inspect(flipped).flipped_edges, 3u);
  EXPECT_EQ(inspect(flipped).open_edges, 0u);
  EXPECT_NE(refusal(flipped).find("opposite ways"), std::string::npos);

  TriangleMesh inverted = good;
  for (Triangle& t : inverted.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(inspect(inverted).flipped_edges, 0u);
  EXPECT_LT(inspect(inverted).volume, 0);
  EXPECT_NE(refusal(inverted).find("inside out"), std::string::npos);

  TriangleMesh degenerate = good;
  degenerate.triangles.push_back({0, 1, 1});
  EXPECT_EQ(inspect(degenerate).degenerate_triangles, 1u);
  EXPECT_NO_THROW(require_closed(degenerate, "ball"));  // its edges cancel
  EXPECT_NE(refusal({}), "");
  EXPECT_NE(refusal({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}}), "");  // flat
}

TEST(ChildProcess, LimitsHold) {
  const ChildLimits limits{std::size_t{256} << 20, 1, 1 << 20};
  EXPECT_EQ(run_in_child([] { return std::string("fine"); }, limits).bytes, "fine");
  EXPECT_EQ(run_in_child([]() -> std::string { throw std::runtime_error("no"); }, limits).failure, "no");
  EXPECT_NE(run_in_child([]() -> std::string { std::abort(); }, limits).failure, "");
  EXPECT_NE(run_in_child([] { return std::string(2 << 20, 'x'); }, limits).failure, "");
  const auto forever = [] {
    while (std::clock() >= 0) {
    }
    return std::string();
  };
  EXPECT_NE(run_in_child(forever, limits).failure.find("took more than 1 s"), std::string::npos);
  const auto hungry = [] { return std::string(std::size_t{1} << 30, 'x'); };
  EXPECT_NE(run_in_child(hungry, limits).failure, "");  // the words differ under a sanitizer
}

TEST(MeshFileModels, Bunny) {
  const std::filesystem::path file = std::filesystem::path(MOLTEN_SOURCE_DIR) / "scenes/models/bunny.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "run scripts/models to fetch the models";
  const TriangleMesh bunny = read_mesh(file);
  EXPECT_EQ(bunny.vertices.size(), 1839u);
  EXPECT_EQ(bunny.triangles.size(), 3674u);
  require_closed(bunny, file.string());
  EXPECT_NEAR(signed_volume(bunny), 194.288, 1e-3);
}

}  // namespace
}  // namespace molten::mesh_file_test
