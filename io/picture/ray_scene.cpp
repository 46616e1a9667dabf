#include "io/picture/ray_scene.h"

#include <embree3/rtcore.h>

#include <limits>
#include <new>

#include "core/error.h"

namespace molten::picture {
namespace {

constexpr unsigned sphere_geometry = 0, two_sided_geometry = 1, one_sided_geometry = 2;

[[noreturn]] void fail(const std::string& reason) { throw Error(ExitCode::files, "picture: Embree: " + reason); }

void* buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t item, std::size_t count) {
  void* data = rtcSetNewGeometryBuffer(geometry, type, 0, format, item, count);
  if (!data) throw std::bad_alloc();
  return data;
}

// One-sided walls: an eye's ray passes them from behind, and so does light. A shadow's ray runs against the light,
// hence the two signs. For rays one by one and in packets.
template <int Sign> void ignore_back(const RTCFilterFunctionNArguments* args) {
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const float along = RTCRayN_dir_x(args->ray, args->N, i) * RTCHitN_Ng_x(args->hit, args->N, i) +
                        RTCRayN_dir_y(args->ray, args->N, i) * RTCHitN_Ng_y(args->hit, args->N, i) +
                        RTCRayN_dir_z(args->ray, args->N, i) * RTCHitN_Ng_z(args->hit, args->N, i);
    if (Sign * along > 0) args->valid[i] = 0;
  }
}

}  // namespace

struct RayScene::Embree {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = device ? rtcNewScene(device) : nullptr;

  Embree() {
    if (!scene) fail("cannot start");
    // Embree's default cuts corners where rays pass edges of large triangles.
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  }
  ~Embree() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  void attach(RTCGeometry geometry, unsigned id) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  }

  void add_spheres(std::span<const Vec3f> centers, float radius) {
    if (centers.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* out = static_cast<float*>(
        buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4 * sizeof(float), centers.size()));
    for (const Vec3f& center : centers) {
      for (int axis = 0; axis < 3; ++axis) *out++ = center[axis];
      *out++ = radius;
    }
    attach(geometry, sphere_geometry);
  }

  void add_walls(const Walls& walls, unsigned id) {
    if (walls.triangles.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* corners = static_cast<float*>(
        buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3 * sizeof(float), walls.vertices.size()));
    for (const Vec3f& vertex : walls.vertices)
      for (int axis = 0; axis < 3; ++axis) *corners++ = vertex[axis];
    auto* indices = static_cast<unsigned*>(
        buffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), walls.triangles.size()));
    for (const auto& triangle : walls.triangles)
      for (const std::uint32_t corner : triangle) *indices++ = corner;
    if (id == one_sided_geometry) {
      rtcSetGeometryIntersectFilterFunction(geometry, ignore_back<1>);
      rtcSetGeometryOccludedFilterFunction(geometry, ignore_back<-1>);
    }
    attach(geometry, id);
  }
};

RayScene::RayScene(std::span<const Vec3f> centers, float radius, const Walls& two_sided, const Walls& one_sided)
    : embree_(std::make_unique<Embree>()) {
  embree_->add_spheres(centers, radius);
  embree_->add_walls(two_sided, two_sided_geometry);
  embree_->add_walls(one_sided, one_sided_geometry);
  rtcCommitScene(embree_->scene);
  if (rtcGetDeviceError(embree_->device) != RTC_ERROR_NONE) fail("cannot build its tree; is there memory left?");
}

RayScene::~RayScene() = default;

Hit RayScene::first_hit(const Ray& ray) const {
  RTCRayHit query{};
  query.ray.org_x = ray.origin.x(), query.ray.org_y = ray.origin.y(), query.ray.org_z = ray.origin.z();
  query.ray.dir_x = ray.direction.x(), query.ray.dir_y = ray.direction.y(), query.ray.dir_z = ray.direction.z();
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(embree_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  const auto what = query.hit.geomID == sphere_geometry ? Hit::What::sphere : Hit::What::wall;
  Vec3f normal = Vec3f(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized();
  if (normal.dot(ray.direction) > 0) normal = -normal;
  return {what, query.hit.primID, ray.origin + query.ray.tfar * ray.direction, normal};
}

std::array<float, RayScene::rays> RayScene::free_ways(const Vec3f& origin, const std::array<Vec3f, rays>& directions,
                                                      const std::array<float, rays>& reach) const {
  alignas(32) RTCRay8 query{};
  alignas(32) int valid[rays];
  for (int i = 0; i < rays; ++i) {
    valid[i] = reach[i] > 0 ? -1 : 0;
    query.org_x[i] = origin.x(), query.org_y[i] = origin.y(), query.org_z[i] = origin.z();
    query.dir_x[i] = directions[i].x(), query.dir_y[i] = directions[i].y(), query.dir_z[i] = directions[i].z();
    query.tfar[i] = reach[i];
    query.mask[i] = ~0u;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded8(valid, embree_->scene, &context, &query);
  std::array<float, rays> free{};
  for (int i = 0; i < rays; ++i) free[i] = valid[i] && query.tfar[i] >= 0 ? 1.0f : 0.0f;
  return free;
}

}  // namespace molten::picture
