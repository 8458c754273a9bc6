#include "client/scenes/renderer.h"

#include <cstdio>
#include <set>

#include "client/scenes/noisy_frame.h"
#include "client/scenes/reference_frame.h"
#include "client/scenes/view.h"
#include "core/frame/error.h"

namespace holdfast::scenes {
namespace {

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.15g", value);
  return text;
}

void check_range(const std::string& name, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw InputError(name, "must lie in " + text_of(low) + ".." + text_of(high), text_of(value));
}

Scene checked(Scene scene, const RenderSettings& settings) {
  check_range("width", settings.width, 1, kMaxDimension);
  check_range("height", settings.height, 1, kMaxDimension);
  check_range("samples per pixel", settings.spp, 1, 1e6);
  check_range("reference samples per pixel", settings.reference_spp, 1, 1e6);
  check_range("speed", settings.speed, 0, 1e6);
  std::set<std::uint32_t> ids;
  for (const Object& object : scene.objects)
    if (object.id == 0 || !ids.insert(object.id).second)
      throw InputError("object " + object.name, "must have an id of its own that is not 0",
                       std::to_string(object.id));
  ids.clear();
  for (const SceneLight& light : scene.lights)
    if (!ids.insert(light.light.id).second)
      throw InputError("light " + std::to_string(light.light.id), "must be listed once",
                       "repeated");
  return scene;
}

/// Adds what moved between two times; in any case if `anyway`.
void fill_table(TransformTable& table, std::uint32_t id, const Motion& motion, double before,
                double now, bool anyway) {
  const glm::dmat4 matrix = motion.at(now).matrix();
  if (anyway || matrix != motion.at(before).matrix()) table[id] = matrix;
}

template <class Item>
bool is_at_rest(const Item& item, double a, double b) {
  return (a < item.from_frame) == (b < item.from_frame) && item.motion.at(a) == item.motion.at(b);
}

}  // namespace

Renderer::Renderer(Scene scene, const RenderSettings& settings)
    : scene_(checked(std::move(scene), settings)), settings_(settings), world_(scene_) {}

std::vector<Light> Renderer::lights() const {
  std::vector<Light> out;
  for (const SceneLight& light : scene_.lights) out.push_back(light.light);
  return out;
}

std::vector<std::pair<std::uint32_t, std::string>> Renderer::objects() const {
  std::vector<std::pair<std::uint32_t, std::string>> out;
  for (const Object& object : scene_.objects) out.emplace_back(object.id, object.name);
  return out;
}

bool Renderer::at_rest_between(double a, double b) const {
  for (const Object& object : scene_.objects)
    if (!is_at_rest(object, a, b)) return false;
  for (const SceneLight& light : scene_.lights)
    if (!is_at_rest(light, a, b)) return false;
  return scene_.camera.motion.at(a) == scene_.camera.motion.at(b);
}

/// Sets the world to `time`; views of another time see that, too.
View Renderer::view_at(double time, std::int64_t index) {
  world_.set_time(time);
  return {scene_,
          world_,
          lights_at(scene_, time),
          camera_at(scene_, time, settings_.width, settings_.height),
          settings_.width,
          settings_.height,
          settings_.seed,
          index};
}

Frame Renderer::frame(std::int64_t index) {
  const double now = time_of(index), before = time_of(index - 1);
  const bool is_first = index == settings_.first_frame;
  Frame frame;
  frame.index = index;
  frame.cut = !is_first && scene_.camera.motion.jumps(before, now);
  frame.camera = camera_at(scene_, now, settings_.width, settings_.height);
  for (const Object& object : scene_.objects)
    if (now >= object.from_frame)
      fill_table(frame.objects, object.id, object.motion, before, now,
                 is_first || before < object.from_frame);
  // A dark light is there all the same: tables tell of motion, not of brightness.
  for (const SceneLight& light : scene_.lights)
    fill_table(frame.lights, light.light.id, light.motion, before, now, is_first);
  const View view = view_at(now, index);
  if (!settings_.gradients) {
    frame.planes = render_noisy(view, settings_.spp);
  } else if (is_first || frame.cut || at_rest_between(before, now)) {
    frame.planes = render_noisy(view, settings_.spp);
    add_empty_gradients(view, frame.planes);
  } else {
    GradientSamples gradients(view);
    frame.planes = render_noisy(view, settings_.spp, &gradients);
    gradients.finish(view_at(before, index), now, before, frame.planes);
  }
  return frame;
}

const PlaneSet& Renderer::reference(std::int64_t index) {
  const double now = time_of(index);
  if (has_reference_ && at_rest_between(reference_time_, now)) return reference_;
  reference_ = render_reference(view_at(now, index), settings_.reference_spp);
  reference_time_ = now;
  has_reference_ = true;
  return reference_;
}

}  // namespace holdfast::scenes
