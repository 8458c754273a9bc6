#include <algorithm>
#include <cmath>

#include "client/check/parts.h"

namespace holdfast::check {
namespace {

bool near(double a, double b, double scale = 1) { return std::abs(a - b) <= 1e-4 * scale; }

/// The last row of an affine matrix is (0, 0, 0, 1).
bool is_affine(const glm::dmat4& m) {
  return near(m[0][3], 0) && near(m[1][3], 0) && near(m[2][3], 0) && near(m[3][3], 1);
}

/// The last row is (0, 0, -w, 0): perspective along -Z.
bool is_perspective(const glm::dmat4& m) {
  return near(m[0][3], 0) && near(m[1][3], 0) && m[2][3] < 0 && near(m[3][3], 0);
}

/// A projection is perspective or affine. The transpose of a perspective may look like one of
/// another scale; the usual scale, w = 1, tells them apart.
bool is_projection(const glm::dmat4& m) {
  const glm::dmat4 other = glm::transpose(m);
  const bool other_is_usual = is_perspective(other) && near(other[2][3], -1);
  return is_affine(m) || (is_perspective(m) && (near(m[2][3], -1) || !other_is_usual));
}

/// How many matrices have their form, and how many would have it transposed.
struct Forms {
  std::int64_t right = 0, transposed = 0, neither = 0;

  void add(const glm::dmat4& m, bool (*has_form)(const glm::dmat4&)) {
    ++(has_form(m) ? right : has_form(glm::transpose(m)) ? transposed : neither);
  }
  std::int64_t count() const { return right + transposed + neither; }
  /// Some say that all are transposed; matrices without translation look the same either way.
  bool all_transposed() const { return transposed > 0 && neither == 0; }
};

struct AllForms {
  Forms view, clip, objects, lights;
};

AllForms forms_of(const std::vector<Tables>& all) {
  AllForms forms;
  for (const Tables& tables : all) {
    forms.view.add(tables.camera.view_from_world, is_affine);
    forms.clip.add(tables.camera.clip_from_view, is_projection);
    for (const auto& [id, matrix] : tables.objects) forms.objects.add(matrix, is_affine);
    for (const auto& [id, matrix] : tables.lights) forms.lights.add(matrix, is_affine);
  }
  return forms;
}

void report_form(const Forms& forms, const std::string& thing, const char* row, Report& report) {
  if (forms.transposed + forms.neither == 0) return;
  const bool transposed = forms.all_transposed();
  const std::int64_t bad = transposed ? forms.transposed : forms.neither;
  report.findings.push_back(
      {thing, transposed ? "transposed" : "malformed",
       std::string("must be written row by row, with the last row ") + row,
       std::to_string(bad) + " of " + std::to_string(forms.count()) +
           " matrices have another last row" +
           (transposed ? "; their last column has those numbers: they are written column by column"
                       : ", and it is not their last column either"),
       forms.count(), static_cast<double>(bad) / static_cast<double>(forms.count())});
}

void transpose_all(TransformTable& table) {
  for (auto& [id, matrix] : table) matrix = glm::transpose(matrix);
}

/// Offset of the image by clip_from_view, pixels.
glm::dvec2 offset_px(const glm::dmat4& clip, double width, double height) {
  const bool perspective = near(clip[3][3], 0);
  const glm::dvec2 ndc = perspective ? glm::dvec2(clip[2][0], clip[2][1]) / clip[2][3]
                                     : glm::dvec2(clip[3][0], clip[3][1]);
  return {ndc.x * 0.5 * width, -ndc.y * 0.5 * height};
}

void move_px(glm::dmat4& clip, glm::dvec2 by, double width, double height) {
  const glm::dvec2 ndc(by.x * 2 / width, -by.y * 2 / height);
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 2; ++r) clip[c][r] += ndc[r] * clip[c][3];
}

/// True where clip_from_view shakes by less than a pixel or so from frame to frame, and does not
/// change otherwise.
bool shakes(const std::vector<Tables>& all, const std::vector<glm::dvec2>& offsets) {
  std::size_t changes = 0;
  glm::dvec2 low = offsets.front(), high = offsets.front();
  for (std::size_t i = 1; i < all.size(); ++i) {
    const glm::dmat4 &a = all[0].camera.clip_from_view, &b = all[i].camera.clip_from_view;
    if (!near(a[0][0], b[0][0]) || !near(a[1][1], b[1][1])) return false;
    changes += glm::distance(offsets[i], offsets[i - 1]) > 1e-3 ? 1 : 0;
    low = glm::min(low, offsets[i]);
    high = glm::max(high, offsets[i]);
  }
  const glm::dvec2 range = high - low;
  return all.size() > 2 && changes * 2 > all.size() && std::max(range.x, range.y) < 2;
}

/// Jitter that is part of clip_from_view; moved from there to jitter_px where that is empty.
void check_jitter(const std::vector<Tables>& all, Snapshots& frames, Report& report) {
  const double width = frames.begin()->second.width(), height = frames.begin()->second.height();
  std::vector<glm::dvec2> offsets;
  glm::dvec2 mean(0);
  bool given = false;
  for (const Tables& tables : all) {
    offsets.push_back(offset_px(tables.camera.clip_from_view, width, height));
    mean += offsets.back() / static_cast<double>(all.size());
    given = given || tables.camera.jitter_px != glm::dvec2(0);
  }
  if (!shakes(all, offsets)) return;
  for (auto& [position, frame] : frames) {
    const glm::dvec2 extra = offsets[position] - mean;
    move_px(frame.camera.clip_from_view, -extra, width, height);
    if (!given) frame.camera.jitter_px = -extra;
  }
  double largest = 0;
  for (const glm::dvec2& offset : offsets) largest = std::max(largest, glm::length(offset - mean));
  report.findings.push_back(
      {"camera.clipFromView", "jitter-in-clip", "must not contain the jitter; it goes to jitterPx",
       "it moves the image by up to " + number(largest) +
           " px about its mean, differently in each of " + std::to_string(all.size()) + " frames" +
           (given ? ", besides jitterPx" : ", while jitterPx is 0"),
       static_cast<std::int64_t>(all.size()), 1});
}

}  // namespace

void check_matrices(const std::vector<Tables>& all, Snapshots& frames, Report& report) {
  const AllForms forms = forms_of(all);
  const std::size_t first = report.findings.size();
  report_form(forms.view, "camera.viewFromWorld", "(0, 0, 0, 1)", report);
  report_form(forms.clip, "camera.clipFromView", "(0, 0, -1, 0), or (0, 0, 0, 1) if orthographic",
              report);
  report_form(forms.objects, "objects", "(0, 0, 0, 1)", report);
  report_form(forms.lights, "lights", "(0, 0, 0, 1)", report);
  std::vector<Tables> corrected = all;
  for (auto& [position, frame] : frames) {
    if (forms.view.all_transposed())
      frame.camera.view_from_world = glm::transpose(frame.camera.view_from_world);
    if (forms.clip.all_transposed())
      frame.camera.clip_from_view = glm::transpose(frame.camera.clip_from_view);
    if (forms.objects.all_transposed()) transpose_all(frame.objects);
    if (forms.lights.all_transposed()) transpose_all(frame.lights);
  }
  if (forms.clip.all_transposed())
    for (Tables& tables : corrected)
      tables.camera.clip_from_view = glm::transpose(tables.camera.clip_from_view);
  if (!frames.empty()) check_jitter(corrected, frames, report);
  const bool wrong = report.findings.size() > first;
  report.add("matrices", wrong ? Verdict::kWrong : Verdict::kOk,
             wrong ? findings_since(report, first)
                   : std::to_string(forms.view.count() + forms.clip.count() +
                                    forms.objects.count() + forms.lights.count()) +
                         " matrices have their form");
}

}  // namespace holdfast::check
