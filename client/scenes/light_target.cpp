#include "client/scenes/light_target.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "client/scenes/glossy.h"
#include "client/scenes/sampling.h"
#include "core/shading/direct_light.h"
#include "core/shading/ltc.h"

namespace holdfast::scenes {
namespace {

constexpr double kLeastAcceptance = 0.125;   // of the proven bound, else the grid is cheaper
constexpr double kLeastGridRoughness = 0.2;  // a highlight still spans cells of the grid
// Of the light on a facing surface; a thinner sliver above the horizon counts as none, as no number
// of samples would tell how much of it is blocked.
constexpr double kLeastShare = 1e-4;
constexpr int kMostTries = 512;  // (7/8)^512 = 2e-30: never reached

/// The rectangle light's corner (+-1, +-1) relative to `point`, world space.
glm::dvec3 corner(const LightState& light, double x, double y, const glm::dvec3& point) {
  const glm::dvec4 local(0.5 * x * light.light.width, 0.5 * y * light.light.height, 0.0, 1.0);
  return glm::dvec3(light.world_from_light * local) - point;
}

/// Smallest squared distance from `point` to the rectangle.
double distance2_to_rectangle(const LightState& light, const glm::dvec3& point) {
  const glm::dvec3 d = point - glm::dvec3(light.world_from_light[3]);
  const glm::dvec3 local = glm::transpose(glm::dmat3(light.world_from_light)) * d;
  const double x = std::max(0.0, std::abs(local.x) - 0.5 * light.light.width);
  const double y = std::max(0.0, std::abs(local.y) - 0.5 * light.light.height);
  return x * x + y * y + local.z * local.z;
}

/// The lobe's unshadowed light from a rectangle, by linearly transformed cosines.
glm::dvec3 transformed_lobe(const LightState& light, const Surface& surface) {
  Light shape = light.light;
  shape.radiance = light.emission;
  ShadingPoint<double> point;
  point.position = surface.position;
  point.normal = surface.normal;
  point.to_viewer = surface.to_viewer;
  point.roughness = surface.roughness;
  point.specular = directional_albedo(
      ltc_lobe(surface.roughness, glm::dot(surface.normal, surface.to_viewer)), surface.specular);
  return unshadowed_light(place_light<double>(shape, light.world_from_light), point);
}

}  // namespace

double rectangle_irradiance(const LightState& light, const glm::dvec3& point,
                            const glm::dvec3& normal) {
  const std::array<glm::dvec3, 4> quad{corner(light, -1, -1, point), corner(light, 1, -1, point),
                                       corner(light, 1, 1, point), corner(light, -1, 1, point)};
  // The light emits along its local -Z: the point must lie on that side.
  if (glm::dot(glm::dvec3(light.world_from_light[2]), quad[0]) <= 0.0) return 0.0;
  std::array<glm::dvec3, 8> polygon;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 &a = quad[i], &b = quad[(i + 1) % 4];
    const double ha = glm::dot(a, normal), hb = glm::dot(b, normal);
    if (ha >= 0.0) polygon[count++] = a;
    if ((ha >= 0.0) != (hb >= 0.0)) polygon[count++] = a + (b - a) * (ha / (ha - hb));
  }
  if (count < 3) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % count];
    const glm::dvec3 c = glm::cross(a, b);
    const double length = glm::length(c);
    if (length > 0.0) sum += std::atan2(length, glm::dot(a, b)) * glm::dot(c, normal) / length;
  }
  return 0.5 * std::abs(sum);
}

LightTarget::LightTarget(const LightState& light, const Surface& surface)
    : light_(light), surface_(surface), lobe_(surface.has_lobe()) {
  if (!light.is_on()) return;
  if (light.is_delta()) {
    LightSample sample = sample_light(light, surface.position, {0.5, 0.5});
    bound_[0] = total_ = density(sample, &unshadowed_);
    return;
  }
  const bool rectangle = light.light.shape == LightShape::kRectangle;
  double irradiance = 0.0;
  if (rectangle) irradiance = rectangle_irradiance(light, surface.position, surface.normal);
  if (rectangle && irradiance <= 0.0) return;
  if (rectangle && !lobe_ &&
      irradiance < kLeastShare * sample_light(light, surface.position, {0.5, 0.5}).geometry)
    return;
  const glm::dvec3 diffuse = light.emission * surface.albedo * (irradiance / std::numbers::pi);
  if (rectangle && !lobe_) {
    unshadowed_ = diffuse;
    if (luminance(diffuse) <= 0.0 || use_proven_bound()) return;
  }
  use_grid();
  if (!rectangle) return;
  if (!lobe_) unshadowed_ = glm::dvec3(0.0);
  if (lobe_ && surface.roughness < kLeastGridRoughness)
    unshadowed_ = transformed_lobe(light, surface);
  unshadowed_ += diffuse;
  if (unshadowed_ == glm::dvec3(0.0)) total_ = 0.0;
}

/// Returns luminance(BRDF * emission) * cosine * geometry; adds the part that has no closed form to
/// `colour` where given.
double LightTarget::density(const LightSample& sample, glm::dvec3* colour) const {
  const double cosine = glm::dot(surface_.normal, sample.direction);
  if (cosine <= 0.0 || sample.geometry <= 0.0) return 0.0;
  const glm::dvec3 flow = light_.emission * (cosine * sample.geometry);
  const glm::dvec3 diffuse = surface_.albedo * std::numbers::inv_pi;
  glm::dvec3 lobe(0.0);
  if (lobe_)
    lobe = evaluate_lobe(surface_, sample.direction,
                         std::max(surface_.roughness, kLeastGridRoughness));
  if (colour)
    *colour += flow * (light_.light.shape == LightShape::kRectangle ? lobe : diffuse + lobe);
  return luminance(flow * (diffuse + lobe));
}

bool LightTarget::use_proven_bound() {
  const glm::dvec3& p = surface_.position;
  double highest = 0.0;
  for (double x : {-1.0, 1.0})
    for (double y : {-1.0, 1.0})
      highest = std::max(highest, glm::dot(surface_.normal, corner(light_, x, y, p)));
  const double height = glm::dot(glm::dvec3(light_.world_from_light[2]), corner(light_, 0, 0, p));
  const double distance2 = distance2_to_rectangle(light_, p);
  const double area = light_.light.width * light_.light.height;
  const double bound = luminance(light_.emission * surface_.albedo) * std::numbers::inv_pi *
                       highest * height * area / (distance2 * distance2);
  if (!(luminance(unshadowed_) >= kLeastAcceptance * bound)) return false;
  bound_[0] = total_ = bound;
  return true;
}

void LightTarget::use_grid() {
  side_ = kGrid;
  constexpr int kCells = kGrid * kGrid;
  glm::dvec3 colour(0.0);
  double sum = 0.0;
  for (int i = 0; i < kCells; ++i) {
    const glm::dvec2 uv = stratified(i, kGrid, {0.5, 0.5});
    const double f = density(sample_light(light_, surface_.position, uv), &colour);
    bound_[static_cast<std::size_t>(i)] = 2.0 * f;
    sum += f;
  }
  unshadowed_ = colour / static_cast<double>(kCells);
  if (sum <= 0.0) return;
  total_ = 0.0;
  for (double& bound : bound_) total_ += bound += 0.5 * sum / kCells;
}

double LightTarget::weight(const glm::dvec2& uv, LightSample& sample) const {
  sample = sample_light(light_, surface_.position, uv);
  // (u, v) may round up to 1.
  const int x = std::min(side_ - 1, static_cast<int>(uv.x * side_));
  const int y = std::min(side_ - 1, static_cast<int>(uv.y * side_));
  const auto cell = static_cast<std::size_t>(y * side_ + x);
  return std::min(density(sample, nullptr), bound_[cell]);
}

glm::dvec2 LightTarget::draw(Rng& rng) const {
  glm::dvec2 uv(0.5);
  if (light_.is_delta()) return uv;
  for (int i = 0; i < kMostTries; ++i) {
    std::size_t cell = 0;
    if (side_ > 1) {
      double left = rng.next() * total_;
      const auto last = static_cast<std::size_t>(side_ * side_ - 1);
      while (cell < last && left >= bound_[cell]) left -= bound_[cell++];
    }
    uv = stratified(static_cast<int>(cell), side_, rng.next2());
    LightSample sample;
    if (rng.next() * bound_[cell] < weight(uv, sample)) break;
  }
  return uv;
}

}  // namespace holdfast::scenes
