#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "client/check/report.h"
#include "core/frame/frame.h"

namespace holdfast::check {

/// Frames to check, in the order of their indices.
struct Source {
  std::size_t frames = 0;
  std::vector<Light> lights;
  /// The frame at a position, 0 .. frames - 1; called once for each, in order.
  std::function<Frame(std::size_t)> read;
};

/// Holds the inputs of a sequence against each other and names what is wrong.
///
/// Surface points of a frame, from its depth and camera, are carried to an earlier frame by the
/// motion of their objects, and must be found there. Where they are not, and are when one known
/// mistake is put right, that mistake is a finding: at least 60 % of the samples must then have
/// less than half their residual, and so must the median. Normals are held against those of the
/// depth, motion vectors against those of depth and matrices; blockers and hits must not hide what
/// the frame shows. Matrices, values and directions are held against the rules of the contract.
///
/// Needs two frames at least for evidence on cameras, objects and motion; samples four pairs of
/// frames. A sequence in which nothing moves gives no evidence on these. Throws InputError for what
/// no reader lets through: matrices that are singular or not finite.
Report check_frames(const Source& source);

}  // namespace holdfast::check
