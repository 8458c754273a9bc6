#include "client/measure/trade.h"

#include <algorithm>
#include <cmath>

namespace holdfast::measure {
namespace {

bool has_preset(const TradePoint& point, const char* preset) {
  return std::find(point.presets.begin(), point.presets.end(), preset) != point.presets.end();
}

const TradePoint* balanced(const TradeScene& scene) {
  for (const TradePoint& point : scene.points)
    if (point.recipe == "reliable" && has_preset(point, "balanced")) return &point;
  return nullptr;
}

const TradePoint* same_setting(const std::vector<TradePoint>& points, const TradePoint& point) {
  for (const TradePoint& other : points)
    if (other.wire == point.wire && other.recipe == point.recipe &&
        other.kernel_taps == point.kernel_taps && other.more_levels == point.more_levels &&
        other.basis == point.basis && other.half == point.half && other.history == point.history)
      return &other;
  return nullptr;
}

/// Means over the scenes of what all of them have among `points`.
std::vector<TradePoint> means_of(const std::vector<TradeScene>& scenes,
                                 std::vector<TradePoint> TradeScene::*points) {
  std::vector<TradePoint> means;
  const auto count = static_cast<double>(scenes.size());
  for (const TradePoint& point : scenes.front().*points) {
    TradePoint mean = point;
    mean.stages.clear();
    double time = 0, error = 0, composite = 0, bytes = 0, history = 0, wire = 0, ssim = 0;
    bool everywhere = true;
    for (const TradeScene& scene : scenes) {
      const TradePoint* own = same_setting(scene.*points, point);
      everywhere &= own != nullptr;
      if (own == nullptr) continue;
      time += std::log(own->ms / balanced(scene)->ms);
      error += std::log(own->rmse / balanced(scene)->rmse);
      composite += std::log(own->composite_rmse / balanced(scene)->composite_rmse);
      bytes += std::log(own->bytes_per_pixel);
      history += own->history_bytes_per_pixel;
      wire += own->wire_bytes_per_pixel;
      ssim += own->ssim;
    }
    if (!everywhere) continue;
    mean.ms = std::exp(time / count);
    mean.rmse = std::exp(error / count);
    mean.composite_rmse = std::exp(composite / count);
    mean.bytes_per_pixel = std::exp(bytes / count);
    mean.history_bytes_per_pixel = history / count;
    mean.wire_bytes_per_pixel = wire / count;
    mean.ssim = ssim / count;
    means.push_back(mean);
  }
  return means;
}

std::vector<TradeScene::Deviation> deviations_over(const std::vector<TradeScene>& scenes) {
  std::vector<TradeScene::Deviation> all;
  std::vector<int> counts;
  for (const TradeScene& scene : scenes)
    for (const TradeScene::Deviation& own : scene.deviations) {
      auto known = std::find_if(all.begin(), all.end(), [&](const TradeScene::Deviation& other) {
        return other.preset == own.preset && other.layer == own.layer;
      });
      if (known == all.end()) {
        known = all.insert(all.end(), {own.preset, own.layer, 0, 0});
        counts.push_back(0);
      }
      known->typical += own.typical * own.typical;
      known->largest = std::max(known->largest, own.largest);
      ++counts[static_cast<std::size_t>(known - all.begin())];
    }
  for (std::size_t k = 0; k < all.size(); ++k)
    all[k].typical = std::sqrt(all[k].typical / counts[k]);
  return all;
}

}  // namespace

std::string point_name(const TradePoint& point) {
  std::string name = point.recipe;
  for (const std::string& preset : point.presets)
    name += (&preset == &point.presets.front() ? " " : ", ") + preset;
  if (!point.presets.empty()) return point.wire == "exact" ? name : name + ", wire " + point.wire;
  name += " " + std::to_string(point.kernel_taps) + " taps";
  if (point.more_levels != 0)
    name += (point.more_levels > 0 ? " +" : " ") + std::to_string(point.more_levels) + " levels";
  if (!point.basis.empty()) name += " " + point.basis;
  for (const std::string& component : point.half)
    name += (&component == &point.half.front() ? " half " : ", ") + component;
  return point.history.empty() ? name : name + " " + point.history;
}

std::vector<std::size_t> pareto_front(const std::vector<TradePoint>& points,
                                      const std::string& recipe) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (points[k].recipe == recipe) order.push_back(k);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].ms != points[b].ms ? points[a].ms < points[b].ms
                                        : points[a].rmse < points[b].rmse;
  });
  std::vector<std::size_t> front;
  for (const std::size_t k : order)
    if (front.empty() || points[k].rmse < points[front.back()].rmse) front.push_back(k);
  return front;
}

double rmse_behind_front(const std::vector<TradePoint>& points, std::size_t point) {
  double best = points[point].rmse;
  for (const TradePoint& other : points)
    if (other.recipe == points[point].recipe && other.ms <= points[point].ms)
      best = std::min(best, other.rmse);
  return points[point].rmse > 0 ? 1 - best / points[point].rmse : 0;
}

TradeScene trade_over_scenes(const std::vector<TradeScene>& scenes) {
  TradeScene all{"all scenes", "Geometric means over", 0, 0, {}, {}};
  if (scenes.empty()) return all;
  for (const TradeScene& scene : scenes) {
    all.caption += (&scene == &scenes.front() ? " " : ", ") + scene.name;
    if (balanced(scene) == nullptr) return all;
  }
  all.points = means_of(scenes, &TradeScene::points);
  all.wire_points = means_of(scenes, &TradeScene::wire_points);
  all.deviations = deviations_over(scenes);
  return all;
}

}  // namespace holdfast::measure
