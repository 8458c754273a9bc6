#include "client/measure/trade.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "client/measure/deviation.h"
#include "client/measure/trade_plot.h"
#include "client/measure/trade_text.h"

namespace holdfast::measure {
namespace {

TradePoint point(const std::string& recipe, double ms, double rmse,
                 std::vector<std::string> presets = {}) {
  TradePoint out;
  out.recipe = recipe;
  out.presets = std::move(presets);
  out.ms = ms;
  out.rmse = rmse;
  out.composite_rmse = rmse * rmse;
  out.bytes_per_pixel = 100;
  out.ssim = 0.9;
  out.basis = "cones";
  return out;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(ParetoFront, IsWhatNoOtherPointOfTheRecipeBeatsInBoth) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> value(1, 12);  // coarse, so that ties occur
  for (int round = 0; round < 200; ++round) {
    std::vector<TradePoint> points;
    for (int i = 0; i < 15; ++i)
      points.push_back(point(i % 3 == 0 ? "b" : "a", value(random), value(random)));
    const auto front = pareto_front(points, "a");
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (points[k].recipe != "a") continue;
      const bool beaten = std::any_of(points.begin(), points.end(), [&](const TradePoint& other) {
        return other.recipe == "a" && other.ms <= points[k].ms && other.rmse <= points[k].rmse &&
               (other.ms < points[k].ms || other.rmse < points[k].rmse);
      });
      const bool listed = std::any_of(front.begin(), front.end(), [&](std::size_t f) {
        return points[f].ms == points[k].ms && points[f].rmse == points[k].rmse;
      });
      EXPECT_EQ(listed, !beaten) << points[k].ms << ' ' << points[k].rmse;
      EXPECT_EQ(rmse_behind_front(points, k) > 0,
                std::any_of(points.begin(), points.end(), [&](const TradePoint& other) {
                  return other.recipe == "a" && other.ms <= points[k].ms &&
                         other.rmse < points[k].rmse;
                }));
    }
    for (std::size_t i = 1; i < front.size(); ++i) {
      EXPECT_LT(points[front[i - 1]].ms, points[front[i]].ms);
      EXPECT_GT(points[front[i - 1]].rmse, points[front[i]].rmse);
    }
  }
}

TEST(Trade, RmseBehindTheFrontIsTheShareThatAnotherSettingSaves) {
  const std::vector<TradePoint> points{point("a", 1, 0.5), point("a", 2, 0.4), point("a", 3, 0.5),
                                       point("b", 1, 0.1)};
  EXPECT_EQ(rmse_behind_front(points, 0), 0);
  EXPECT_EQ(rmse_behind_front(points, 1), 0);
  EXPECT_DOUBLE_EQ(rmse_behind_front(points, 2), 0.2);
}

TEST(Trade, OverScenesTakesGeometricMeansOfRatiosToBalanced) {
  const TradeScene one{"one", "", 8, 8, {point("reliable", 10, 0.1, {"balanced"})}};
  TradeScene two{"two", "", 8, 8, {point("reliable", 2, 0.01, {"balanced"})}};
  TradeScene three = one;
  TradePoint half = point("reliable", 5, 0.2, {"fast"});
  half.half = {"glossy"};
  three.points.push_back(half);
  half.ms = 4;
  half.rmse = 0.02;
  half.composite_rmse = 0.0003;
  two.points.push_back(half);
  const TradeScene all = trade_over_scenes({three, two});
  ASSERT_EQ(all.points.size(), 2u);
  EXPECT_DOUBLE_EQ(all.points[0].ms, 1);
  EXPECT_DOUBLE_EQ(all.points[0].rmse, 1);
  EXPECT_DOUBLE_EQ(all.points[1].ms, 1) << "half and twice the time";
  EXPECT_DOUBLE_EQ(all.points[1].rmse, 2);
  EXPECT_DOUBLE_EQ(all.points[0].composite_rmse, 1);
  EXPECT_NEAR(all.points[1].composite_rmse, std::sqrt(4 * 3), 1e-12);
  EXPECT_EQ(trade_over_scenes({one, two}).points.size(), 1u) << "one scene lacks the other setting";
  EXPECT_TRUE(trade_over_scenes({TradeScene{"x", "", 8, 8, {half}, {}}}).points.empty());
}

TEST(Trade, DeviationsOverScenesAreOfTheLayersThatEachHas) {
  TradeScene one{"one", "", 8, 8, {point("reliable", 10, 0.1, {"balanced"})}, {}};
  TradeScene two = one;
  one.deviations = {{"fast", "glossy", 0.03, 0.2}};
  two.deviations = {{"fast", "glossy", 0.04, 0.1}, {"fast", "indirect", 0.5, 0.6}};
  const TradeScene all = trade_over_scenes({one, two});
  ASSERT_EQ(all.deviations.size(), 2u);
  EXPECT_NEAR(all.deviations[0].typical, std::sqrt((0.0009 + 0.0016) / 2), 1e-12);
  EXPECT_EQ(all.deviations[0].largest, 0.2);
  EXPECT_NEAR(all.deviations[1].typical, 0.5, 1e-12) << "the other scene has no such layer";
  EXPECT_NE(trade_markdown({one}).find("| fast | glossy | 0.030000 | 0.2000 |"), std::string::npos);
}

TEST(Deviation, IsTheDifferenceOfJudgedValuesOnSurfaces) {
  Plane a({PlaneKind::kGlossy, {}}, 2, 1), b({PlaneKind::kGlossy, {}}, 2, 1);
  for (int c = 0; c < 3; ++c) {
    a.channel(c).at(0, 0) = 1.0f;  // judged 0.5
    b.channel(c).at(0, 0) = 3.0f;  // 0.75
    a.channel(c).at(1, 0) = 1e6f;  // in the sky
  }
  DeviationMeter meter;
  meter.add(a, b, {1, 0});
  EXPECT_NEAR(meter.typical(), 0.25, 1e-6);
  EXPECT_NEAR(meter.largest(), 0.25, 1e-6);
  meter.add(a, a, {1, 0});
  EXPECT_NEAR(meter.typical(), 0.25 / std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(meter.largest(), 0.25, 1e-6);
  EXPECT_TRUE(std::isnan(DeviationMeter().typical()));
}

TEST(Trade, WireProfilesAreNotOnTheFront) {
  TradeScene one{"one", "", 8, 8, {point("reliable", 10, 0.1, {"balanced"})}, {}};
  TradePoint wired = one.points.front();
  wired.wire = "compact";
  wired.ms = 9;  // by chance
  wired.wire_bytes_per_pixel = 20;
  one.wire_points = {wired};
  TradeScene two = one;
  two.wire_points.front().wire_bytes_per_pixel = 40;
  const TradeScene all = trade_over_scenes({one, two});
  EXPECT_EQ(pareto_front(all.points, "reliable").size(), 1u);
  ASSERT_EQ(all.wire_points.size(), 1u);
  EXPECT_DOUBLE_EQ(all.wire_points.front().wire_bytes_per_pixel, 30);
  EXPECT_EQ(point_name(all.wire_points.front()), "reliable balanced, wire compact");
  EXPECT_NE(trade_markdown({one}).find("| reliable balanced, wire compact |"), std::string::npos);
}

TEST(Trade, NamesAreThoseOfPresetsElseOfWhatIsChosen) {
  TradePoint p = point("reliable", 1, 1, {"fast"});
  EXPECT_EQ(point_name(p), "reliable fast");
  p.presets.clear();
  p.kernel_taps = 9;
  p.more_levels = -1;
  p.half = {"indirect"};
  EXPECT_EQ(point_name(p), "reliable 9 taps -1 levels cones half indirect");
  p.half = {"indirect", "glossy"};
  p.more_levels = 1;
  EXPECT_EQ(point_name(p), "reliable 9 taps +1 levels cones half indirect, glossy");
  p.history = "f32";
  EXPECT_EQ(point_name(p), "reliable 9 taps +1 levels cones half indirect, glossy f32");
}

TEST(TradePlot, HasAPointForEachSettingAndANameForEachPreset) {
  TradeScene scene{"a <scene>", "", 8, 8, {}};
  scene.points = {point("reliable", 10, 0.1, {"fast"}), point("reliable", 20, 0.05, {"balanced"}),
                  point("reliable", 20, 0.05, {"accurate"}), point("reliable", 15, 0.2),
                  point("svgf", 30, 0.3, {"fast"})};
  const std::string svg = trade_svg(scene, false);
  EXPECT_EQ(count_of(svg, "<circle"), 5u);
  EXPECT_EQ(count_of(svg, ">reliable fast</text>"), 1u);
  EXPECT_EQ(count_of(svg, ">reliable balanced, accurate</text>"), 1u);
  EXPECT_EQ(count_of(svg, ">svgf fast</text>"), 1u);
  EXPECT_NE(svg.find("a &lt;scene&gt;"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(count_of(trade_panels_svg(scene, true), "<circle"), 5u + 4u);
  EXPECT_EQ(trade_svg({}, false), "");
}

TEST(TradePlot, DrawsASinglePointWithoutDividingByNothing) {
  const TradeScene scene{"one", "", 8, 8, {point("reliable", 10, 0.0, {"fast"})}};
  const std::string svg = trade_svg(scene, true);
  EXPECT_EQ(count_of(svg, "<circle"), 1u);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

}  // namespace
}  // namespace holdfast::measure
