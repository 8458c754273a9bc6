#include "server/cost_model.h"

#include <string_view>

namespace holdfast::server {

PresetCost cost_of_stages(const std::vector<StageTime>& stages, double pixels) {
  PresetCost cost;
  for (const StageTime& stage : stages) {
    const std::string_view name = stage.stage;
    double& part = name.starts_with("light")       ? cost.visibility
                   : name.starts_with("glossy.")   ? cost.glossy
                   : name.starts_with("indirect.") ? cost.indirect
                                                   : cost.frame;
    part += stage.ms * 1e6 / pixels;
  }
  return cost;
}

std::vector<double> expected_ms(const CostTable& table, const DenoiserConfig& session) {
  double lights = 0, glossy = 0, indirect = 0;
  for (const PlaneId id : session.planes) {
    lights += id.kind == PlaneKind::kVisibility ? 1 : 0;
    glossy += id.kind == PlaneKind::kGlossy ? 1 : 0;
    indirect += id.kind == PlaneKind::kIndirect ? 1 : 0;
  }
  const double ms_of_ns = static_cast<double>(session.width) * session.height * 1e-6;
  std::vector<double> ms;
  for (const PresetCost& cost : table) {
    ms.push_back(ms_of_ns * (cost.frame + lights * cost.visibility + glossy * cost.glossy +
                             indirect * cost.indirect));
    if (kernel_preset_names()[ms.size() - 1] == session.preset) break;
  }
  return ms;
}

}  // namespace holdfast::server
