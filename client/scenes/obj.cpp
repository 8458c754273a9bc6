#include <charconv>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include "client/scenes/mesh.h"
#include "client/sequence/strict_json.h"
#include "core/frame/error.h"

namespace holdfast::scenes {
namespace {

/// Reads one OBJ file. A position may carry several normals, so a vertex is a pair of indices.
class ObjReader {
 public:
  explicit ObjReader(const std::filesystem::path& file) : file_(file.string()), input_(file) {
    if (!input_) throw InputError("mesh " + file_, "must be a readable file", "missing");
  }

  Mesh read() {
    std::string line;
    while (std::getline(input_, line)) {
      ++line_number_;
      std::istringstream words(line);
      std::string key;
      words >> key;
      if (key == "v") positions_.push_back(read_vector(words));
      if (key == "vn") normals_.push_back(read_vector(words));
      if (key == "f") read_face(words);
    }
    if (mesh_.triangles.empty())
      throw InputError("mesh " + file_, "must have at least one face", "empty");
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& rule, const std::string& value) const {
    throw InputError("mesh " + file_ + " line " + std::to_string(line_number_), rule,
                     shortened(value));
  }

  glm::vec3 read_vector(std::istringstream& words) const {
    glm::vec3 v;
    if (!(words >> v.x >> v.y >> v.z)) fail("must hold three numbers", words.str());
    return v;
  }

  /// A 1-based or negative index of `count` entries, as 0-based.
  std::size_t resolve(std::string_view text, std::size_t count) const {
    long index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    const long size = static_cast<long>(count);
    const long zero_based = index > 0 ? index - 1 : size + index;
    if (error != std::errc{} || end != text.data() + text.size() || index == 0 || zero_based < 0 ||
        zero_based >= size)
      fail("must refer to one of " + std::to_string(count) + " entries", std::string(text));
    return static_cast<std::size_t>(zero_based);
  }

  /// The vertex "p", "p/t", "p//n" or "p/t/n".
  std::uint32_t read_vertex(const std::string& word) {
    const auto first = word.find('/');
    const auto last = word.rfind('/');
    const std::size_t position =
        resolve(std::string_view(word).substr(0, first), positions_.size());
    glm::vec3 normal(0.0f);
    std::size_t normal_key = 0;
    if (first != word.npos && last != first) {
      const std::size_t index = resolve(std::string_view(word).substr(last + 1), normals_.size());
      normal = normals_[index];
      normal_key = index + 1;
    }
    const auto [it, is_new] = vertices_.try_emplace(
        {position, normal_key}, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (is_new) {
      mesh_.positions.push_back(positions_[position]);
      mesh_.normals.push_back(normal);
    }
    return it->second;
  }

  void read_face(std::istringstream& words) {
    std::vector<std::uint32_t> corners;
    for (std::string word; words >> word;) corners.push_back(read_vertex(word));
    if (corners.size() < 3) fail("must be a face of three corners or more", words.str());
    for (std::size_t i = 2; i < corners.size(); ++i)
      mesh_.triangles.emplace_back(corners[0], corners[i - 1], corners[i]);
  }

  std::string file_;
  std::ifstream input_;
  int line_number_ = 0;
  std::vector<glm::vec3> positions_, normals_;
  std::map<std::pair<std::size_t, std::size_t>, std::uint32_t> vertices_;
  Mesh mesh_;
};

}  // namespace

Mesh read_obj(const std::filesystem::path& file) { return ObjReader(file).read(); }

}  // namespace holdfast::scenes
