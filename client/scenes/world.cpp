#include "client/scenes/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

namespace holdfast::scenes {
namespace {

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using RayScene = std::unique_ptr<RTCSceneTy, ReleaseScene>;

float ray_end(double max_m) { return static_cast<float>(std::min(max_m, 1e30)); }

/// A geometry with the mesh's triangles and room for its vertices.
RTCGeometry make_geometry(RTCDevice device, const Mesh& mesh) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                          mesh.positions.size());
  void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(glm::uvec3), mesh.triangles.size());
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), static_cast<glm::uvec3*>(triangles));
  return geometry;
}

void set_ray(RTCRay& ray, const glm::dvec3& origin, const glm::dvec3& direction, double max_m) {
  const glm::vec3 o(origin), d(direction);
  ray = {};
  ray.org_x = o.x, ray.org_y = o.y, ray.org_z = o.z;
  ray.dir_x = d.x, ray.dir_y = d.y, ray.dir_z = d.z;
  ray.tfar = ray_end(max_m);
  ray.mask = ~0u;
}

alignas(32) constexpr int kAllValid[8] = {-1, -1, -1, -1, -1, -1, -1, -1};

void set_rays(RTCRay8& query, const glm::dvec3& origin, const RayBatch& rays) {
  static_assert(RayBatch::kSize == 8);
  const glm::vec3 o(origin);
  for (std::size_t i = 0; i < 8; ++i) {
    query.org_x[i] = o.x, query.org_y[i] = o.y, query.org_z[i] = o.z;
    query.dir_x[i] = rays.x[i], query.dir_y[i] = rays.y[i], query.dir_z[i] = rays.z[i];
    query.tnear[i] = 0.0f;
    query.tfar[i] = rays.length[i];
    query.time[i] = 0.0f;
    query.mask[i] = ~0u;
    query.id[i] = 0;
    query.flags[i] = 0;
  }
}

}  // namespace

// Triangles are kept in world space in one tree: for scenes of this size a rebuild when something
// moves costs less than instances do for each ray.
struct World::State {
  struct Instance {
    Mesh mesh;
    RTCGeometry geometry = nullptr;  // kept by the scene
    bool is_present = false;
    glm::dmat4 world_from_object{0.0};
    glm::dmat3 normal_from_object{0.0};
  };

  explicit State(const Scene& s) : description(s), device(rtcNewDevice(nullptr)) {
    if (!device) throw std::runtime_error("Embree could not be started");
    tree.reset(rtcNewScene(device.get()));
    rtcSetSceneFlags(tree.get(), RTC_SCENE_FLAG_ROBUST);
    for (std::size_t i = 0; i < s.objects.size(); ++i) {
      Instance& instance = instances.emplace_back();
      instance.mesh = mesh_of_object(s.objects[i]);
      instance.geometry = make_geometry(device.get(), instance.mesh);
      rtcAttachGeometryByID(tree.get(), instance.geometry, static_cast<unsigned>(i));
      rtcReleaseGeometry(instance.geometry);
    }
    move_to(0.0);
  }

  void move_to(double frame) {
    bool has_changed = false;
    for (std::size_t i = 0; i < instances.size(); ++i) {
      const Object& object = description.objects[i];
      has_changed |=
          place(instances[i], object.motion.at(frame).matrix(), frame >= object.from_frame);
    }
    if (has_changed) rtcCommitScene(tree.get());
  }

  /// False if it was like this already.
  static bool place(Instance& instance, const glm::dmat4& world_from_object, bool is_present) {
    const bool has_moved = world_from_object != instance.world_from_object;
    if (!has_moved && is_present == instance.is_present) return false;
    instance.is_present = is_present;
    instance.world_from_object = world_from_object;
    instance.normal_from_object = glm::transpose(glm::inverse(glm::dmat3(world_from_object)));
    auto* positions = static_cast<glm::vec3*>(
        rtcGetGeometryBufferData(instance.geometry, RTC_BUFFER_TYPE_VERTEX, 0));
    for (const glm::vec3& p : instance.mesh.positions)
      *positions++ = glm::vec3(world_from_object * glm::dvec4(p, 1.0));
    rtcUpdateGeometryBuffer(instance.geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    if (is_present)
      rtcEnableGeometry(instance.geometry);
    else
      rtcDisableGeometry(instance.geometry);
    rtcCommitGeometry(instance.geometry);
    return true;
  }

  const Scene& description;
  Device device;
  RayScene tree;
  std::vector<Instance> instances;
};

// One thread builds, so that the tree never depends on the number of threads.
World::World(const Scene& scene) {
  tbb::task_arena(1).execute([&] { state_ = std::make_unique<State>(scene); });
}

World::~World() = default;

void World::set_time(double frame) {
  tbb::task_arena(1).execute([&] { state_->move_to(frame); });
}

std::optional<Hit> World::nearest(const glm::dvec3& origin, const glm::dvec3& direction,
                                  double max_m) const {
  RTCRayHit query;
  set_ray(query.ray, origin, direction, max_m);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(state_->tree.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  Hit hit;
  hit.object = query.hit.geomID;
  const State::Instance& instance = state_->instances[hit.object];
  const glm::uvec3 t = instance.mesh.triangles[query.hit.primID];
  const glm::dvec3 a(instance.mesh.positions[t.x]), b(instance.mesh.positions[t.y]),
      c(instance.mesh.positions[t.z]);
  const auto u = static_cast<double>(query.hit.u), v = static_cast<double>(query.hit.v);
  hit.object_position = a + u * (b - a) + v * (c - a);
  hit.object_normal = glm::normalize(glm::cross(b - a, c - a));
  glm::dvec3 smooth = (1.0 - u - v) * glm::dvec3(instance.mesh.normals[t.x]) +
                      u * glm::dvec3(instance.mesh.normals[t.y]) +
                      v * glm::dvec3(instance.mesh.normals[t.z]);
  if (smooth == glm::dvec3(0.0)) smooth = hit.object_normal;

  hit.position = glm::dvec3(instance.world_from_object * glm::dvec4(hit.object_position, 1.0));
  hit.distance_m = glm::distance(origin, hit.position);
  hit.geometric_normal = glm::normalize(instance.normal_from_object * hit.object_normal);
  if (glm::dot(hit.geometric_normal, direction) > 0.0) hit.geometric_normal = -hit.geometric_normal;
  hit.normal = glm::normalize(instance.normal_from_object * smooth);
  if (glm::dot(hit.normal, hit.geometric_normal) < 0.0) hit.normal = -hit.normal;
  // At a silhouette the interpolated normal may look away from the viewer.
  if (glm::dot(hit.normal, direction) > 0.0) hit.normal = hit.geometric_normal;
  return hit;
}

bool World::occluded(const glm::dvec3& origin, const glm::dvec3& direction, double max_m) const {
  RTCRay ray;
  set_ray(ray, origin, direction, max_m);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(state_->tree.get(), &context, &ray);
  return ray.tfar < 0.0f;
}

void World::nearest(const glm::dvec3& origin, const RayBatch& rays, HitBatch& out) const {
  RTCRayHit8 query;
  set_rays(query.ray, origin, rays);
  for (std::size_t i = 0; i < 8; ++i) query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect8(kAllValid, state_->tree.get(), &context, &query);
  for (std::size_t i = 0; i < 8; ++i) {
    const bool is_hit = query.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    out.object[i] = is_hit ? query.hit.geomID[i] : HitBatch::kNone;
    out.distance[i] = query.ray.tfar[i];
    out.normal_x[i] = query.hit.Ng_x[i];
    out.normal_y[i] = query.hit.Ng_y[i];
    out.normal_z[i] = query.hit.Ng_z[i];
  }
}

unsigned World::occluded(const glm::dvec3& origin, const RayBatch& rays) const {
  RTCRay8 query;
  set_rays(query, origin, rays);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded8(kAllValid, state_->tree.get(), &context, &query);
  unsigned blocked = 0;
  for (unsigned i = 0; i < 8; ++i)
    if (query.tfar[i] < 0.0f) blocked |= 1u << i;
  return blocked;
}

const Mesh& World::mesh(std::size_t object) const { return state_->instances[object].mesh; }

const glm::dmat4& World::world_from_object(std::size_t object) const {
  return state_->instances[object].world_from_object;
}

glm::dvec3 offset_origin(const glm::dvec3& position, const glm::dvec3& geometric_normal) {
  const glm::dvec3 a = glm::abs(position);
  return position + geometric_normal * (1e-4 * std::max({1.0, a.x, a.y, a.z}));
}

}  // namespace holdfast::scenes
