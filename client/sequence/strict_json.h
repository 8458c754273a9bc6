#pragma once

#include <cstdint>
#include <set>
#include <string>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

namespace holdfast {

/// One JSON object read strictly: every key is asked for, or it is an error.
///
/// Each error is an InputError whose subject is the file and the path of the key, for example
/// "file s/sequence.json, frames[3].camera.viewFromWorld".
class StrictObject {
 public:
  /// `path` is the place of `json` in the file, "" for the top. Throws unless it is an object. The
  /// JSON must outlive this view.
  StrictObject(const nlohmann::json& json, std::string file, std::string path);

  /// The value of a key that must be there.
  const nlohmann::json& required(const std::string& key);
  /// The value of a key, or null.
  const nlohmann::json* optional(const std::string& key);
  /// Throws for the first key that nobody asked for.
  void finish() const;

  double number(const std::string& key);  ///< required, finite
  std::int64_t integer(const std::string& key, std::int64_t low, std::int64_t high);  ///< required
  std::string text(const std::string& key);                                           ///< required
  glm::dmat4 matrix(const std::string& key);  ///< required; 16 finite numbers, row-major

  const nlohmann::json& json() const { return json_; }
  const std::string& file() const { return file_; }
  /// Path of a key below this object.
  std::string path(const std::string& key) const;
  /// "file F, path" for error messages.
  std::string subject(const std::string& key) const;

 private:
  const nlohmann::json& json_;
  std::string file_, path_;
  std::set<std::string> asked_;
};

/// Parses JSON text; `file` names it in messages. Throws InputError if it is no JSON, has a key
/// twice in one object, or is nested deeper than 32.
nlohmann::json parse_json(const std::string& text, const std::string& file);
/// Parses a JSON file. Throws InputError also if it is missing.
nlohmann::json read_json_file(const std::string& file);

/// A value in an error message: its JSON text, shortened.
std::string json_excerpt(const nlohmann::json& json);
/// Text in an error message: no longer than `longest` bytes, and dots.
std::string shortened(const std::string& text, std::size_t longest = 60);

}  // namespace holdfast
