#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "core/kernels/task_order.h"

namespace holdfast {

/// Rows handed to a thread at a time: large enough to hide the cost of a task, small enough to
/// balance two threads at 270 rows.
inline constexpr int kRowsPerTask = 4;

/// Calls `body(i)` for i in first..end-1, at least `per_task` of them by one thread, in parallel in
/// the caller's task arena. Calls are independent, so results do not depend on the number of
/// threads. An exception of one call ends the loop and leaves it.
template <class Index, class Body>
void for_each_index(Index first, Index end, Index per_task, const Body& body) {
  TaskOrder order;
  order.begin_loop();
  tbb::parallel_for(tbb::blocked_range<Index>(first, end, per_task),
                    [&](const tbb::blocked_range<Index>& range) {
                      order.begin_task();
                      for (Index i = range.begin(); i != range.end(); ++i) body(i);
                      order.end_task();
                    });
  order.end_loop();
}

/// Calls `body(y)` for every row of an image, likewise.
template <class Body>
void for_each_row(int height, const Body& body) {
  for_each_index(0, height, kRowsPerTask, body);
}

}  // namespace holdfast
