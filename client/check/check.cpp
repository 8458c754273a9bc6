#include "client/check/check.h"

#include <set>
#include <utility>

#include "client/check/parts.h"

namespace holdfast::check {
namespace {

/// Positions of frames whose planes are needed after all were read.
std::set<std::size_t> kept(const std::vector<Station>& stations) {
  std::set<std::size_t> positions;
  for (const Station& s : stations) positions.insert({s.far, s.near, s.now});
  return positions;
}

}  // namespace

std::string findings_since(const Report& report, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < report.findings.size(); ++i)
    text +=
        (text.empty() ? "" : ", ") + report.findings[i].thing + ": " + report.findings[i].mistake;
  return text;
}

Report check_frames(const Source& source) {
  Report report;
  report.frames = static_cast<std::int64_t>(source.frames);
  std::vector<Station> stations = choose_stations(source.frames);
  const bool single = stations.empty();
  if (single && source.frames == 1) stations.push_back({0, 0, 0});  // for what one frame shows
  const std::set<std::size_t> positions = kept(stations);

  Tracker tracker;
  ValueCheck values;
  std::vector<Tables> tables;
  Snapshots frames;
  for (std::size_t i = 0; i < source.frames; ++i) {
    Frame frame = source.read(i);
    tables.push_back({frame.camera, frame.objects, frame.lights});
    values.add(frame.planes);
    Snapshot snapshot = tracker.take(std::move(frame));
    if (positions.contains(i)) frames.emplace(i, std::move(snapshot));
  }
  values.report(report);
  check_matrices(tables, frames, report);
  check_ids(tables, frames, report);

  const std::vector<Pair> far = far_pairs(frames, stations), near = near_pairs(frames, stations);
  const Reading reading = check_geometry(far, report);
  check_normals(far, reading, report);
  const ObjectReading objects = check_objects(far, reading, report);
  check_motion(near, reading, objects, report);
  check_lights(far, source.lights, reading, report);
  check_rays(far, reading, report);
  return report;
}

}  // namespace holdfast::check
