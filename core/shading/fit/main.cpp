// Fits the table of linearly transformed cosines and writes it as C++ source:
//   holdfast_fit_ltc core/shading/generated/ltc_table.inc

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <vector>

#include "core/shading/fit/fit_lobe.h"
#include "core/shading/ggx.h"
#include "core/shading/ltc_layout.h"

namespace {

using namespace holdfast;
using namespace holdfast::fit;

constexpr int kSide = 40;  // strata of a lobe along each axis

using Cell = std::array<double, kLtcEntries>;

Cell cell_of(const LobeSamples& lobe, const Parameters& p) {
  const glm::dmat3 m = glm::inverse(mirror_from_cosine(p, lobe.alpha));
  const glm::dmat3 s = m / m[1][1];  // columns first
  const double a = lobe.alpha;
  return {s[0][0], s[2][0], s[0][2] / a, s[2][2] / a, lobe.magnitude, lobe.fresnel};
}

/// The best fit of one lobe from three starts: its rougher neighbour, the steeper one, and the
/// limit of smooth lobes.
Parameters best_fit(const LobeSamples& lobe, const Parameters& rougher, const Parameters& steeper,
                    bool symmetric) {
  Fit best;
  for (const Parameters& start : {rougher, steeper, smooth_limit(lobe)}) {
    const Fit fit = fit_lobe(lobe, start, symmetric);
    if (fit.misfit < best.misfit) best = fit;
  }
  return best.parameters;
}

std::vector<Cell> fit_table() {
  constexpr int kLast = kLtcSide - 1;
  std::vector<Cell> cells(kLtcSide * kLtcSide);
  std::array<Parameters, kLtcSide> row{};  // of the roughness above, then of this one
  for (int i = kLast; i >= 0; --i) {
    const double alpha = lobe_alpha(static_cast<double>(i) / kLast);
    for (int j = 0; j < kLtcSide; ++j) {
      const double u = static_cast<double>(j) / kLast;
      const LobeSamples lobe(alpha, std::max(kLeastCosine, 1.0 - u * u), kSide);
      const auto at = static_cast<std::size_t>(j);
      row[at] = best_fit(lobe, row[at], row[j > 0 ? at - 1 : at], j == 0);
      cells[static_cast<std::size_t>(i * kLtcSide + j)] = cell_of(lobe, row[at]);
    }
    std::cerr << "\rroughness row " << kLast - i + 1 << " of " << kLtcSide;
  }
  std::cerr << '\n';
  return cells;
}

void write_table(std::ostream& out, const std::vector<Cell>& cells) {
  out << "// Written by: holdfast_fit_ltc core/shading/generated/ltc_table.inc (core/DESIGN.md).\n"
         "// Layout: core/shading/ltc_layout.h\n";
  for (const Cell& cell : cells) {
    for (const double value : cell) {
      char text[32];
      std::snprintf(text, sizeof text, "%#.6gf,", value);
      out << text;
    }
    out << '\n';
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: holdfast_fit_ltc FILE\n";
    return 2;
  }
  std::ofstream file(argv[1]);
  write_table(file, fit_table());
  if (!file.flush()) {
    std::cerr << "cannot write " << argv[1] << '\n';
    return 1;
  }
  return 0;
}
