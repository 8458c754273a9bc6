#include "core/history/cone_history.h"

#include <algorithm>
#include <utility>

#include "core/kernels/parallel.h"

namespace holdfast {
namespace {

/// Channels of `colours` sums and the samples.
constexpr int channels_of(int colours) { return kCones * (colours + 1) + (colours == 1 ? 2 : 0); }

/// Of these, as many as one pass takes.
constexpr int pass_channels(int channels) { return channels % 7 == 0 ? 7 : 8; }
static_assert(channels_of(1) % pass_channels(channels_of(1)) == 0);
static_assert(channels_of(3) % pass_channels(channels_of(3)) == 0);

int colours_of(RadianceBasis basis) { return basis == RadianceBasis::kConesColour ? 3 : 1; }

/// Lane i of six channels, from one set of cones to another.
void mix(const ConeMix& mix, float* const* of, int i) {
  float mixed[kCones] = {};
  for (int k = 0; k < kCones; ++k)
    for (int j = 0; j < kCones; ++j) mixed[k] += mix.share[k][j] * of[j][i];
  for (int k = 0; k < kCones; ++k) of[k][i] = mixed[k];
}

/// The taps at which cones are looked for: the surface's, else those of what stands in for it.
/// Written to `own` if they are not all of one kind.
const Taps* choose_taps(const SurfaceHistory* surface, const EffectHistory* effect, int x, int y,
                        int count, Taps* own) {
  static constexpr Taps kNone[kTapBlock] = {};
  if (surface == nullptr) return kNone;
  if (effect == nullptr) return surface->taps[0].row(y) + x;
  return surface->taps_or(effect->taps, x, y, count, own);
}

/// Means over 3x3 pixels of the same surface; sums and samples alike, so that a cone counts in its
/// neighbours by its samples.
void spread_out(const Guides& guides, ConeRoom& room, TapWeights& weights) {
  FilterPass pass;
  pass.guides = &guides;
  pass.weights = {.radius = 1, .kernel = {1, 1, 1}};
  pass.channels = pass_channels(room.kept.count());
  pass.kept = &weights;
  pass.spread = Spread::kNone;
  for (int first = 0; first < room.kept.count(); first += pass.channels) {
    for (int c = 0; c < pass.channels; ++c) {
      pass.in[c] = std::as_const(room.updated)[first + c];
      pass.out[c] = room.kept[first + c];
    }
    filter_image(pass);
  }
}

}  // namespace

ConeRoom::ConeRoom(int width, int height, RadianceBasis basis, HistoryFormat format, Memory memory)
    : updated(width, height, channels_of(colours_of(basis)), memory) {
  if (format == HistoryFormat::kPacked)
    kept = Channels<float>(width, height, channels_of(colours_of(basis)), memory);
}

ConeHistory::ConeHistory(int width, int height, RadianceBasis basis, HistoryFormat format)
    : colours_(colours_of(basis)),
      kept_(width, height,
            std::vector<KeptAs>(static_cast<std::size_t>(channels_of(colours_)), KeptAs::kByte),
            format) {}

ConeRows ConeHistory::rows_at(int x, int y, int count, Channels<float>& images) const {
  ConeRows rows{count, colours_, {}};
  for (int c = 0; c < images.count(); ++c) rows.of[c] = images[c].row(y) + x;
  return rows;
}

void ConeHistory::correct(const FramePair& frames, const SurfaceHistory* surface,
                          const EffectHistory* effect, std::span<const ConeSamples> samples,
                          const ConeRule& rule, std::uint64_t key, ConeRoom& room,
                          WindowScratch& window) {
  const Guides& now = frames.now;
  kept_.recall(room.kept, [&](Channels<float>& images, int y) {
    means_to_sums(rows_at(0, y, now.view.width, images));
  });
  for_each_row(now.view.height, [&](int y) {
    Taps own[kTapBlock];
    for (int x = 0; x < now.view.width; x += kTapBlock) {
      const int count = std::min(kTapBlock, now.view.width - x);
      const Taps* taps = choose_taps(surface, effect, x, y, count, own);
      const ConeRows rows = rows_at(x, y, count, room.updated);
      ConeCorrection block{now.depth().row(y) + x, {},   {}, rule.prior_samples,
                           rule.most_samples,      rows, {}};
      for (int c = 0; c < 3; ++c) block.normal[c] = now.normal(c).row(y) + x;
      recall(frames.previous, room, taps, block.normal, rows);
      for (const ConeSamples& sample : samples) {
        for (int c = 0; c < 3; ++c) {
          block.direction[c] = sample.directions->channel(c).row(y) + x;
          block.noisy[c] = (*sample.radiance)[c].row(y) + x;
        }
        correct_by_cones(block);
      }
    }
  });
  spread_out(now, room, window.weights);
  kept_.keep(room.kept, key, [&](Channels<float>& images, int y) {
    sums_to_means(rows_at(0, y, now.view.width, images));
  });
}

/// The cones that were kept at the taps, turned to the normals of now.
void ConeHistory::recall(const Guides& previous, const ConeRoom& room, const Taps* taps,
                         const float* const (&normal)[3], const ConeRows& rows) const {
  float before[3][kTapBlock];
  std::uint8_t turned[kTapBlock];
  recall_cones(
      {taps, room.kept, previous, {normal[0], normal[1], normal[2]}, rows, before, turned});
  for (int i = 0; i < rows.count; ++i) {
    if (!turned[i]) continue;
    const glm::vec3 from(before[0][i], before[1][i], before[2][i]);
    const ConeMix mixed(ConeFrame<float>(glm::normalize(from)),
                        ConeFrame<float>({normal[0][i], normal[1][i], normal[2][i]}));
    for (int c = 0; c <= colours_; ++c) mix(mixed, rows.of + c * kCones, i);
  }
}

}  // namespace holdfast
