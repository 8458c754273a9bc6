#pragma once

#include <optional>

#include "client/check/reading.h"
#include "client/check/report.h"

/// The parts of a check, in the order in which they run: what an earlier part finds wrong is put
/// right for the later ones, so that one mistake makes one finding.
namespace holdfast::check {

/// The camera and tables of every frame, without planes.
struct Tables {
  Camera camera;
  TransformTable objects, lights;
};

/// Matrices that are written column by column, and jitter within clip_from_view, by the form of the
/// matrices of all frames. Puts them right in `frames`, whose positions are those of `all`.
void check_matrices(const std::vector<Tables>& all, Snapshots& frames, Report& report);

/// Ids that are no ids: scaled or copied from reals, or unknown to the tables.
void check_ids(const std::vector<Tables>& all, const Snapshots& frames, Report& report);

/// Camera, depth, normals and jitter: which reading of them makes earlier frames and normals fit.
/// Returns the reading that later parts use.
Reading check_geometry(const std::vector<Pair>& pairs, Report& report);

/// How objects are carried from one frame to the other.
struct ObjectReading {
  bool inverse = false;  ///< tables hold object_from_world

  /// T_before T_now^-1 of an object; the identity for an id without a table. Nothing if it is
  /// singular.
  std::optional<glm::dmat4> carry(const Pair& pair, std::uint32_t id) const;
};

/// Whether the matrices of objects carry them to where they were, and whether ids move that no
/// table names.
ObjectReading check_objects(const std::vector<Pair>& pairs, const Reading& reading, Report& report);

/// The motion plane against the motion that follows from depth, cameras and objects.
void check_motion(const std::vector<Pair>& near, const Reading& reading,
                  const ObjectReading& objects, Report& report);

/// Length of normals, and the side that they face.
void check_normals(const std::vector<Pair>& pairs, const Reading& reading, Report& report);

/// Blockers and light samples of each light.
void check_lights(const std::vector<Pair>& pairs, const std::vector<Light>& lights,
                  const Reading& reading, Report& report);

/// Directions and hits of `glossy` and `indirect`.
void check_rays(const std::vector<Pair>& pairs, const Reading& reading, Report& report);

/// Counts, over all frames, values that no plane of the contract may have.
class ValueCheck {
 public:
  void add(const PlaneSet& planes);
  void report(Report& report) const;

 private:
  struct Count {
    std::int64_t values = 0, not_finite = 0, negative = 0;
    double sum = 0;  ///< of finite values
  };
  std::map<PlaneId, Count> counts_;
};

/// "a finding" in the report for each broken rule, one line for all of a part's.
std::string findings_since(const Report& report, std::size_t first);

}  // namespace holdfast::check
