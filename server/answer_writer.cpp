#include "server/answer_writer.h"

#include <chrono>

namespace holdfast::server {

void AnswerWriter::add(FrameSlot& slot, const SessionConfig& config) {
  answers_.push_back({&slot, &config});
}

const v1::DenoiseResponse* AnswerWriter::next(const Sent& sent) {
  if (!notices_.empty()) {
    response_ = std::move(notices_.front());
    notices_.pop_front();
    return &response_;
  }
  while (!answers_.empty()) {
    const Entry entry = answers_.front();
    if (!sender_) sender_.emplace(*entry.slot, *entry.config, coder_);
    if (encode(*entry.slot)) return &response_;
    sender_.reset();
    answers_.pop_front();
    sent(*entry.slot, preset_);
  }
  return nullptr;
}

/// Fills `response_` with the next message of the answer; false if there is none left.
bool AnswerWriter::encode(FrameSlot& slot) {
  const auto start = std::chrono::steady_clock::now();
  const bool more = sender_->next(response_);
  slot.encode += std::chrono::steady_clock::now() - start;
  if (more && response_.has_frame_result()) preset_ = response_.frame_result().preset();
  return more;
}

std::vector<FrameSlot*> AnswerWriter::drop() {
  sender_.reset();
  notices_.clear();
  std::vector<FrameSlot*> slots;
  for (const Entry& entry : answers_) slots.push_back(entry.slot);
  answers_.clear();
  return slots;
}

}  // namespace holdfast::server
