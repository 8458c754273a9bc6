#include "tests/service/rendered.h"
#include "tests/service/served.h"

namespace holdfast {
namespace {

using test::Rendered;

TEST(RenderedFrames, HaveInputOnWhichHistoryActs) {
  const Rendered fence("fence", "reliable", 1);
  const auto& planes = fence.config.planes;
  for (const PlaneKind kind :
       {PlaneKind::kBlockerDistance, PlaneKind::kBlockerId, PlaneKind::kLightSample})
    EXPECT_NE(std::find(planes.begin(), planes.end(), PlaneId::of_light(kind, 0)), planes.end());
  EXPECT_NE(fence.frames[0].lights.at(0), fence.frames[1].lights.at(0)) << "the light moves";
  const PlaneId gradient{PlaneKind::kGradient, {ComponentKind::kVisibility, 0}};
  ASSERT_NE(std::find(planes.begin(), planes.end(), gradient), planes.end());
  EXPECT_EQ(fence.frames[3].planes.at(gradient).width(), 32);
  const Rendered adaptive("fence", "asvgf", 1), fixed("fence", "svgf", 1);
  EXPECT_FALSE(test::same_bits(test::direct(adaptive.config, adaptive.frames).back(),
                               test::direct(fixed.config, fixed.frames).back()));
  const Rendered plain("fence", "spatial", 1);
  EXPECT_FALSE(test::same_bits(test::direct(fence.config, fence.frames).back(),
                               test::direct(plain.config, plain.frames).back()));
}

class RenderedSession : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Threads, RenderedSession, ::testing::Values(1, 2));

TEST_P(RenderedSession, GivesTheBitsOfTheCoreCalledDirectlyUnderEveryRecipe) {
  const server::Server server(test::server_config(GetParam()));
  for (const std::string& recipe : recipe_names()) {
    SCOPED_TRACE(recipe);
    const Rendered fence("fence", recipe, 1);
    test::expect_same(test::served(server, fence.config, fence.frames),
                      test::direct(fence.config, fence.frames));
  }
}

TEST_P(RenderedSession, KeepsTwoSessionsThatStreamAtOnceApart) {
  const server::Server server(test::server_config(GetParam()));
  const Rendered a("fence", "reliable", 1, 10), b("room", "reliable", 2, 10);
  std::vector<PlaneSet> results_a;
  std::thread other([&] { results_a = test::served(server, a.config, a.frames); });
  const std::vector<PlaneSet> results_b = test::served(server, b.config, b.frames);
  other.join();
  test::expect_same(results_a, test::direct(a.config, a.frames));
  test::expect_same(results_b, test::direct(b.config, b.frames));
}

}  // namespace
}  // namespace holdfast
