#include "client/sequence/strict_json.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <vector>

#include "core/frame/conventions.h"
#include "core/frame/error.h"

namespace holdfast {

StrictObject::StrictObject(const nlohmann::json& json, std::string file, std::string path)
    : json_(json), file_(std::move(file)), path_(std::move(path)) {
  if (!json_.is_object())
    throw InputError("file " + file_ + (path_.empty() ? "" : ", " + path_), "must be a JSON object",
                     json_excerpt(json_));
}

const nlohmann::json& StrictObject::required(const std::string& key) {
  if (const nlohmann::json* value = optional(key)) return *value;
  throw InputError(subject(key), "must be present", "missing");
}

const nlohmann::json* StrictObject::optional(const std::string& key) {
  asked_.insert(key);
  const auto it = json_.find(key);
  return it == json_.end() ? nullptr : &*it;
}

void StrictObject::finish() const {
  for (const auto& [key, value] : json_.items())
    if (!asked_.contains(key))
      throw InputError(subject(key), "must be a key of the format", "unknown");
}

double StrictObject::number(const std::string& key) {
  const nlohmann::json& value = required(key);
  if (!value.is_number() || !std::isfinite(value.get<double>()))
    throw InputError(subject(key), "must be a finite number", json_excerpt(value));
  return value.get<double>();
}

std::int64_t StrictObject::integer(const std::string& key, std::int64_t low, std::int64_t high) {
  const nlohmann::json& value = required(key);
  const bool fits = value.is_number_integer() &&
                    (!value.is_number_unsigned() || value.get<std::uint64_t>() <= INT64_MAX) &&
                    value.get<std::int64_t>() >= low && value.get<std::int64_t>() <= high;
  if (!fits)
    throw InputError(subject(key),
                     "must be an integer in " + std::to_string(low) + ".." + std::to_string(high),
                     json_excerpt(value));
  return value.get<std::int64_t>();
}

std::string StrictObject::text(const std::string& key) {
  const nlohmann::json& value = required(key);
  if (!value.is_string()) throw InputError(subject(key), "must be a string", json_excerpt(value));
  return value.get<std::string>();
}

glm::dmat4 StrictObject::matrix(const std::string& key) {
  const nlohmann::json& value = required(key);
  const auto fail = [&] {
    throw InputError(subject(key), "must be 16 finite numbers, row by row", json_excerpt(value));
  };
  if (!value.is_array() || value.size() != 16) fail();
  double numbers[16];
  for (std::size_t i = 0; i < 16; ++i) {
    if (!value[i].is_number()) fail();
    numbers[i] = value[i].get<double>();
    if (!std::isfinite(numbers[i])) fail();
  }
  return matrix_from_row_major(numbers);
}

std::string StrictObject::path(const std::string& key) const {
  return path_.empty() ? shortened(key) : path_ + "." + shortened(key);
}

std::string StrictObject::subject(const std::string& key) const {
  return "file " + file_ + ", " + path(key);
}

nlohmann::json parse_json(const std::string& text, const std::string& file) {
  constexpr int kDeepest =
      32;  // formats have 7; what reads or prints a value calls itself for each
  std::vector<std::set<std::string>> keys;  // of the objects that are open
  using Event = nlohmann::json::parse_event_t;
  const auto check = [&](int depth, Event event, const nlohmann::json& value) {
    if (depth > kDeepest)
      throw InputError("file " + file,
                       "must be nested " + std::to_string(kDeepest) + " deep at most", "deeper");
    if (event == Event::object_start) keys.emplace_back();
    if (event == Event::object_end) keys.pop_back();
    if (event == Event::key && !keys.back().insert(value.get<std::string>()).second)
      throw InputError("file " + file + ", key " + json_excerpt(value),
                       "must stand once in its object", "there twice");
    return true;
  };
  try {
    return nlohmann::json::parse(text, check);
  } catch (const nlohmann::json::exception& error) {
    throw InputError("file " + file, "must be valid JSON", "not: " + shortened(error.what(), 200));
  }
}

nlohmann::json read_json_file(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError("file " + file, "must be an existing JSON file", "missing");
  std::ostringstream text;
  text << stream.rdbuf();
  return parse_json(text.str(), file);
}

std::string json_excerpt(const nlohmann::json& json) {
  return shortened(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

std::string shortened(const std::string& text, std::size_t longest) {
  return text.size() <= longest ? text : text.substr(0, longest) + "...";
}

}  // namespace holdfast
