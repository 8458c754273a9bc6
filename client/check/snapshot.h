#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "core/frame/frame.h"

namespace holdfast::check {

/// A frame with what its tables leave out filled in from the frames before.
struct Snapshot {
  std::int64_t index = 0;
  int run = 0;  ///< number of cuts up to here: runs share nothing
  Camera camera;
  TransformTable objects;  ///< world_from_object of every id named so far
  TransformTable lights;   ///< world_from_light of every id named so far
  PlaneSet planes;

  int width() const { return planes.begin()->width(); }
  int height() const { return planes.begin()->height(); }
  /// A plane that is no light's and no component's; null if it is not there.
  const Plane* find(PlaneKind kind) const { return planes.find({kind, {}}); }
};

/// Makes snapshots of frames in their order.
class Tracker {
 public:
  Snapshot take(Frame frame);

 private:
  TransformTable objects_, lights_;
  int run_ = 0;
};

/// Frames that are held against each other, as positions in the sequence: far < now and
/// near = now - 1. A longer step back shows smaller motion.
struct Station {
  std::size_t far = 0, near = 0, now = 0;
};

/// At most four stations, spread evenly over `frames` frames; none for fewer than two frames.
std::vector<Station> choose_stations(std::size_t frames);

/// Two frames of one run.
struct Pair {
  const Snapshot* before = nullptr;
  const Snapshot* now = nullptr;
};

/// The frames that were kept, by position.
using Snapshots = std::map<std::size_t, Snapshot>;

/// The pairs (near, now) of the stations that no cut divides.
std::vector<Pair> near_pairs(const Snapshots& frames, const std::vector<Station>& stations);
/// The pairs (far, now), or (near, now) where a cut divides those.
std::vector<Pair> far_pairs(const Snapshots& frames, const std::vector<Station>& stations);

/// Pixels between samples in x and y, so that a frame has about 8000 at most.
int sample_step(int width, int height);

}  // namespace holdfast::check
