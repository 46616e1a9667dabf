#include "core/boundary/facet_tree.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <limits>

#include "core/error.h"

namespace molten {
namespace {

/// Part of the walls' size that covers all of Embree's roundings: of boxes, of a ray's start and direction (half a unit
/// each, its length is at most the box's diagonal), and of the products in its box test.
constexpr double round_off = 16 * std::numeric_limits<float>::epsilon();

struct PathContext : RTCIntersectContext {
  double (*visit)(void*, std::int32_t);
  void* visitor;
  double begin, length, slack;  // of the clipped path: fraction at its start, m a fraction, m
};

struct NearContext {
  bool (*visit)(void*, std::int32_t);
  void* visitor;
};

void on_path(const RTCIntersectFunctionNArguments* args) {
  if (args->N != 1 || !args->valid[0]) return;
  auto& path = *static_cast<PathContext*>(args->context);
  auto* ray = reinterpret_cast<RTCRayHit*>(args->rayhit);
  const double last = path.visit(path.visitor, static_cast<std::int32_t>(args->primID));
  const double far = (last - path.begin) * path.length + path.slack;
  if (far < ray->ray.tfar) ray->ray.tfar = std::max(0.0f, static_cast<float>(far));
}

bool on_near(RTCPointQueryFunctionArguments* args) {
  const auto& near = *static_cast<NearContext*>(args->userPtr);
  if (near.visit(near.visitor, static_cast<std::int32_t>(args->primID))) return false;
  args->query->radius = 0;  // nothing more
  return true;
}

}  // namespace

template <int Dim> struct FacetTree<Dim>::Impl {
  std::span<const Facet<Dim>> facets;
  Point<Dim> middle = Point<Dim>::Zero(), half = Point<Dim>::Zero();  // m; of the box around all, grown
  double grow = 0, slack = 0;                                         // m
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Impl(std::span<const Facet<Dim>> all, double margin);
  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
  void bounds(std::int32_t facet, RTCBounds& box) const;
};

template <int Dim> FacetTree<Dim>::Impl::Impl(std::span<const Facet<Dim>> all, double margin) : facets(all) {
  Point<Dim> lo = Point<Dim>::Constant(HUGE_VAL), hi = -lo;
  for (const auto& f : facets)
    for (const auto& c : f.corner) {
      lo = lo.cwiseMin(c);
      hi = hi.cwiseMax(c);
    }
  middle = (lo + hi) / 2;
  slack = round_off * ((hi - lo).norm() + 2 * margin) + std::numeric_limits<double>::epsilon() * middle.norm();
  grow = margin + slack;
  half = (hi - lo) / 2 + Point<Dim>::Constant(grow);
  device = rtcNewDevice("threads=1");  // no threads of its own beside the solver's
  if (!device) throw Error(ExitCode::geometry, "Embree cannot start: check its installation");
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(facets.size()));
  rtcSetGeometryUserData(geometry, this);
  rtcSetGeometryBoundsFunction(
      geometry,
      [](const RTCBoundsFunctionArguments* args) {
        static_cast<const Impl*>(args->geometryUserPtr)
            ->bounds(static_cast<std::int32_t>(args->primID), *args->bounds_o);
      },
      nullptr);
  rtcSetGeometryIntersectFunction(geometry, on_path);
  rtcSetGeometryPointQueryFunction(geometry, on_near);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
    throw Error(ExitCode::geometry, "Embree could not sort the walls' triangles: free memory or reduce the meshes");
}

template <int Dim> void FacetTree<Dim>::Impl::bounds(std::int32_t facet, RTCBounds& box) const {
  float lo[3] = {-1, -1, -1}, hi[3] = {1, 1, 1};  // 2-D: rays run at z = 0
  for (int k = 0; k < Dim; ++k) {
    double a = HUGE_VAL, b = -HUGE_VAL;
    for (const auto& c : facets[facet].corner) {
      a = std::min(a, c[k]);
      b = std::max(b, c[k]);
    }
    lo[k] = static_cast<float>(a - middle[k] - grow);
    hi[k] = static_cast<float>(b - middle[k] + grow);
  }
  box = {lo[0], lo[1], lo[2], 0, hi[0], hi[1], hi[2], 0};
}

template <int Dim>
FacetTree<Dim>::FacetTree(std::span<const Facet<Dim>> facets, double margin)
    : impl_(std::make_unique<Impl>(facets, margin)) {}
template <int Dim> FacetTree<Dim>::~FacetTree() = default;

template <int Dim>
void FacetTree<Dim>::sweep(const Point<Dim>& x, const Point<Dim>& d, OnPath visit, void* visitor) const {
  const Point<Dim> from = x - impl_->middle;
  double first, last;
  if (!part_in_box<Dim>(-impl_->half, impl_->half, from, d, first, last)) return;
  const double length = d.norm();
  // Of a sphere that rests, what it touches is the same along any direction.
  const Point<Dim> start = from + first * d, way = length > 0 ? Point<Dim>(d / length) : Point<Dim>::UnitX();
  PathContext context;
  rtcInitIntersectContext(&context);
  context.visit = visit;
  context.visitor = visitor;
  context.begin = first;
  context.length = length;
  context.slack = impl_->slack;
  RTCRayHit ray{};
  float* const org[3] = {&ray.ray.org_x, &ray.ray.org_y, &ray.ray.org_z};
  float* const dir[3] = {&ray.ray.dir_x, &ray.ray.dir_y, &ray.ray.dir_z};
  for (int k = 0; k < Dim; ++k) {
    *org[k] = static_cast<float>(start[k]);
    *dir[k] = static_cast<float>(way[k]);
  }
  ray.ray.tfar = static_cast<float>((last - first) * length + impl_->slack);
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &context, &ray);
}

template <int Dim> void FacetTree<Dim>::near(const Point<Dim>& x, double reach, OnNear visit, void* visitor) const {
  const Point<Dim> at = x - impl_->middle;
  for (int k = 0; k < Dim; ++k)
    if (!(std::abs(at[k]) <= impl_->half[k] + reach)) return;
  RTCPointQuery query{};
  query.x = static_cast<float>(at[0]);
  query.y = static_cast<float>(at[1]);
  if constexpr (Dim == 3) query.z = static_cast<float>(at[2]);
  query.radius = static_cast<float>((reach + impl_->slack) * (1 + round_off));
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  NearContext near{visit, visitor};
  rtcPointQuery(impl_->scene, &query, &context, nullptr, &near);
}

template class FacetTree<2>;
template class FacetTree<3>;

}  // namespace molten
