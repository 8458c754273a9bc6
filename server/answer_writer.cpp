#include "server/answer_writer.h"

#include <chrono>
#include <utility>

namespace holdfast::server {

void AnswerWriter::add(FrameSlot& slot, const SessionConfig& config) {
  answers_.push_back({&slot, &config});
}

const grpc::ByteBuffer* AnswerWriter::next(const Sent& sent) {
  if (!notices_.empty() && !made_) {
    wire::write_message(notices_.front(), message_.bytes);
    notices_.pop_front();
    return &message_.bytes;
  }
  if (answers_.empty()) return nullptr;
  begin();
  if (!made_) encode_ahead();
  if (*std::exchange(made_, {})) return &message_.bytes;
  FrameSlot& slot = *answers_.front().slot;
  sender_.reset();
  message_ = {};  // lets go of the answer
  answers_.pop_front();
  sent(slot);
  return needs_encoding() ? nullptr : next(sent);
}

bool AnswerWriter::needs_encoding() {
  return notices_.empty() && !answers_.empty() && !made_ && begin().config->wire != "exact";
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
  std::vector<FrameSlot*> slots;
  for (const Entry& entry : answers_) slots.push_back(entry.slot);
  answers_.clear();
  return slots;
}

}  // namespace holdfast::server
