#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace holdfast {

/// Rows handed to a thread at a time: large enough to hide the cost of a task, small enough to
/// balance two threads at 270 rows.
inline constexpr int kRowsPerTask = 8;

/// Calls `body(y)` for every row, in parallel in the caller's task arena. Rows are independent, so
/// results do not depend on the number of threads.
template <class Body>
void for_each_row(int height, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<int>(0, height, kRowsPerTask),
                    [&](const tbb::blocked_range<int>& rows) {
                      for (int y = rows.begin(); y != rows.end(); ++y) body(y);
                    });
}

}  // namespace holdfast
