#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/measure/claims.h"
#include "client/measure/report.h"

namespace holdfast::measure {

inline constexpr const char* kTableBegin = "<!-- table:begin -->";
inline constexpr const char* kTableEnd = "<!-- table:end -->";

/// Tables for a README: the claims that `listed_claims` lists, then one for each scene with a row a
/// recipe. Its columns are RMSE and SSIM of the composite over the image and of each component
/// where the effect moves (over the image where no effect does), and the median ms in the core. The
/// best of each column is bold; the last row is the noise of the references, if measured.
std::string quality_markdown(const std::vector<ReportScene>& scenes,
                             const std::vector<Claim>& claims);

/// Writes `text` to a file: between the lines kTableBegin and kTableEnd if the file has both, else
/// as the whole file. Throws std::runtime_error if it cannot be written.
void write_markdown(const std::filesystem::path& file, const std::string& text);

}  // namespace holdfast::measure
