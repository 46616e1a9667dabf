#include "core/inside.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/error.h"

namespace molten {
namespace {

struct Crossing {
  double at;  // m
  int turn;   // +1 enters, -1 leaves
};

/// Where the running sum of turns is positive.
void collect(std::vector<Crossing>& crossings, std::vector<Span>& spans) {
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return a.at != b.at ? a.at < b.at : a.turn > b.turn;  // enter before leaving: parts that touch are one span
  });
  spans.clear();
  int winding = 0;
  for (const Crossing& c : crossings) {
    const int before = std::exchange(winding, winding + c.turn);
    if (before <= 0 && winding > 0) spans.push_back({c.at, c.at});
    if (before > 0 && winding <= 0) spans.back().high = c.at;
  }
}

class InsideOutline final : public Inside {
 public:
  explicit InsideOutline(const std::vector<Vec2>& outline);
  void spans(double x, double y, std::vector<Span>& spans) const override;

 private:
  int bucket(double x) const {
    return std::clamp(static_cast<int>((x - low_) * per_metre_), 0, static_cast<int>(edges_.size()) - 1);
  }

  const std::vector<Vec2> points_;
  std::vector<std::vector<int>> edges_;  // by strips of x: the edges that reach into the strip
  double low_ = 0, per_metre_ = 0;
};

InsideOutline::InsideOutline(const std::vector<Vec2>& outline) : points_(outline) {
  const auto [left, right] =
      std::minmax_element(points_.begin(), points_.end(), [](const Vec2& a, const Vec2& b) { return a.x() < b.x(); });
  const int edges = static_cast<int>(points_.size()), strips = std::min(edges, 1024);
  low_ = left->x();
  per_metre_ = strips / std::max(right->x() - left->x(), 1e-300);
  edges_.resize(strips);
  for (int e = 0; e < edges; ++e) {
    const double a = points_[e].x(), b = points_[(e + 1) % edges].x();
    for (int s = bucket(std::min(a, b)); s <= bucket(std::max(a, b)); ++s) edges_[s].push_back(e);
  }
}

void InsideOutline::spans(double x, double, std::vector<Span>& spans) const {
  std::vector<Crossing> crossings;
  for (const int e : edges_[bucket(x)]) {
    const Vec2 &a = points_[e], &b = points_[(e + 1) % points_.size()];
    // Half open in x: a line through a corner meets exactly one of two edges that go on, and both or none that turn
    // back.
    if ((a.x() <= x) == (b.x() <= x)) continue;
    crossings.push_back({a.y() + (x - a.x()) * (b.y() - a.y()) / (b.x() - a.x()), a.x() < b.x() ? 1 : -1});
  }
  collect(crossings, spans);
}

// ---- 3-D: Embree finds the triangles that a vertical line meets; where it meets them is computed again in double
// -----

// In units of the mesh: how far a line is moved that grazes an edge, and how near to an edge (barycentric) grazes.
constexpr double nudge = 2e-6, graze = 1e-6;
constexpr int nudges = 12;

struct Hit {
  unsigned triangle;
  float u, v;
};

/// Embree hands a filter this context; all hits of the ray are noted and refused, so that the ray goes on.
struct AllHits : RTCIntersectContext {
  std::vector<Hit> hits;
};

void note_hit(const RTCFilterFunctionNArguments* args) {
  const RTCHit hit = rtcGetHitFromHitN(args->hit, args->N, 0);
  static_cast<AllHits*>(args->context)->hits.push_back({hit.primID, hit.u, hit.v});
  args->valid[0] = 0;
}

template <class T, void (*release)(T)> struct Release {
  using pointer = T;
  void operator()(T handle) const { release(handle); }
};
using Device = std::unique_ptr<RTCDevice, Release<RTCDevice, rtcReleaseDevice>>;
using EmbreeScene = std::unique_ptr<RTCScene, Release<RTCScene, rtcReleaseScene>>;

class InsideMesh final : public Inside {
 public:
  explicit InsideMesh(const TriangleMesh& mesh);
  void spans(double x, double y, std::vector<Span>& spans) const override;

 private:
  void build();
  void cast(double x, double y, AllHits& context) const;

  std::vector<Vec3> vertices_;  // centred, largest extent 1: Embree works in single precision
  const std::vector<std::array<std::int32_t, 3>> triangles_;
  Vec3 centre_;
  double scale_ = 1;  // units a metre
  Device device_{rtcNewDevice("threads=1")};
  EmbreeScene scene_;
};

InsideMesh::InsideMesh(const TriangleMesh& mesh) : vertices_(mesh.vertices), triangles_(mesh.triangles) {
  Eigen::AlignedBox3d bounds;
  for (const auto& t : triangles_)
    for (const int v : t) bounds.extend(vertices_[v]);
  centre_ = bounds.center();
  scale_ = 1 / std::max(bounds.sizes().maxCoeff(), 1e-300);
  for (Vec3& v : vertices_) v = (v - centre_) * scale_;
  build();
}

void InsideMesh::build() {
  if (!device_) throw Error(ExitCode::geometry, "Embree could not start");
  scene_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);  // no ray slips between two triangles
  const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                             3 * sizeof(float), vertices_.size()));
  auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), triangles_.size()));
  if (!points || !corners) throw Error(ExitCode::geometry, "the mesh does not fit in memory");
  for (const Vec3& v : vertices_)
    for (int k = 0; k < 3; ++k) *points++ = static_cast<float>(v[k]);
  for (const auto& t : triangles_)
    for (const int v : t) *corners++ = static_cast<unsigned>(v);
  rtcSetGeometryIntersectFilterFunction(geometry, note_hit);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_.get());
}

void InsideMesh::cast(double x, double y, AllHits& context) const {
  context.hits.clear();
  RTCRayHit ray{};
  ray.ray = {static_cast<float>(x),
             static_cast<float>(y),
             -1.0f,
             0.0f,
             0.0f,
             0.0f,
             1.0f,
             0.0f,
             std::numeric_limits<float>::infinity(),
             ~0u,
             0,
             0};
  ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_.get(), &context, &ray);
  // Embree may hand the same triangle over twice.
  auto& hits = context.hits;
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.triangle < b.triangle; });
  hits.erase(std::unique(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.triangle == b.triangle; }),
             hits.end());
}

// A line that grazes an edge or a vertex may meet both, one or none of the triangles there. It is then moved aside by
// some millionths of the mesh, first towards +x +y, so that a column on a box's far face is outside.
void InsideMesh::spans(double x_metres, double y_metres, std::vector<Span>& spans) const {
  const double x = (x_metres - centre_.x()) * scale_, y = (y_metres - centre_.y()) * scale_;
  AllHits context;
  rtcInitIntersectContext(&context);
  std::vector<Crossing> crossings;
  bool found = false;
  for (int attempt = 0; attempt <= nudges; ++attempt) {
    const double angle = 0.6 + 2.4 * (attempt - 1);  // radians; successive angles are far apart
    const double px = x + attempt * nudge * std::cos(angle), py = y + attempt * nudge * std::sin(angle);
    cast(px, py, context);
    crossings.clear();
    int sum = 0;
    bool grazes = false;
    for (const Hit& hit : context.hits) {
      const auto& t = triangles_[hit.triangle];
      const Vec3& a = vertices_[t[0]];
      const Vec3 normal = (vertices_[t[1]] - a).cross(vertices_[t[2]] - a);
      if (normal.z() == 0) {
        grazes = true;
        continue;
      }
      const double z = a.z() - (normal.x() * (px - a.x()) + normal.y() * (py - a.y())) / normal.z();
      crossings.push_back({z / scale_ + centre_.z(), normal.z() < 0 ? 1 : -1});
      sum += crossings.back().turn;
      grazes = grazes || std::min({hit.u, hit.v, 1 - hit.u - hit.v}) < graze;
    }
    if (sum != 0 || (grazes && found)) continue;
    collect(crossings, spans);
    found = true;
    if (!grazes) return;
  }
  if (!found)
    throw Error(ExitCode::geometry,
                "the surface has a hole or reversed triangles near x = " + std::to_string(x_metres) +
                    " m, y = " + std::to_string(y_metres) + " m: close it and orient it outwards");
}

}  // namespace

std::unique_ptr<Inside> inside_of(const TriangleMesh& mesh) { return std::make_unique<InsideMesh>(mesh); }

std::unique_ptr<Inside> inside_of(const std::vector<Vec2>& outline) {
  if (outline.size() < 3) throw Error(ExitCode::usage, "an outline needs at least 3 points");
  return std::make_unique<InsideOutline>(outline);
}

}  // namespace molten
