#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/frame/plane_id.h"

namespace holdfast::cli {

struct WireStudyOptions {
  std::vector<std::filesystem::path> sequences;
  std::string recipe = "reliable", preset = "balanced";
  bool quiet = false;  ///< no progress
};

/// Planes in one direction, all together, as means over pixels and frames.
struct WireCost {
  double plain_bytes = 0;  ///< of a pixel, before the codec
  double coded_bytes = 0;  ///< of a pixel, on the wire
  double encode_ns = 0;    ///< of one thread for a pixel; the median frame
  double decode_ns = 0;
};

/// What a profile does to one result layer, over surface pixels of all frames, on the values that
/// `compare` judges.
struct WireError {
  double psnr = 0;            ///< against the results of `exact`, dB; +inf if they are the same
  double rmse = 0;            ///< against those
  double reference_rmse = 0;  ///< against the references; NaN without any
};

/// One profile on one sequence.
struct WireFigures {
  std::string sequence, profile;
  WireCost up, down;
  std::map<PlaneId, WireCost> planes_up, planes_down;  ///< times: means over frames
  std::map<PlaneId, WireError> layers;
};

/// Streams each sequence through a server in this process with every wire profile, `exact` first,
/// and measures bytes and errors; encodes and decodes the same planes by themselves for the times.
/// Throws InputError for a bad sequence.
std::vector<WireFigures> study_wire(const WireStudyOptions& options);

/// The machine-readable form.
nlohmann::ordered_json wire_json(const std::vector<WireFigures>& figures);
/// Tables: a row a profile for each sequence, then bytes by plane of the first sequence.
std::string wire_markdown(const std::vector<WireFigures>& figures);

}  // namespace holdfast::cli
