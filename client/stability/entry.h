#pragma once

#include <functional>
#include <string>
#include <vector>

namespace holdfast::stability {

/// The recipe that accuracy is promised of. All others are what it is compared with: results must
/// be finite under them too, but what they get wrong by design (ghosts of what has moved) they may.
inline constexpr const char* kPromised = "reliable";

/// Of rows that compare noise: a filter that takes none away leaves 1. What is compared may leave
/// ghosts, but no more than that.
inline constexpr double kHelps = 1, kGhosts = 3;

/// Limits of an error, by recipe.
struct Limits {
  double promised = 0, others = 0;

  Limits(double all) : promised(all), others(all) {}
  Limits(double of_promised, double of_others) : promised(of_promised), others(of_others) {}
  double of(const std::string& recipe) const { return recipe == kPromised ? promised : others; }
};

/// One row of the table of extremes.
struct Entry {
  std::string name;      ///< of the row: unique, words joined by '-'
  std::string input;     ///< what is sent
  std::string expected;  ///< what a user wants to see; says what `error` is
  Limits limit;          ///< of the error
  /// The largest error seen under the recipe of that name, >= 0; infinite where a result is not
  /// finite. Throws only what the core throws in spite of what is expected.
  std::function<double(const std::string& recipe)> error;
  enum class Cost { kSmall, kLong, kLarge } cost = Cost::kSmall;
};

/// Of rows that scale lengths or light by what is no power of two, relative to the largest value.
/// `svgf` takes its variance as a difference of moments, as published, whose rounding without fused
/// products shows: 1.6e-3.
inline const Limits kScaled{1e-4, 2e-3};

/// How the sessions of a row keep what they remember. Rows of packed histories have names of their
/// own, and limits: packed ones are rounded at random, by another draw where any bit differs.
struct Histories {
  std::string format = "f32";  ///< or f16

  bool packed() const { return format != "f32"; }
  std::string name(const std::string& row) const { return packed() ? format + "-" + row : row; }
  Limits limit(Limits floats, Limits packs) const { return packed() ? packs : floats; }
};

/// Rows by what is extreme in them.
std::vector<Entry> scale_entries(const Histories& histories = {});
std::vector<Entry> radiance_entries(const Histories& histories = {});
std::vector<Entry> surface_entries();
std::vector<Entry> light_entries();
std::vector<Entry> camera_entries();
std::vector<Entry> object_entries();
std::vector<Entry> size_entries();
std::vector<Entry> time_entries();
std::vector<Entry> long_entries(const Histories& histories = {});
/// Of packed histories: all rows that can be said of them, and some of their own.
std::vector<Entry> packed_entries();

}  // namespace holdfast::stability
