#pragma once

#include <cmath>
#include <limits>
#include <string>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include "client/sequence/strict_json.h"
#include "core/frame/error.h"

// Values of scene files, checked against their ranges. Each error names file, key, rule and value.
namespace holdfast::scenes {

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// A number in low..high, or `fallback` where the key is absent.
inline double number_or(StrictObject& in, const std::string& key, double fallback,
                        double low = -kNoLimit, double high = kNoLimit) {
  const nlohmann::json* value = in.optional(key);
  if (!value) return fallback;
  const double number = value->is_number() ? value->get<double>() : std::nan("");
  if (!(std::isfinite(number) && number >= low && number <= high)) {
    const std::string span = low == -kNoLimit ? "finite" : std::to_string(low) + " or more";
    throw InputError(
        in.subject(key),
        "must be a number, " +
            (high == kNoLimit ? span : std::to_string(low) + ".." + std::to_string(high)),
        json_excerpt(*value));
  }
  return number;
}

/// As above, but above 0.
inline double positive_or(StrictObject& in, const std::string& key, double fallback,
                          double high = kNoLimit) {
  const double value = number_or(in, key, fallback, 0.0, high);
  if (value > 0.0) return value;
  throw InputError(in.subject(key), "must be greater than 0", std::to_string(value));
}

template <int N>
glm::vec<N, double> vector_of(StrictObject& in, const std::string& key,
                              const nlohmann::json& value) {
  glm::vec<N, double> out;
  bool valid = value.is_array() && value.size() == N;
  for (int i = 0; valid && i < N; ++i) {
    valid = value[static_cast<std::size_t>(i)].is_number();
    if (valid) out[i] = value[static_cast<std::size_t>(i)].get<double>();
    valid = valid && std::isfinite(out[i]);
  }
  if (!valid)
    throw InputError(in.subject(key), "must be " + std::to_string(N) + " finite numbers",
                     json_excerpt(value));
  return out;
}

template <int N>
glm::vec<N, double> vector_or(StrictObject& in, const std::string& key,
                              const glm::vec<N, double>& fallback) {
  const nlohmann::json* value = in.optional(key);
  return value ? vector_of<N>(in, key, *value) : fallback;
}

/// A colour 0..high: three numbers, or one for all.
inline glm::dvec3 colour_or(StrictObject& in, const std::string& key, const glm::dvec3& fallback,
                            double high) {
  const nlohmann::json* value = in.optional(key);
  if (!value) return fallback;
  const glm::dvec3 colour =
      value->is_number() ? glm::dvec3(value->get<double>()) : vector_of<3>(in, key, *value);
  for (int c = 0; c < 3; ++c)
    if (!(colour[c] >= 0.0 && colour[c] <= high))
      throw InputError(
          in.subject(key),
          high == kNoLimit ? "must not be negative" : "must lie in 0.." + json_excerpt(high),
          json_excerpt(*value));
  return colour;
}

inline StrictObject child(StrictObject& in, const std::string& key) {
  return {in.required(key), in.file(), in.path(key)};
}

/// Calls `read` with each element of an array of objects.
template <class Read>
void each(StrictObject& in, const std::string& key, const nlohmann::json& array, const Read& read) {
  if (!array.is_array()) throw InputError(in.subject(key), "must be an array", json_excerpt(array));
  for (std::size_t i = 0; i < array.size(); ++i) {
    StrictObject item(array[i], in.file(), in.path(key) + "[" + std::to_string(i) + "]");
    read(item);
    item.finish();
  }
}

}  // namespace holdfast::scenes
