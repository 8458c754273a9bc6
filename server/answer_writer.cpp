#include "server/answer_writer.h"

#include <chrono>
#include <utility>

namespace holdfast::server {

void AnswerWriter::add(FrameSlot& slot, const SessionConfig& config) {
  answers_.push_back({&slot, &config});
}

const wire::OutgoingMessage* AnswerWriter::next(const Sent& sent) {
  if (urgent() && !made_) {
    write_urgent();
    return &message_;
  }
  if (answers_.empty()) return nullptr;
  begin();
  if (!made_) encode_ahead();
  if (*std::exchange(made_, {})) return &message_;
  FrameSlot& slot = *answers_.front().slot;
  sender_.reset();
  message_ = {};  // lets go of the answer
  answers_.pop_front();
  sent(slot);
  return needs_encoding() ? nullptr : next(sent);
}

void AnswerWriter::write_urgent() {
  message_.plane_bytes = message_.shared_bytes = 0;
  if (!notices_.empty()) {
    wire::write_message(notices_.front(), message_.bytes);
    notices_.pop_front();
    return;
  }
  v1::DenoiseResponse response;
  response.mutable_shared_read()->set_cells(*std::exchange(read_cells_, {}));
  wire::write_message(response, message_.bytes);
}

bool AnswerWriter::needs_encoding() {
  return !urgent() && !answers_.empty() && !made_ && begin().config->wire != "exact";
}

/// The first answer, with its sender.
const AnswerWriter::Entry& AnswerWriter::begin() {
  const Entry& entry = answers_.front();
  if (!sender_) sender_.emplace(*entry.slot, *entry.config, chunks_);
  encoding_ = entry.slot;
  return entry;
}

void AnswerWriter::encode_ahead() {
  const auto start = std::chrono::steady_clock::now();
  made_ = sender_->next(message_);
  encoding_->encode += std::chrono::steady_clock::now() - start;
}

std::vector<FrameSlot*> AnswerWriter::drop() {
  sender_.reset();
  made_.reset();
  notices_.clear();
  read_cells_.reset();
  std::vector<FrameSlot*> slots;
  for (const Entry& entry : answers_) slots.push_back(entry.slot);
  answers_.clear();
  return slots;
}

}  // namespace holdfast::server
