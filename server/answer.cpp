#include "server/answer.h"

#include <algorithm>

namespace holdfast::server {

PlaneSet PlanePool::take() {
  const std::lock_guard lock(mutex_);
  if (spare_.empty()) return {};
  PlaneSet planes = std::move(spare_.back());
  spare_.pop_back();
  return planes;
}

void PlanePool::give(PlaneSet&& planes) {
  const std::lock_guard lock(mutex_);
  if (planes.size() > 0 && spare_.size() < capacity_) spare_.push_back(std::move(planes));
}

// One more than is remembered: the answer that is being made.
AnswerLedger::AnswerLedger(std::size_t capacity)
    : capacity_(capacity), pool_(std::make_shared<PlanePool>(capacity + 1)) {}

void AnswerLedger::keep(std::shared_ptr<const Answer> answer) {
  kept_.push_back(std::move(answer));
  if (kept_.size() > capacity_) kept_.erase(kept_.begin());
}

std::shared_ptr<const Answer> AnswerLedger::find(std::uint64_t epoch, std::int64_t index) const {
  const auto it = std::find_if(kept_.begin(), kept_.end(), [&](const auto& answer) {
    return answer->epoch == epoch && answer->report.index == index;
  });
  return it == kept_.end() ? nullptr : *it;
}

}  // namespace holdfast::server
