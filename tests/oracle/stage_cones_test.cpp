// Cones of radiance over some frames, and quads of half resolution, against the oracle.

#include "core/denoiser/recipe.h"
#include "core/history/cone_history.h"
#include "core/oracle/cones.h"
#include "core/oracle/quads.h"
#include "core/spatial/half_grid.h"
#include "tests/oracle/stage_twins.h"

namespace holdfast {
namespace {

using oracle::DirectedSamples;
using oracle::Image;

constexpr int kFrames = 4;

/// Samples of one frame as a client sends them: some without a direction, some below the surface.
struct Sent {
  Plane directions;
  Channels<float> radiance;

  Sent(int width, int height, test::Random& random)
      : directions({PlaneKind::kIndirectDirection, {}}, width, height), radiance(width, height, 3) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const glm::vec3 direction(glm::normalize(random.in_box(1) + glm::dvec3(0, 0, 0.7)));
        const double kind = random.uniform();
        for (int c = 0; c < 3; ++c) {
          directions.channel(c).at(x, y) =
              kind < 0.05 ? 0.0f : (kind < 0.07 ? test::kNaN : direction[c]);
          radiance[c].at(x, y) = random.real(0, 2);
        }
      }
  }
  DirectedSamples twin() const {
    DirectedSamples out{Image(radiance.width(), radiance.height(), 3),
                        test::image_of(radiance, 0, 3)};
    oracle::for_each_pixel(radiance.width(), radiance.height(), [&](int x, int y) {
      for (int c = 0; c < 3; ++c)
        out.direction.at(x, y, c) = double{directions.channel(c).at(x, y)};
    });
    return out;
  }
};

Channels<float> copy_of(const Channels<float>& in) {
  Channels<float> out(in.width(), in.height(), in.count());
  oracle::for_each_pixel(in.width(), in.height(), [&](int x, int y) {
    for (int c = 0; c < in.count(); ++c) out[c].at(x, y) = in[c].at(x, y);
  });
  return out;
}

/// Frames whose surfaces turn, so that cones do, too.
struct Session {
  std::vector<Guides> guides;
  std::vector<std::vector<Sent>> sent;  ///< by frame, then by pixel of a quad
  std::vector<SurfaceHistory> surface;
  std::vector<oracle::Past> past;

  Session(int width, int height, int samples) {
    test::Random random(81);
    for (int t = 0; t < kFrames; ++t) {
      guides.push_back(test::leaning_walls(width, height, random));
      sent.emplace_back();
      for (int k = 0; k < samples; ++k) sent.back().emplace_back(width, height, random);
      surface.emplace_back(width, height);
      past.emplace_back(width, height);
      if (t > 0)
        test::random_taps(guides.back(), guides[guides.size() - 2], random, surface.back().taps,
                          past.back());
    }
  }
};

std::vector<Image> by_oracle(const Session& session, RadianceBasis basis) {
  std::vector<Image> out;
  oracle::Cones cones(basis);
  const oracle::Scene scene;
  for (std::size_t t = 0; t < kFrames; ++t) {
    const oracle::Surfaces now = test::surfaces_of(session.guides[t]);
    const oracle::Surfaces before = test::surfaces_of(session.guides[t > 0 ? t - 1 : 0]);
    std::vector<DirectedSamples> samples;
    for (const Sent& sent : session.sent[t]) samples.push_back(sent.twin());
    cones.correct({now, before, scene, t > 0 ? &session.past[t] : nullptr}, nullptr, samples,
                  ConeRule{});
    for (DirectedSamples& each : samples) out.push_back(std::move(each.radiance));
  }
  return out;
}

// Overlaps of cones come from a table, to 2e-4 of what is turned, frame after frame.
TEST(StageOracle, ConesAgreeOnEveryInstructionSet) {
  constexpr double kCorrected = 2e-3, kTips = 2e-3;  // a direction between two cones
  for (const auto& [width, height] : test::kStageSizes)
    for (const RadianceBasis basis : {RadianceBasis::kConesLuminance, RadianceBasis::kConesColour})
      for (const int samples : {1, 4}) {
        const Session session(width, height, samples);
        const std::vector<Image> expected = by_oracle(session, basis);
        test::on_every_isa_and_threads([&] {
          ConeHistory cones(width, height, basis, HistoryFormat::kFloat);
          ConeRoom room(width, height, basis, HistoryFormat::kFloat);
          WindowScratch window(width, height);
          const SceneMotion scene;
          std::size_t k = 0;
          for (std::size_t t = 0; t < kFrames; ++t) {
            std::vector<Channels<float>> radiance;
            for (const Sent& sent : session.sent[t]) radiance.push_back(copy_of(sent.radiance));
            std::vector<ConeSamples> given;
            for (std::size_t j = 0; j < radiance.size(); ++j)
              given.push_back({&session.sent[t][j].directions, &radiance[j]});
            window.weights.clear();
            cones.correct({session.guides[t], session.guides[t > 0 ? t - 1 : 0], scene},
                          t > 0 ? &session.surface[t] : nullptr, nullptr, given, ConeRule{}, 0,
                          room, window);
            for (const Channels<float>& each : radiance)
              test::expect_close(each, 0, expected[k++], kCorrected, kTips, "radiance");
          }
        });
      }
}

TEST(StageOracle, QuadsAndTheirMeansAgreeAtEverySize) {
  for (const auto& [width, height] : test::kStageSizes) {
    test::Random random(82);
    const Guides full = test::leaning_walls(width, height, random);
    HalfGrid grid(width, height);
    choose_representatives(full, grid);
    Guides half(half_size(width), half_size(height));
    half.view = full.view.halved();
    half.rays = half.view.rays.cast<float>();
    halve_guides(full, grid, half);
    const oracle::Surfaces surfaces = test::surfaces_of(full);
    const oracle::Quads quads = oracle::choose_quads(surfaces);
    const oracle::Surfaces halved = oracle::halved(surfaces, quads);
    test::expect_close(grid.share, 0, quads.share, 1e-6, 0, "share");
    test::expect_close(half.depth_normal, 0, halved.depth, 1e-5, 0, "depth");
    test::expect_close(half.depth_normal, 1, halved.normal, 0, 0, "normal");
    Channels<float> signal(width, height, 3), mean(half_size(width), half_size(height), 3);
    for (int c = 0; c < 3; ++c) test::fill_random(signal[c], random, 0, 1);
    halve_signal(signal, 3, grid, mean);
    std::vector<DirectedSamples> pixels;
    for (int k = 0; k < oracle::Quads::kPixels; ++k)
      pixels.push_back({{}, oracle::pixel_of_quads(test::image_of(signal, 0, 3), quads, k)});
    test::expect_close(mean, 0, oracle::mean_of_quads(pixels, quads), 1e-6, 0, "mean");
  }
}

}  // namespace
}  // namespace holdfast
