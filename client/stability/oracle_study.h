#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "client/stability/world.h"

namespace holdfast::stability {

/// How far results in floats may be from those in double, for one kind of result plane. An error is
/// a difference over `unit`. Where a choice tips by rounding (a tap that is just on its plane, the
/// better of two candidates) a pixel's error has nothing to do with rounding: such pixels are
/// counted, and are left out of `rms`.
struct OracleBudget {
  const char* stage;  ///< whose work the plane shows
  double tipped;      ///< an error beyond this is that of a choice
  double share;       ///< of the pixels that may be tipped
  double rms;         ///< of the errors of all others
};
const OracleBudget& oracle_budget(PlaneKind kind);

/// Errors of one result plane over some frames.
struct OracleErrors {
  PlaneId plane;
  double largest = 0;       ///< of the errors that are not tipped
  double rms = 0;           ///< likewise
  double tipped_share = 0;  ///< of the pixels
  double largest_tip = 0;   ///< error; 0 where none is tipped

  bool within_budget() const;
};

/// Results of each frame of a session, with debug planes.
using Results = std::vector<PlaneSet>;
Results filter_frames(DenoiserConfig config, const std::string& preset,
                      const std::vector<Frame>& frames);
/// The same in double precision: what the oracle makes of all that a preset chooses.
Results filter_by_oracle(DenoiserConfig config, const std::string& preset,
                         const std::vector<Frame>& frames);

/// The errors of `floats` against `doubles`, one entry a plane. Motion is compared in pixels,
/// history in units of its largest value, confidence and visibility as they are, radiance in units
/// of the largest value that a plane of `doubles` holds. A value that is not finite is an infinite
/// error.
std::vector<OracleErrors> oracle_errors(const Results& floats, const Results& doubles);

/// A world that a study filters, and its frames.
struct OracleScene {
  std::string name;
  DenoiserConfig config;
  std::vector<Frame> frames;
};
/// Everything moves, then nothing does; `frames` of each, at that size. With gradient samples.
std::vector<OracleScene> oracle_scenes(int width, int height, int frames);

/// One row of the study.
struct OracleFinding {
  std::string recipe, scene;
  std::vector<OracleErrors> errors;
};
/// Filters the scenes with preset `balanced`, and with the oracle in its place, under each recipe
/// (none: all).
std::vector<OracleFinding> study_oracle(
    const std::vector<std::string>& recipes,
    const std::function<void(const std::string& recipe)>& progress);
bool all_within_budget(const std::vector<OracleFinding>& findings);
/// The largest errors of each stage by recipe, beside their budgets.
std::string oracle_markdown(const std::vector<OracleFinding>& findings);
/// {"passed", "entries": [{"recipe", "scene", "plane", "rms", "largest", "tipped", "largest_tip",
/// "passed"}]}.
nlohmann::ordered_json oracle_json(const std::vector<OracleFinding>& findings);

}  // namespace holdfast::stability
